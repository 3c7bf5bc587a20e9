// A frame's figures over all ranks: what the ledger, the headers of pictures and the study tell of it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/ray_counts.h"
#include "parallel/master/master.h"

namespace pprt {

// Bytes that the ranks sent each other, by purpose.
struct BytesSent {
  std::uint64_t samples = 0;
  std::uint64_t progress = 0;
  std::uint64_t balance = 0;
  std::uint64_t pixels = 0;
};

// Sums over the ranks where nothing else is said; a late rank counts as one that did nothing.
struct FrameSummary {
  int number = 0;
  bool camera_cut = false;
  double deadline_s = 0;                 // since the start of the sequence; 0: no rate
  double finished_s = 0;                 // likewise
  double late_ms = 0;                    // after the deadline; <= 0: on time
  double effort = 1;                     // share of its sampling time that made it good enough
  std::vector<std::int32_t> late_ranks;  // ascending
  std::vector<std::int32_t> lost_ranks;  // given up before this frame, ascending
  int stale_tiles = 0;                   // that show an earlier frame
  int overdue_pixels = 0;                // messages that came too late for earlier frames
  std::uint64_t samples_new = 0;         // traced in this frame
  std::uint64_t samples_cast = 0;        // carried from frames before
  std::uint64_t samples = 0;             // in the image
  std::uint64_t samples_received = 0;
  std::uint64_t samples_received_twice = 0;
  std::uint64_t non_finite = 0;      // samples whose colour was no number
  double mean_weight = 0;            // mean over the ranks that have triangles of Q_k (paper s. 6.2)
  double mean_weight_deviation = 0;  // standard deviation of the same
  RayCounts rays;
  StageTimes cpu_ms;
  BytesSent bytes;
  std::uint64_t tiles_moved = 0;         // by local balancing
  bool repartitioned = false;            // a new partition was in force from this frame on
  std::optional<FrameError> error = {};  // measured
};

FrameSummary summarize(const FinishedFrame& frame);

// Sums over the frames of a run.
class RunTotals {
 public:
  void add(const FrameSummary& frame);

  int frames() const { return static_cast<int>(late_ms_.size()); }
  int on_time() const;
  int with_late_ranks() const { return with_late_ranks_; }  // frames
  std::uint64_t samples() const { return samples_; }
  std::uint64_t non_finite() const { return non_finite_; }
  const RayCounts& rays() const { return rays_; }
  double samples_per_frame() const;
  double mean_effort() const { return frames() > 0 ? effort_ / frames() : 1; }
  const MeanErrorEstimate& error() const { return error_; }  // measured, over the frames

  // Lateness in milliseconds: the nearest-rank percentile (`share` 0 to 1), and the maximum; 0 without
  // frames.
  double late_ms(double share) const;
  double worst_late_ms() const { return late_ms(1); }

 private:
  int with_late_ranks_ = 0;
  std::uint64_t samples_ = 0;
  std::uint64_t non_finite_ = 0;
  RayCounts rays_;
  MeanErrorEstimate error_;
  double effort_ = 0;
  std::vector<double> late_ms_;  // ascending
};

}  // namespace pprt
