// Primitives that the frames before have shown, sought again where this frame's camera would see them
// (docs/decisions/0019-landmarks.md).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "parallel/protocol/messages.h"
#include "parallel/rank/rank_sampling.h"
#include "pipeline/casting/primitive_anchors.h"

namespace pprt {

// One rank's search. It spends at most a tenth of a frame's samples.
class AnchorSearch {
 public:
  // `primitives`: as in Probe.
  explicit AnchorSearch(std::uint32_t primitives) : anchors_(primitives) {}

  void begin_frame();

  // The frame before is over: notes its samples' primitives, or forgets all.
  void note(std::span<const Sample> samples) { anchors_.note(samples); }
  void forget() { anchors_.clear(); }

  // Carries the anchors into this frame, in which something moves; see Probe::carry.
  void carry(const std::function<Carried(RaySample&)>& carried) { anchors_.carry(carried); }

  // This frame is to seek anchors; `samples`: count carried into it.
  void allow(std::uint64_t samples) { most_ = kShare * static_cast<double>(samples); }

  // Chooses the anchors to seek, once: after a tenth of the sampling time, when refinement has found again by
  // itself what it soon finds. `samples_new`: traced in this frame so far. `elapsed`: share of the sampling
  // time that has passed.
  void plan(const FrameOrder& order, const RankSampling& sampler, std::uint64_t samples_new, double elapsed);

  // Takes the next anchor to seek, at its image point. The caller must check that nothing hides it.
  std::optional<Sample> next();

 private:
  static constexpr double kShare = 0.1;  // of a frame's samples

  PrimitiveAnchors anchors_;
  double most_ = 0;              // that this frame is still to seek; 0: none, or planned already
  std::vector<Sample> planned_;  // the next one last
};

}  // namespace pprt
