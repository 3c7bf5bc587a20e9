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
  double fresh_area = 0;   // of the triangles that they refined, square pixels
  double fresh_error = 0;  // of the picture there before them, each times that area: a stale colour is wrong
                           // over all that it stands for, the picture along its outlines
  double fresh_rays = 0;
  // What they cost, in milliseconds as FrameClock::lap_ms() has them.
  double fresh_ms = 0;  // of the fresh: choosing, tracing, inserting, telling others; where work has fixed
                        // prices it stays 0, and the table of prices decides
  double asked_ms = 0;  // of those asked: the ray alone
  double kept = 0;      // samples put back
  double kept_ms = 0;   // a ray not included
};

inline CastEvidence& operator+=(CastEvidence& a, const CastEvidence& b) {
  a.asked += b.asked, a.hidden += b.hidden, a.stale += b.stale, a.stale_error += b.stale_error;
  a.fresh += b.fresh, a.fresh_error += b.fresh_error, a.fresh_rays += b.fresh_rays;
  a.fresh_area += b.fresh_area;
  a.fresh_ms += b.fresh_ms, a.asked_ms += b.asked_ms, a.kept += b.kept, a.kept_ms += b.kept_ms;
  return a;
}

// What is known one frame later, when that counts half.
CastEvidence halved(CastEvidence evidence);

// Mean over the channels of the squared difference on the display scale [0, 1].
double display_error(const Color& a, const Color& b);

struct CastLimits {
  bool eye_dependent = true;  // whether samples whose colour depends on the eye are carried
  double share = 0.5;         // of the frame's time that putting samples back may take; 0: none is carried
  bool one_a_pixel = false;   // the youngest, no others
};

// What survives of a region's samples, as cast into the next picture.
struct CastSurvivors {
  double moved = 0;              // mean, pixels
  double eye_dependent = 0;      // share whose colour depends on the eye
  double samples_per_pixel = 0;  // before they were cast
};

// How many frames samples live, kLongLife at most.
int cast_life(const CastEvidence& evidence, double eye_dependent_share);

CastLimits cast_limits(const CastEvidence& evidence, const CastSurvivors& survivors);

// The same where the eye rests, and only the view turns or widens: then nothing is hidden, no colour changes,
// and samples live for kLongLife.
CastLimits cast_limits_at_rest(const CastSurvivors& survivors);

inline constexpr int kLongLife = 4;  // frames

}  // namespace pprt
