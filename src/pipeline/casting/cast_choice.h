// Decides from measured costs and errors whether casting pays: the rules of --cast auto
// (docs/decisions/0013-casting.md).
#pragma once

#include "base/vector.h"

namespace pprt {

// What the ranks have measured of casting: counts and sums over samples. Errors are display_error()
// (core/display_values.h), times are milliseconds. Under a clock with fixed prices `fresh_ms` stays 0, and
// CastPrices decide instead.
struct CastEvidence {
  double asked = 0;        // cast samples, drawn at random, that a visibility ray was sent to
  double hidden = 0;       // of those, the ones that proved hidden
  double stale = 0;        // visible ones whose colour depends on the eye; they were traced anew
  double stale_error = 0;  // of their old colours against the new ones
  double fresh = 0;        // samples traced in the last quarter of a frame
  double fresh_area = 0;   // of the triangles that they refined, square pixels
  double fresh_error = 0;  // of the picture there before them, each times that area. A stale colour is wrong
                           // over all that it stands for, the picture only along its outlines.
  double fresh_rays = 0;   // in the ray trees of the fresh samples
  double fresh_ms = 0;     // choosing, tracing, inserting and announcing the fresh samples
  double asked_ms = 0;     // the visibility rays
  double reinserted = 0;   // cast samples inserted into the new triangulation
  double reinserted_ms = 0;
};

inline CastEvidence& operator+=(CastEvidence& a, const CastEvidence& b) {
  a.asked += b.asked, a.hidden += b.hidden, a.stale += b.stale, a.stale_error += b.stale_error;
  a.fresh += b.fresh, a.fresh_error += b.fresh_error, a.fresh_rays += b.fresh_rays;
  a.fresh_area += b.fresh_area;
  a.fresh_ms += b.fresh_ms, a.asked_ms += b.asked_ms;
  a.reinserted += b.reinserted, a.reinserted_ms += b.reinserted_ms;
  return a;
}

// Returns the evidence with half its weight: what it counts one frame later.
CastEvidence halved(CastEvidence evidence);

// Fixed prices for one sample, all in one unit. They decide where no times are measured.
struct CastPrices {
  double cast = 0;   // projecting it, the ray that checks it, reinserting it
  double fresh = 0;  // choosing and inserting a traced one, without its rays
  double ray = 0;
};

// What a region's cast samples are like.
struct CastSummary {
  double moved = 0;              // mean distance between old and new image point, pixels
  double eye_dependent = 0;      // share whose colour depends on the eye
  double samples_per_pixel = 0;  // of the region, before casting
};

// Which samples are carried into the next frame.
struct CastLimits {
  bool eye_dependent = true;  // also those whose colour depends on the eye
  double share = 0.5;         // largest share of the frame's time spent on reinserting; 0: none is carried
  bool one_a_pixel = false;   // only the youngest of each pixel
};

inline constexpr int kLongLife = 4;  // frames

// Returns the number of frames that a sample may live: kVerifiedMaxAge, or kLongLife where colours hold.
int cast_life(const CastEvidence& evidence, double eye_dependent_share);

// Decides what is carried where the eye has moved.
CastLimits cast_limits(const CastEvidence& evidence, const CastSummary& cast, const CastPrices& prices);

// Decides the same where the eye rests and the view only turns or widens. Nothing is hidden then, no colour
// changes, and samples live for kLongLife.
CastLimits cast_limits_at_rest(const CastSummary& cast);

}  // namespace pprt
