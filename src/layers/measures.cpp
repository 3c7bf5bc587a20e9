#include "layers/measures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/mesh/refinement_weight.h"

namespace pprt {
namespace {

Vec2d place(const Sample& sample) {
  return {sample.x, sample.y};
}

TriangleShape shape_of(const Triangulation& frame, const std::array<std::uint32_t, 3>& corners) {
  const auto& s = frame.samples;
  return triangle_shape(place(s[corners[0]]), place(s[corners[1]]), place(s[corners[2]]));
}

double area_of(const Triangulation& frame, const std::array<std::uint32_t, 3>& corners) {
  const Vec2d a = place(frame.samples[corners[0]]);
  const Vec2d ab = place(frame.samples[corners[1]]) - a, ac = place(frame.samples[corners[2]]) - a;
  return 0.5 * std::abs(ab.x * ac.y - ab.y * ac.x);
}

}  // namespace

std::vector<float> sample_counts(const Triangulation& frame) {
  std::vector<float> counts(frame.triangle_at.size(), 0);
  for (const Sample& sample : frame.samples) {
    const int x = std::clamp(static_cast<int>(sample.x), 0, frame.width - 1);
    const int y = std::clamp(static_cast<int>(sample.y), 0, frame.height - 1);
    ++counts[static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) +
             static_cast<std::size_t>(x)];
  }
  return counts;
}

std::vector<float> ages(const Triangulation& frame, int frame_number) {
  std::vector<float> at_samples;
  for (const Sample& sample : frame.samples) {
    at_samples.push_back(static_cast<float>(frame_number - sample.frame));
  }
  return interpolate(frame, at_samples);
}

std::vector<float> densities(const Triangulation& frame) {
  std::vector<double> areas(frame.samples.size(), 0);
  for (const auto& corners : frame.triangles) {
    const double third = area_of(frame, corners) / 3;
    for (const std::uint32_t corner : corners) areas[corner] += third;
  }
  std::vector<float> at_samples;
  at_samples.reserve(areas.size());
  for (const double area : areas) at_samples.push_back(area > 0 ? static_cast<float>(1 / area) : 0);
  return interpolate(frame, at_samples);
}

std::vector<float> costs(const Triangulation& frame) {
  std::vector<float> at_samples;
  for (const Sample& sample : frame.samples) at_samples.push_back(static_cast<float>(sample.ray.rays));
  return interpolate(frame, at_samples);
}

std::vector<float> weights(const Triangulation& frame) {
  std::vector<float> of_triangles;
  for (const auto& corners : frame.triangles) {
    const auto color = [&](std::size_t i) -> const Color& { return frame.samples[corners[i]].ray.color; };
    of_triangles.push_back(
        refinement_weight(shape_of(frame, corners), display_variance(color(0), color(1), color(2))));
  }
  std::vector<float> values(frame.triangle_at.size(), std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (frame.triangle_at[i] != kNoTriangle) values[i] = of_triangles[frame.triangle_at[i]];
  }
  return values;
}

}  // namespace pprt
