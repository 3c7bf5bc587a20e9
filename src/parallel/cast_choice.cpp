#include "parallel/cast_choice.h"

#include <algorithm>

#include "parallel/clock/work_units.h"
#include "pipeline/preparation/casting.h"

namespace pprt {
namespace {

// Root mean square error of a stale colour over that of the picture in the triangles that are refined: below,
// a carried sample is worth its time.
constexpr double kStaleAtMost = 1.1;

// The same: below, colours are so good that samples serve for longer, where most are of this kind.
constexpr double kGoodAtMost = 0.65;
constexpr double kMost = 0.5;

// What a carried sample that proves right costs over what a fresh one does, both measured: where all may be
// carried, and where colours that depend on the eye may not, or there are none. The rest then is dull, or its
// outlines want their samples elsewhere.
constexpr double kCostAtMost = 0.8;
constexpr double kCostAtMostOfSome = 0.25;

// The same by the table of prices, where work has no other. In a picture of outlines that has moved little a
// carried one is worth more than another: it lies where an outline still is.
constexpr double kPriceAtMost = 0.9;
constexpr double kPriceAtMostOnOutlines = 1.1;

// Where so many prove hidden, the outlines have changed: older samples tell little of them. Most of a coarse
// picture's error is in them, if not in reflections; then time is better spent on fresh samples there.
constexpr double kHiddenMany = 0.16;
constexpr double kMovedFar = 2.5;  // pixels
constexpr double kCoarse = 1;      // samples a pixel
constexpr double kShareThen = 0.2;

// Samples a pixel beyond which the picture lacks nothing that a carried sample could add, but its error.
constexpr double kPlenty = 4;

double hidden_share(const CastEvidence& e) {
  return e.asked > 0 ? e.hidden / e.asked : 0;
}

// Whether the error of stale colours is at most so many times the picture's. Without a comparison there is
// no reason to trust them.
bool stale_within(const CastEvidence& e, double limit) {
  return e.stale > 0 && e.fresh_area > 0 &&
         e.stale_error / e.stale <= limit * limit * e.fresh_error / e.fresh_area;
}

// Whether a carried sample is so much cheaper than a fresh one that it pays for the hidden ones as well. By
// what both cost; nothing is carried before that is known.
bool is_cheap(const CastEvidence& e, bool all_serve) {
  if (e.asked == 0 || e.kept == 0) return false;
  const double carried = e.asked_ms / e.asked + e.kept_ms / e.kept, fresh = e.fresh_ms / e.fresh;
  return carried <= (all_serve ? kCostAtMost : kCostAtMostOfSome) * fresh * (1 - hidden_share(e));
}

// The same by the table of prices.
bool is_cheap_by_table(const CastEvidence& e, bool on_outlines) {
  if (e.fresh == 0) return true;
  const auto carried =
      static_cast<double>(price(Work::kCastSample) + price(Work::kRay) + price(Work::kKeptSample));
  const double fresh = static_cast<double>(price(Work::kOwnSample)) +
                       static_cast<double>(price(Work::kRay)) * e.fresh_rays / e.fresh;
  return carried <= (on_outlines ? kPriceAtMostOnOutlines : kPriceAtMost) * fresh * (1 - hidden_share(e));
}

}  // namespace

CastEvidence halved(CastEvidence e) {
  for (double* sum : {&e.asked, &e.hidden, &e.stale, &e.stale_error, &e.fresh, &e.fresh_error, &e.fresh_area,
                      &e.fresh_rays, &e.fresh_ms, &e.asked_ms, &e.kept, &e.kept_ms}) {
    *sum *= 0.5;
  }
  return e;
}

double display_error(const Color& a, const Color& b) {
  const auto difference = [](float p, float q) {
    return static_cast<double>(std::clamp(p, 0.0f, 1.0f)) - static_cast<double>(std::clamp(q, 0.0f, 1.0f));
  };
  const Vec3d d(difference(a.x, b.x), difference(a.y, b.y), difference(a.z, b.z));
  return d.dot(d) / 3;
}

int cast_life(const CastEvidence& evidence, double eye_dependent_share) {
  const bool serve_longer = eye_dependent_share > kMost && stale_within(evidence, kGoodAtMost) &&
                            hidden_share(evidence) <= kHiddenMany;
  return serve_longer ? kLongLife : kVerifiedMaxAge;
}

CastLimits cast_limits(const CastEvidence& evidence, const CastSurvivors& survivors) {
  const CastEvidence& e = evidence;
  CastLimits limits;
  limits.eye_dependent = stale_within(e, kStaleAtMost);
  const double hidden = hidden_share(e);
  const bool outlines_matter = survivors.samples_per_pixel < kCoarse && survivors.eye_dependent <= kMost;
  const bool moved_far = survivors.moved > kMovedFar;
  if (hidden > kHiddenMany && moved_far && outlines_matter) limits.share = kShareThen;
  const bool cheap = e.fresh_ms > 0 ? is_cheap(e, limits.eye_dependent)
                                    : is_cheap_by_table(e, survivors.eye_dependent <= kMost && !moved_far);
  if (!cheap) limits.share = 0;
  if (survivors.samples_per_pixel > kPlenty) limits.share = 0;
  return limits;
}

// Outlines keep their samples then, and more crowd there with every frame: the mean of a pixel on an outline
// tells less and less how much of it lies on either side. Reflections are everywhere, and all samples serve.
CastLimits cast_limits_at_rest(const CastSurvivors& survivors) {
  CastLimits limits;
  limits.one_a_pixel = survivors.samples_per_pixel >= kCoarse && survivors.eye_dependent <= kMost;
  return limits;
}

}  // namespace pprt
