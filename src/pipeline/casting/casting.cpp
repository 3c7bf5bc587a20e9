#include "pipeline/casting/casting.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>

#include "pipeline/casting/projected_samples.h"

namespace pprt {
namespace {

// Returns a pseudo-random number, different for every id.
std::uint64_t scattered(SampleId id) {
  id = (id ^ (id >> 31)) * 0x9E3779B97F4A7C15u;
  return (id ^ (id >> 29)) * 0xBF58476D1CE4E5B9u;
}

bool is_younger(const Sample& a, const Sample& b) {
  return a.frame != b.frame ? a.frame > b.frame : scattered(a.id) < scattered(b.id);
}

}  // namespace

ProjectedSample project_sample(const Sample& sample, const Region& region, const Camera& next, int next_frame,
                               const CastSettings& settings) {
  ProjectedSample projected;
  const Vec3d hit(sample.ray.hit);
  const Vec3d from_eye = sample.ray.at_infinity ? hit : hit - next.eye;
  projected.distance = sample.ray.at_infinity ? std::numeric_limits<double>::infinity() : from_eye.length();
  const std::optional<Vec2d> point = project(next, from_eye);
  if (point) {
    projected.point = *point;
    projected.is_before_eye = true;
  }
  if (!region.owns_point(sample.x, sample.y)) return projected;
  const bool in_view =
      point && point->x >= 0 && point->x <= next.width && point->y >= 0 && point->y <= next.height;
  const int max_age = sample.ray.eye_dependent ? settings.max_age_eye_dependent : settings.max_age;
  if (!in_view) {
    projected.outcome = CastOutcome::kOutOfView;
  } else if (next_frame - sample.frame > max_age) {
    projected.outcome = CastOutcome::kTooOld;
  } else {
    projected.outcome = CastOutcome::kCast;
  }
  return projected;
}

bool is_carried(Sample& sample, const CastSettings& settings) {
  if (!settings.carry) return true;
  const Carried carried = settings.carry(sample.ray);
  return carried == Carried::kKept || (carried == Carried::kRelit && settings.lit_only);
}

void collect(const Sample& sample, const ProjectedSample& projected, CastResult& result) {
  result.out_of_view += projected.outcome == CastOutcome::kOutOfView;
  result.too_old += projected.outcome == CastOutcome::kTooOld;
  result.hidden += projected.outcome == CastOutcome::kHidden;
  if (projected.outcome != CastOutcome::kCast) return;
  Sample& cast = result.samples.emplace_back(sample);
  cast.x = projected.point.x;
  cast.y = projected.point.y;
  const Vec2d way(cast.x - sample.x, cast.y - sample.y);
  result.moved += std::sqrt(way.dot(way));
}

CastResult with_mean_way(CastResult result) {
  if (!result.samples.empty()) result.moved /= static_cast<double>(result.samples.size());
  return result;
}

CastResult cast_samples(std::span<const Sample> samples, const Region& region, const Camera& next,
                        int next_frame, const CastSettings& settings) {
  CastResult result;
  for (const Sample& s : samples) {
    const bool is_asked_for = !settings.lit_only || s.ray.lights.asked != 0;
    if (!is_asked_for || !is_one_of(s, settings.one_of)) continue;
    if (!settings.carry) {
      collect(s, project_sample(s, region, next, next_frame, settings), result);
      continue;
    }
    Sample carried = s;
    const bool is_there = is_carried(carried, settings);
    if (settings.lit_only && carried.ray.lights.asked == 0) continue;
    ProjectedSample projected = project_sample(carried, region, next, next_frame, settings);
    if (!is_there && projected.outcome == CastOutcome::kCast) projected.outcome = CastOutcome::kHidden;
    collect(carried, projected, result);
  }
  return with_mean_way(std::move(result));
}

std::size_t drop_hidden(std::vector<Sample>& samples, const Visibility& visible) {
  return std::erase_if(samples, [&](const Sample& s) { return !visible(s.ray.hit, s.ray.at_infinity); });
}

bool is_one_of(const Sample& sample, std::uint64_t many) {
  return (scattered(sample.id) >> 32) % many == 0;
}

void keep_youngest(std::vector<Sample>& samples, std::size_t limit) {
  if (samples.size() <= limit) return;
  std::vector<Sample> ordered = samples;
  const auto first_dropped = ordered.begin() + static_cast<std::ptrdiff_t>(limit);
  std::nth_element(ordered.begin(), first_dropped, ordered.end(), is_younger);
  std::erase_if(samples, [&](const Sample& s) { return !is_younger(s, *first_dropped); });
}

void keep_youngest_of_pixels(std::vector<Sample>& samples) {
  const auto pixel_of = [](const Sample& s) {
    const auto x = static_cast<std::uint32_t>(std::floor(s.x)),
               y = static_cast<std::uint32_t>(std::floor(s.y));
    return static_cast<std::uint64_t>(y) << 32 | x;
  };
  std::unordered_map<std::uint64_t, const Sample*> youngest;
  youngest.reserve(samples.size());
  for (const Sample& s : samples) {
    const Sample*& here = youngest[pixel_of(s)];
    if (here == nullptr || is_younger(s, *here)) here = &s;
  }
  std::vector<Sample> chosen;
  for (const Sample& s : samples) {
    if (youngest.at(pixel_of(s)) == &s) chosen.push_back(s);
  }
  samples = std::move(chosen);
}

}  // namespace pprt
