#include "parallel/rank/reprojection.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "parallel/settings/work_units.h"
#include "pipeline/casting/cast_choice.h"
#include "pipeline/core/display_values.h"

namespace pprt {
namespace {

// Share of a frame's time that reinserting cast samples may take.
constexpr double kCastShare = 0.5;

// A trial shows whether casting pays. It casts some of the samples before the others, and tries out one in
// eight of these with a ray. That is one in 64 of all samples, at most about 512.
constexpr std::uint64_t kDrawnForEachTried = 8;
std::uint64_t tried_one_of(std::uint64_t samples) {
  constexpr std::uint64_t kAtLeast = 64, kEnough = 512;
  return std::max(kAtLeast, std::bit_ceil(samples / kEnough));
}

CastSettings verified(int life) {
  return {.method = CastMethod::kVerified, .max_age = life, .max_age_eye_dependent = life};
}

}  // namespace

void Reprojection::begin_frame() {
  evidence_before_ = std::exchange(evidence_, {});
  retraced_ = 0;
}

std::vector<Sample> Reprojection::cast(const FrameOrder& order, bool eye_rests) {
  if (sampler_.traits().cast_use == CastUse::kLights) return cast_for_lights(order);
  if (order.carry == Carry::kCastWherePaying)
    return eye_rests ? cast_at_rest(order) : cast_where_paying(order);
  const bool by_paper = order.carry == Carry::kCastPaper;
  std::vector<Sample> samples =
      cast_into(order, by_paper ? CastSettings() : verified(kVerifiedMaxAge)).samples;
  keep_affordable(order, samples);
  if (!by_paper && !eye_rests) drop_hidden_samples(samples);
  return samples;
}

// Casting for lights pays where samples send some shadow rays: it saves those of one sample in two or three,
// and costs about one for each.
std::vector<Sample> Reprojection::cast_for_lights(const FrameOrder& order) {
  constexpr double kLeastShadowRays = 1.5;
  const std::span<const Sample> samples = sampler_.sampler().samples();
  if (order.carry == Carry::kCastWherePaying) {
    std::uint64_t asked = 0;
    for (const Sample& s : samples) asked += static_cast<std::uint64_t>(std::popcount(s.ray.lights.asked));
    if (static_cast<double>(asked) < kLeastShadowRays * static_cast<double>(samples.size())) return {};
  }
  return cast_into(order, verified(kVerifiedMaxAge)).samples;
}

std::vector<Sample> Reprojection::cast_at_rest(const FrameOrder& order) {
  CastResult cast = cast_into(order, verified(kLongLife));
  const CastLimits limits = cast_limits_at_rest(summary_of(cast));
  if (limits.one_a_pixel) keep_youngest_of_pixels(cast.samples);
  keep_affordable(order, limits.share, cast.samples);
  return std::move(cast.samples);
}

// Finds out from a few samples whether casting pays, before the others are touched: where it does not, it
// costs next to nothing.
std::vector<Sample> Reprojection::cast_where_paying(const FrameOrder& order) {
  const std::uint64_t tried_of = tried_one_of(sampler_.in_region());
  CastSettings settings = verified(kLongLife);
  settings.one_of = tried_of / kDrawnForEachTried;
  CastResult drawn = cast_into(order, settings);
  const CastSummary summary = summary_of(drawn);
  CastEvidence evidence = order.evidence;
  evidence += evidence_before_;
  const int life = cast_life(evidence, summary.eye_dependent);
  std::erase_if(drawn.samples,
                [&](const Sample& s) { return order.number - s.frame > life || !is_one_of(s, tried_of); });
  std::vector<Sample> tried = try_out(drawn.samples);
  evidence += evidence_;
  const CastLimits limits = cast_limits(evidence, summary, cast_prices());
  if (limits.share == 0) return tried;

  settings = verified(life);
  if (!limits.eye_dependent) settings.max_age_eye_dependent = 0;
  std::vector<Sample> samples = cast_into(order, settings).samples;
  std::erase_if(samples, [&](const Sample& s) { return is_one_of(s, tried_of); });
  keep_affordable(order, limits.share, samples);
  drop_hidden_samples(samples);
  samples.insert(samples.end(), tried.begin(), tried.end());
  return samples;
}

// Asks for each sample whether it is visible. Those whose colour depends on the eye are traced anew and
// become samples of this frame. Returns the visible ones.
std::vector<Sample> Reprojection::try_out(const std::vector<Sample>& samples) {
  timer_.end_stage(&StageTimes::casting);
  std::vector<Sample> visible;
  for (const Sample& s : samples) {
    if (tracer_.is_visible(s.ray.hit, s.ray.at_infinity)) visible.push_back(s);
  }
  evidence_.asked += static_cast<double>(samples.size());
  evidence_.hidden += static_cast<double>(samples.size() - visible.size());
  evidence_.asked_ms += timer_.end_stage(&StageTimes::casting);
  for (Sample& s : visible) {
    if (!s.ray.eye_dependent) continue;
    const Color stale = s.ray.color;
    s = tracer_.trace(s.x, s.y);
    ++retraced_;
    ++evidence_.stale;
    evidence_.stale_error += display_error(stale, s.ray.color);
  }
  return visible;
}

CastResult Reprojection::cast_into(const FrameOrder& order, const CastSettings& settings) {
  clock_.spend(Work::kCastSample, sampler_.in_region() / settings.one_of);
  CastSettings carrying = settings;
  if (tracer_.moves()) carrying.carry = tracer_.probe().carry;
  return sampler_.sampler().cast(order.camera, order.number, carrying);
}

CastSummary Reprojection::summary_of(const CastResult& cast) const {
  const auto of_eye = std::count_if(cast.samples.begin(), cast.samples.end(),
                                    [](const Sample& s) { return s.ray.eye_dependent; });
  const double count = static_cast<double>(std::max<std::size_t>(cast.samples.size(), 1));
  return {.moved = cast.moved,
          .eye_dependent = static_cast<double>(of_eye) / count,
          .samples_per_pixel = static_cast<double>(sampler_.in_region()) /
                               static_cast<double>(sampler_.region().pixel_count())};
}

void Reprojection::drop_hidden_samples(std::vector<Sample>& samples) {
  drop_hidden(samples,
              [this](const Vec3f& hit, bool at_infinity) { return tracer_.is_visible(hit, at_infinity); });
}

void Reprojection::keep_affordable(const FrameOrder& order, std::vector<Sample>& samples) const {
  keep_affordable(order, kCastShare, samples);
}

void Reprojection::keep_affordable(const FrameOrder& order, double share,
                                   std::vector<Sample>& samples) const {
  if (order.deadline_s > 0) keep_youngest(samples, clock_.affordable(Work::kKeptSample, share));
}

}  // namespace pprt
