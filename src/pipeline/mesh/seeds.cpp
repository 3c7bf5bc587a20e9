#include "pipeline/mesh/seeds.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/hash.h"

namespace pprt {

std::vector<Vec2d> seed_points(int width, int height, std::uint64_t seed) {
  constexpr std::uint64_t kStream = 1;  // of random numbers: the same for every frame
  constexpr double kJitter = 0.5;       // share of a cell: neighbours stay apart, and no three rows align
  const double w = width, h = height;
  const double spacing = std::max(kSeedSpacing, std::sqrt(w * h / kMostSeeds));
  const int columns = std::max(1, static_cast<int>(std::ceil(w / spacing)));
  const int rows = std::max(1, static_cast<int>(std::ceil(h / spacing)));
  std::vector<Vec2d> points = {{0, 0}, {w, 0}, {w, h}, {0, h}};
  points.reserve(static_cast<std::size_t>(columns + 1) * static_cast<std::size_t>(rows + 1));
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      const bool on_side = i == 0 || i == columns, on_end = j == 0 || j == rows;
      if (on_side && on_end) continue;  // a corner
      const auto index = 2 * (static_cast<std::uint64_t>(j) * 0x10000u + static_cast<std::uint64_t>(i));
      const double dx = on_side ? 0 : kJitter * (uniform(seed, kStream, index) - 0.5);
      const double dy = on_end ? 0 : kJitter * (uniform(seed, kStream, index + 1) - 0.5);
      points.emplace_back((i + dx) / columns * w, (j + dy) / rows * h);
    }
  }
  return points;
}

SeedPattern seed_pattern(int width, int height, std::uint64_t seed) {
  SeedPattern pattern{seed_points(width, height, seed), {}};
  SampleMesh mesh(Region::whole({width, height, std::max(width, height)}), {.learned = false});
  for (const Vec2d& p : pattern.points) {
    Sample sample;
    sample.x = p.x, sample.y = p.y;
    mesh.insert(sample);
  }
  const auto at = [&](std::uint32_t i) { return pattern.points[i]; };
  for (const std::array<std::uint32_t, 3>& t : triangles(mesh)) {
    pattern.triangles.push_back({triangle_shape(at(t[0]), at(t[1]), at(t[2])).circumcircle, t});
  }
  return pattern;
}

}  // namespace pprt
