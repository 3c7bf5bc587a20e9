// Samples carried into the next frame: which ones, by which method, and what was learned of them (paper
// s. 4.1, docs/decisions/0013-casting.md).
#pragma once

#include <cstdint>
#include <vector>

#include "parallel/clock/frame_clock.h"
#include "parallel/clock/stage_timer.h"
#include "parallel/rank/rank_sampling.h"
#include "parallel/rank/sample_tracer.h"
#include "pipeline/casting/casting.h"

namespace pprt {

// Casts one region's samples by the order's method. Knows nothing of messages.
class Reprojection {
 public:
  // The references must outlive the object.
  Reprojection(const RankSampling& sampler, SampleTracer& tracer, FrameClock& clock, StageTimer& timer)
      : sampler_(sampler), tracer_(tracer), clock_(clock), timer_(timer) {}

  // A frame begins: what the one before has learned becomes the rank's own latest evidence.
  void begin_frame();

  // Returns the region's samples that serve the order's frame, at their points in its image. Some of them may
  // be traced anew. `eye_rests`: only the view turns or widens; then nothing is hidden, and no colour
  // changes.
  std::vector<Sample> cast(const FrameOrder& order, bool eye_rests);

  // Drops the oldest of the samples that there is no time to reinsert: it may take half of a frame with a
  // rate; the rest is for new samples.
  void keep_affordable(const FrameOrder& order, std::vector<Sample>& samples) const;

  // What this frame has shown of casting's worth; see CastEvidence.
  CastEvidence& evidence() { return evidence_; }
  const CastEvidence& evidence() const { return evidence_; }

  // Samples that were traced anew in this frame, because their colour depends on the eye.
  std::uint64_t retraced() const { return retraced_; }

 private:
  std::vector<Sample> cast_for_lights(const FrameOrder& order);
  std::vector<Sample> cast_at_rest(const FrameOrder& order);
  std::vector<Sample> cast_where_paying(const FrameOrder& order);
  std::vector<Sample> try_out(const std::vector<Sample>& samples);
  CastResult cast_into(const FrameOrder& order, const CastSettings& settings);
  CastSummary summary_of(const CastResult& cast) const;
  void drop_hidden_samples(std::vector<Sample>& samples);
  void keep_affordable(const FrameOrder& order, double share, std::vector<Sample>& samples) const;

  const RankSampling& sampler_;
  SampleTracer& tracer_;
  FrameClock& clock_;
  StageTimer& timer_;
  CastEvidence evidence_;         // of this frame
  CastEvidence evidence_before_;  // of the frame before
  std::uint64_t retraced_ = 0;
};

}  // namespace pprt
