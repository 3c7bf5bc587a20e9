// Traces samples for one rank, at the clock's price.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "base/probe.h"
#include "parallel/balance/cost_estimator.h"
#include "parallel/clock/frame_clock.h"
#include "pipeline/core/sample.h"

namespace pprt {

// Asks the probe, and makes of its answer a sample with an id and a time stamp. Every ray is charged to the
// clock and to its tile's cost.
class SampleTracer {
 public:
  // `poll` is called after each sample with the rays that it took, so that messages do not wait for long. The
  // references must outlive the tracer.
  SampleTracer(Probe probe, int rank, FrameClock& clock, CostEstimator& costs,
               std::function<void(std::uint64_t rays)> poll)
      : probe_(std::move(probe)), rank_(rank), clock_(clock), costs_(costs), poll_(std::move(poll)) {}

  // Looks from the order's camera at the order's time, and counts rays anew.
  void begin_frame(const FrameOrder& order);

  // Numbers samples from 0 again: which of them casting draws must not depend on frames before.
  void restart_ids() { next_id_ = 0; }

  // Traces the eye ray through an image point. The one gate for colours that no picture holds. Those that are
  // no finite numbers are counted, and black from here on. Others are clamped to 65504.
  // `known`: lights that need no shadow rays where the eye ray hits their primitives. `footprint`: side of
  // the square that textures are filtered over, pixels.
  Sample trace(double x, double y, std::span<const KnownLights> known = {}, double footprint = 1);

  // The same, but nothing is charged, and messages wait.
  Sample rehearse(double x, double y, double footprint) { return sample_at(x, y, {}, footprint); }

  // Returns the colour at an image point, for a measurement: no sample is made, nothing is charged, and its
  // rays are not among rays().
  Color look(double x, double y, double footprint = 1);

  // Whether nothing hides a hit point from the eye.
  bool is_visible(const Vec3f& hit, bool at_infinity);

  // Whether something stands elsewhere than in the frame before.
  bool moves() const { return moves_; }

  const Probe& probe() const { return probe_; }
  RayCounts rays() const { return probe_.counts() - rays_before_ - looked_; }  // of samples, in this frame
  const RayCounts& looked() const { return looked_; }                          // of looks, in this frame
  std::uint64_t non_finite() const { return non_finite_; }                     // colours in this frame
  int frame_number() const { return frame_number_; }

 private:
  Sample sample_at(double x, double y, std::span<const KnownLights> known, double footprint);
  RaySample ray_through(double x, double y, std::span<const KnownLights> known, double footprint);

  Probe probe_;
  int rank_;
  FrameClock& clock_;
  CostEstimator& costs_;
  std::function<void(std::uint64_t rays)> poll_;
  int frame_number_ = 0;
  std::optional<double> time_;  // of what moves, in the frame before
  bool moves_ = false;
  std::uint64_t next_id_ = 0;
  std::uint64_t non_finite_ = 0;
  RayCounts rays_before_, looked_;
};

}  // namespace pprt
