#include "pipeline/preparation/casting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>

#include "pipeline/sampling/sample_mesh.h"

namespace pprt {
namespace {

enum class Fate : std::uint8_t { kForeign, kOutOfView, kTooOld, kHidden, kSurvives };

struct Flight {
  Vec2d point{0, 0};    // in the next image
  double distance = 0;  // from the next eye; infinite for the background
  Fate fate = Fate::kForeign;
  bool projected = false;
};

Flight fly(const Sample& sample, const SampleMesh& mesh, const Camera& next, int next_frame,
           const CastSettings& settings) {
  Flight flight;
  const Vec3d hit(sample.ray.hit);
  const Vec3d from_eye = sample.ray.at_infinity ? hit : hit - next.eye;
  flight.distance = sample.ray.at_infinity ? std::numeric_limits<double>::infinity() : from_eye.length();
  const std::optional<Vec2d> point = project(next, from_eye);
  if (point) {
    flight.point = *point;
    flight.projected = true;
  }
  if (!mesh.region().owns_point(sample.x, sample.y)) return flight;
  const bool in_view =
      point && point->x >= 0 && point->x <= next.width && point->y >= 0 && point->y <= next.height;
  const int max_age = sample.ray.eye_dependent ? settings.max_age_eye_dependent : settings.max_age;
  if (!in_view) {
    flight.fate = Fate::kOutOfView;
  } else if (next_frame - sample.frame > max_age) {
    flight.fate = Fate::kTooOld;
  } else {
    flight.fate = Fate::kSurvives;
  }
  return flight;
}

// A triangle of the old triangulation that turned over holds a hidden sample: the one farthest from the eye,
// and any other at nearly its distance (paper s. 4.2). "Nearly": within one part in a hundred.
void hide_behind_turned_triangles(const SampleMesh& mesh, std::vector<Flight>& flights) {
  constexpr double kNearly = 0.99;
  for (const Delaunay::Triangle& t : mesh.triangulation().triangles()) {
    if (!t.is_finite()) continue;
    const std::array<Flight*, 3> corner = {&flights[t.corners[0]], &flights[t.corners[1]],
                                           &flights[t.corners[2]]};
    if (!corner[0]->projected || !corner[1]->projected || !corner[2]->projected) continue;
    const Vec2d ab = corner[1]->point - corner[0]->point, ac = corner[2]->point - corner[0]->point;
    // Corners are counter-clockwise, so a triangle that keeps its sense has a positive cross product.
    if (ab.x * ac.y - ab.y * ac.x > 0) continue;
    const double farthest = std::max({corner[0]->distance, corner[1]->distance, corner[2]->distance});
    for (Flight* flight : corner) {
      if (flight->distance >= kNearly * farthest && flight->fate == Fate::kSurvives)
        flight->fate = Fate::kHidden;
    }
  }
}

// A number that looks random, different for every id.
std::uint64_t scattered(SampleId id) {
  id = (id ^ (id >> 31)) * 0x9E3779B97F4A7C15u;
  return (id ^ (id >> 29)) * 0xBF58476D1CE4E5B9u;
}

bool is_younger(const Sample& a, const Sample& b) {
  return a.frame != b.frame ? a.frame > b.frame : scattered(a.id) < scattered(b.id);
}

}  // namespace

CastResult cast_samples(const SampleMesh& mesh, const Camera& next, int next_frame,
                        const CastSettings& settings) {
  CastResult result;
  const auto land = [&](const Sample& sample, const Flight& flight) {
    result.out_of_view += flight.fate == Fate::kOutOfView;
    result.too_old += flight.fate == Fate::kTooOld;
    result.hidden += flight.fate == Fate::kHidden;
    if (flight.fate != Fate::kSurvives) return;
    Sample& survivor = result.survivors.emplace_back(sample);
    survivor.x = flight.point.x;
    survivor.y = flight.point.y;
    const Vec2d way(survivor.x - sample.x, survivor.y - sample.y);
    result.moved += std::sqrt(way.dot(way));
  };
  const std::span<const Sample> samples = mesh.samples();
  const auto flight_of = [&](const Sample& s) { return fly(s, mesh, next, next_frame, settings); };
  if (settings.method == CastMethod::kPaper) {
    std::vector<Flight> flights(samples.size());
    std::transform(samples.begin(), samples.end(), flights.begin(), flight_of);
    hide_behind_turned_triangles(mesh, flights);
    for (std::size_t i = 0; i < samples.size(); ++i) land(samples[i], flights[i]);
  } else {
    for (const Sample& s : samples) {
      if (is_one_of(s, settings.one_of)) land(s, flight_of(s));
    }
  }
  if (!result.survivors.empty()) result.moved /= static_cast<double>(result.survivors.size());
  return result;
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
  std::vector<Sample> kept;
  for (const Sample& s : samples) {
    if (youngest.at(pixel_of(s)) == &s) kept.push_back(s);
  }
  samples = std::move(kept);
}

}  // namespace pprt
