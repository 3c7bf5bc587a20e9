// When a frame without a rate is good enough, on this rank and on all others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "parallel/clock/frame_clock.h"
#include "parallel/rank/flip_estimate.h"
#include "parallel/rank/rank_sampling.h"
#include "parallel/rank/rmse_goal.h"
#include "parallel/settings/session_settings.h"

namespace pprt {

// How far a rank is in a frame without a rate.
struct SamplingProgress {
  std::optional<double> share = {};  // of the samples or the time until a stop rule ends it; empty: not known
  double samples_per_pixel = 0;      // of the rank's region
};

inline constexpr std::size_t kAnyNumber = std::numeric_limits<std::size_t>::max();  // of samples

// Every bundle says whether its sender has reached its goal. The frame ends when all ranks have.
class FrameGoal {
 public:
  // `tracer` must outlive it.
  FrameGoal(const SessionSettings& settings, int rank, int ranks, SampleTracer& tracer);

  // `has_new_picture`: no sample of the frame before is left.
  void begin_frame(int number, bool has_new_picture);

  // Whether a stop rule is reached in this rank's region, or an RMSE in the whole picture. A rank takes its
  // pixels' share of a number of samples. May reconstruct `picture`, to find out how good it is.
  bool is_reached(RankSampling& sampler, PictureRefresh& picture, FrameClock& clock);

  // Returns how many samples this rank still takes of those asked for; kAnyNumber without such a goal.
  std::size_t samples_left(const RankSampling& sampler) const;

  SamplingProgress progress(const RankSampling& sampler, const FrameClock& clock) const;

  // Records whether this rank has reached its goal after a round, and what another rank says of its own.
  void set_done(bool done) { done_ = done; }
  void receive(int from, bool done, std::optional<double> squared_error);

  // The sum of squared errors found in this rank's region, which all ranks need; empty: none yet.
  std::optional<double> squared_error() const { return rmse_.found(); }

  // Whether it has changed since the last call.
  bool take_news() { return rmse_.take_news(); }

  // Returns how wrong a picture of the region is where an RMSE ended it.
  std::optional<ErrorSums> measure(const Region& region, const PixelBlock& shown) const;

  bool is_done() const { return done_; }
  bool all_done() const;

 private:
  std::uint64_t sample_share(const RankSampling& sampler) const;

  const StopRules stop_;
  std::uint64_t image_pixels_;
  FlipEstimate flip_;
  RmseGoal rmse_;
  bool done_ = false;
  std::vector<std::uint8_t> peer_done_;  // per rank
};

}  // namespace pprt
