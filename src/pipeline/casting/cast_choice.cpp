#include "pipeline/casting/cast_choice.h"

#include <algorithm>

#include "pipeline/casting/casting.h"

namespace pprt {
namespace {

// Stale colours are carried while their root mean square error is at most this multiple of the picture's in
// the triangles that are refined.
constexpr double kStaleAtMost = 1.1;

// Below this multiple samples serve for longer, in pictures where most colours depend on the eye.
constexpr double kGoodAtMost = 0.65;
constexpr double kMost = 0.5;

// Largest cost of a cast sample that proves right, over that of a fresh one, both measured. The first holds
// where all samples may be carried. The second holds where colours that depend on the eye may not, or there
// are none: the rest then is smooth, or its outlines need their samples elsewhere.
constexpr double kCostAtMost = 0.8;
constexpr double kCostAtMostOfSome = 0.25;

// The same ratio by fixed prices. In a picture of outlines that has moved little a cast sample may cost more
// than a fresh one: it lies where an outline still is.
constexpr double kPriceAtMost = 0.9;
constexpr double kPriceAtMostOnOutlines = 1.1;

// Where this share proves hidden, the outlines have changed and older samples tell little of them. In a
// coarse picture most of the error is there, unless it is in reflections: fresh samples serve it better.
constexpr double kHiddenMany = 0.16;
constexpr double kMovedFar = 2.5;  // pixels
constexpr double kCoarse = 1;      // samples a pixel
constexpr double kShareThen = 0.2;

// Samples a pixel beyond which cast samples add nothing but their error.
constexpr double kPlenty = 4;

double hidden_share(const CastEvidence& e) {
  return e.asked > 0 ? e.hidden / e.asked : 0;
}

// Whether the error of stale colours is at most `limit` times the picture's. False without a comparison.
bool stale_within(const CastEvidence& e, double limit) {
  return e.stale > 0 && e.fresh_area > 0 &&
         e.stale_error / e.stale <= limit * limit * e.fresh_error / e.fresh_area;
}

// Whether a cast sample is so much cheaper than a fresh one that it pays for the hidden ones as well, by
// measured times. False until both times are known.
bool is_cheap(const CastEvidence& e, bool all_serve) {
  if (e.asked == 0 || e.reinserted == 0) return false;
  const double cast = e.asked_ms / e.asked + e.reinserted_ms / e.reinserted, fresh = e.fresh_ms / e.fresh;
  return cast <= (all_serve ? kCostAtMost : kCostAtMostOfSome) * fresh * (1 - hidden_share(e));
}

// The same by fixed prices.
bool is_cheap_by_prices(const CastEvidence& e, const CastPrices& prices, bool on_outlines) {
  if (e.fresh == 0) return true;
  const double fresh = prices.fresh + prices.ray * e.fresh_rays / e.fresh;
  return prices.cast <= (on_outlines ? kPriceAtMostOnOutlines : kPriceAtMost) * fresh * (1 - hidden_share(e));
}

}  // namespace

CastEvidence halved(CastEvidence e) {
  for (double* sum : {&e.asked, &e.hidden, &e.stale, &e.stale_error, &e.fresh, &e.fresh_error, &e.fresh_area,
                      &e.fresh_rays, &e.fresh_ms, &e.asked_ms, &e.reinserted, &e.reinserted_ms}) {
    *sum *= 0.5;
  }
  return e;
}

int cast_life(const CastEvidence& evidence, double eye_dependent_share) {
  const bool serve_longer = eye_dependent_share > kMost && stale_within(evidence, kGoodAtMost) &&
                            hidden_share(evidence) <= kHiddenMany;
  return serve_longer ? kLongLife : kVerifiedMaxAge;
}

CastLimits cast_limits(const CastEvidence& evidence, const CastSummary& cast, const CastPrices& prices) {
  CastLimits limits;
  limits.eye_dependent = stale_within(evidence, kStaleAtMost);
  const bool has_outlines = cast.eye_dependent <= kMost;
  const bool moved_far = cast.moved > kMovedFar;
  const bool is_coarse = cast.samples_per_pixel < kCoarse;
  if (hidden_share(evidence) > kHiddenMany && moved_far && is_coarse && has_outlines)
    limits.share = kShareThen;
  const bool cheap = evidence.fresh_ms > 0 ? is_cheap(evidence, limits.eye_dependent)
                                           : is_cheap_by_prices(evidence, prices, has_outlines && !moved_far);
  if (!cheap || cast.samples_per_pixel > kPlenty) limits.share = 0;
  return limits;
}

// Outlines keep their samples when the eye rests, and more crowd there with every frame. The mean of a pixel
// on an outline then tells less and less how much of it lies on either side, so one sample a pixel is kept.
// Reflections are everywhere, and all their samples serve.
CastLimits cast_limits_at_rest(const CastSummary& cast) {
  CastLimits limits;
  limits.one_a_pixel = cast.samples_per_pixel >= kCoarse && cast.eye_dependent <= kMost;
  return limits;
}

}  // namespace pprt
