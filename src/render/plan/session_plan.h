// How the ranks make the frames of a run.
#pragma once

#include "parallel/settings/session_words.h"

namespace pprt {

struct FrameEnd;

// Returns what chooses samples, weights and pixels: the triangulation where nothing else is asked for and
// only it will do.
SessionSettings settled_method(SessionSettings method, WeightRule weights);

// Settles what ends a frame: the deadline of `fps`, the rate settled, or the stop rules. Throws UsageError.
void settle_end(const FrameEnd& end, double fps, bool goes_on, SessionSettings& settings);

// Returns the settings of a picture at full quality, taken while frames are made with `live`.
SessionSettings photo_settings(const SessionSettings& live);

}  // namespace pprt
