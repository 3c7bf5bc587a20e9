// Whether casting pays, from what the ranks have measured of it: the rules of --cast auto
// (docs/decisions/0013-casting.md).
#pragma once

#include "base/vector.h"

namespace pprt {

// Sums over samples. Errors are squared differences of colours, see display_error().
struct CastEvidence {
  double asked = 0;  // cast samples, drawn at random, that a ray was sent to
  double hidden = 0;
  double stale = 0;  // of those seen, the ones whose colour depends on the eye: traced anew
  double stale_error = 0;
  double fresh = 0;        // samples traced in the last quarter of a frame
  double fresh_error = 0;  // of the picture there before them
  double fresh_rays = 0;
};

inline CastEvidence& operator+=(CastEvidence& a, const CastEvidence& b) {
  a.asked += b.asked, a.hidden += b.hidden, a.stale += b.stale, a.stale_error += b.stale_error;
  a.fresh += b.fresh, a.fresh_error += b.fresh_error, a.fresh_rays += b.fresh_rays;
  return a;
}

// What is known one frame later, when that counts half.
CastEvidence halved(CastEvidence evidence);

// Mean over the channels of the squared difference on the display scale [0, 1].
double display_error(const Color& a, const Color& b);

struct CastLimits {
  bool eye_dependent = true;  // whether samples whose colour depends on the eye are carried
  double share = 0.5;         // of the frame's time that putting samples back may take; 0: none is carried
};

// How many frames samples live, for the next frame.
int cast_life(const CastEvidence& evidence);

// `moved`: by how much cast samples have moved, mean, pixels.
CastLimits cast_limits(const CastEvidence& evidence, double moved, double samples_per_pixel);

}  // namespace pprt
