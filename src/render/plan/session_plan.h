// How the ranks make the frames of a run.
#pragma once

#include "parallel/session_words.h"

namespace pprt {

struct FrameEnd;

// Mean triangle weight at which a still looks converged: the structural similarity to a converged picture is
// at least 0.99 on every SPD scene tried (docs/decisions/0007-still-quality.md).
inline constexpr double kStillWeight = 0.005;

// The same for the lattice: the mean worth of what is still to be sampled (docs/decisions/0021-lattice.md).
inline constexpr double kLatticeStillWeight = 2.8e-5;

// Returns what chooses samples, weights and pixels: the triangulation where nothing else is asked for and
// only it will do.
SessionSettings settled_method(SessionSettings method, WeightRule weights);

// Settles what ends a frame: the deadline of `fps`, the rate settled, or the stop rules. Throws UsageError.
void settle_end(const FrameEnd& end, double fps, bool goes_on, SessionSettings& settings);

// Returns the settings of a picture at full quality, taken while frames are made with `live`.
SessionSettings photo_settings(const SessionSettings& live);

}  // namespace pprt
