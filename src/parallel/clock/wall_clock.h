// Real time: the product's mode. A frame with a rate keeps its deadline whatever the machine does.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

#include "parallel/clock/crowding.h"
#include "parallel/clock/frame_clock.h"
#include "parallel/clock/host_time.h"
#include "parallel/clock/sequence_clock.h"

namespace pprt {

// The last eight values. 0 before there is any.
class RecentValues {
 public:
  void add(double value) { values_[next_++ % values_.size()] = value; }
  double greatest() const { return *std::max_element(values_.begin(), values_.end()); }
  double least() const {
    const auto end = values_.begin() + static_cast<std::ptrdiff_t>(std::min(next_, values_.size()));
    return next_ > 0 ? *std::min_element(values_.begin(), end) : 0;
  }

 private:
  std::array<double, 8> values_{};
  std::size_t next_ = 0;
};

class WallClock final : public FrameClock {
 public:
  // `sequence` must outlive it. `period_s`: seconds from frame to frame, 0 without a rate. `ranks_per_core`:
  // number of ranks that share one of this host's cores, at least 1. `refreshes_in_parts`: a resting picture
  // can be reconstructed in parts. Otherwise the frames in which it is take turns with others. `run_times`
  // tells those of the thread that works.
  WallClock(const SequenceClock& sequence, double period_s, double ranks_per_core, bool refreshes_in_parts,
            std::function<RunTimes()> run_times = thread_run_times)
      : sequence_(sequence),
        run_times_(std::move(run_times)),
        usual_period_s_(period_s),
        period_s_(period_s),
        ranks_per_core_(ranks_per_core),
        refreshes_in_parts_(refreshes_in_parts) {}

  bool learns_from_rehearsal() const override { return usual_period_s_ > 0; }
  bool may_begin(const FrameOrder& order) const override;
  bool is_past(const FrameOrder& order) const override;
  void begin_frame(const FrameOrder& order) override;
  void end_frame(double reconstruction_ms, double share) override;
  void region_changed(std::size_t pixels) override;
  void mixed_pixels_found(std::size_t pixels) override;
  double mixed_pixel_units() const override;
  void unshown_found(double share) override { unshown_ = share; }

  void begin_packet(std::uint64_t samples) override;
  bool packet_over() override;
  bool sampling_over() override;
  bool is_fine_enough() const override;
  bool reconstruction_over() override;
  void end_sampling(double units) override;
  double pace() const override { return pace_; }
  double sampling_share() const override;
  std::optional<double> expected_growth(std::size_t begin, std::size_t now) const override;
  std::optional<TimeForecast> forecast(std::size_t samples, double seconds_of_each) const override;

  void spend(Work, std::uint64_t) override {}
  std::size_t affordable(Work work, double share) const override;
  double rested(double seconds) override;

  std::int64_t used_ns() const override { return thread_cpu_ns(); }
  double as_evidence_ms(double measured_ms) const override { return measured_ms; }
  double frame_seconds() const override { return sequence_.now_s() - frame_began_s_; }
  double sampling_end_seconds() const override { return std::max(stop_s_, packet_began_s_); }

 private:
  void take_turns();
  void set_stop();
  double latest_s(double size, bool is_seen) const;
  double left_for_the_rest(double size, bool is_seen) const;
  double reconstruction_s(double size, bool is_seen) const;
  double seconds_of_cpu_second() const;

  // All times are seconds since the sequence began.
  const SequenceClock& sequence_;
  std::function<RunTimes()> run_times_;
  Crowding crowding_;
  double usual_period_s_;
  double period_s_;  // of this frame
  double ranks_per_core_;
  bool refreshes_in_parts_;
  double frame_began_s_ = 0;
  double deadline_s_ = 0;  // 0: no rate
  double effort_ = 1;      // share of the sampling time that the frame takes
  double reserve_s_ = 0;   // for what follows reconstruction
  bool is_first_ = true;   // frame, whose reserve is a guess
  bool is_at_rest_ = false;
  double stop_s_ = 0;  // when sampling must stop; 0: no rate
  double sampling_began_s_ = 0;
  double packet_began_s_ = 0;  // the last one; until there is one, the frame
  double part_began_s_ = 0;    // of reconstruction
  bool is_first_part_ = true;
  double longest_part_s_ = 0;  // the latest ones count most
  double saved_s_ = 0;         // for the next reconstruction as a whole, while the picture rests
  bool is_turn_ = true;        // of reconstruction as a whole
  bool is_sampling_ = false;   // this frame has begun to
  double rested_s_ = 0;        // since the beginning
  double rested_before_sampling_s_ = 0;
  double pace_ = 1;
  bool knows_pace_ = false;
  double size_ = 1;  // of what is to be reconstructed, in samples
  double samples_size_ = 1;
  double region_size_ = 0;           // what the region's pixels add to it
  double unshown_ = 1;               // share of the region
  double mixed_size_ = 0;            // what those of several surfaces add
  RecentValues seen_s_per_size_;     // what new pictures took to reconstruct whose surfaces are seen
  RecentValues unseen_s_per_size_;   // what others took
  RecentValues resting_s_per_size_;  // what either took under rest
  int left_in_packet_ = 0;
};

}  // namespace pprt
