// Pictures given by a formula, to sample without a scene.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>

#include "pipeline/mesh/sample_mesh.h"
#include "pipeline/mesh/seeds.h"

namespace pprt {

using Picture = std::function<Color(double x, double y)>;

// A disc of radius 0.3 of the width in the middle: flat inside, flat outside, one sharp edge.
inline Picture disc(const TileGrid& grid) {
  return [grid](double x, double y) {
    const double dx = x - 0.5 * grid.width, dy = y - 0.5 * grid.height;
    return std::hypot(dx, dy) < 0.3 * grid.width ? Color(0.9f, 0.7f, 0.2f) : Color(0.1f, 0.1f, 0.3f);
  };
}

inline Sample sample_of(const Picture& picture, double x, double y, SampleId id = 0) {
  Sample sample;
  sample.x = x;
  sample.y = y;
  sample.id = id;
  sample.ray.color = picture(x, y);
  return sample;
}

// Seeds everywhere, then `count` samples where the mesh wants them.
inline SampleMesh refine(const Region& region, const Picture& picture, int count, std::uint64_t seed = 1,
                         const WeightTerms& terms = {}) {
  SampleMesh mesh(region, terms);
  for (const Vec2d& p : seed_points(region.grid().width, region.grid().height, seed)) {
    mesh.insert(sample_of(picture, p.x, p.y));
  }
  for (int i = 0; i < count; ++i) {
    const auto next = mesh.next_point();
    if (!next) break;
    mesh.insert(sample_of(picture, next->point.x, next->point.y));
  }
  return mesh;
}

}  // namespace pprt
