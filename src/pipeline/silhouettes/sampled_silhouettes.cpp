#include "pipeline/silhouettes/sampled_silhouettes.h"

#include <algorithm>

#include "pipeline/silhouettes/shape_nearness.h"

namespace pprt {
namespace {

// Points of a square, in shares of its side. No two in one row or column.
constexpr PerPoint kColumns = {0.0625F, 0.1875F, 0.3125F, 0.4375F, 0.5625F, 0.6875F, 0.8125F, 0.9375F};
constexpr PerPoint kRows = {0.4375F, 0.8125F, 0.0625F, 0.6875F, 0.1875F, 0.5625F, 0.9375F, 0.3125F};

float nearness_at(const ProjectedShapeCache& shapes, const ProjectedShapeCache::Shape& shape,
                  const Vec2d& point) {
  const auto x = static_cast<float>(point.x - shape.origin.x),
             y = static_cast<float>(point.y - shape.origin.y);
  if (shape.kind == ImageShape::Kind::kQuadric) return nearness(shape.quadric, x, y);
  const auto left = static_cast<float>(point.x), top = static_cast<float>(point.y);
  float nearest = 0;
  shapes.for_each_facet(shape, {left, top, left, top}, [&](const ProjectedFacet& facet) {
    nearest = std::max(nearest, nearness(facet, x, y));
  });
  return nearest;
}

using Shapes = std::array<const ProjectedShapeCache::Shape*, 4>;

// Returns the shares of a square that each shape is nearest in, counted at eight points. Null shapes cover
// nothing.
PPRT_CLONED_FOR_WIDE_REGISTERS
std::array<float, 4> covered_by(const ProjectedShapeCache& shapes, const Shapes& candidates,
                                const Vec2d& corner, float side) {
  const ImageBounds square = {static_cast<float>(corner.x), static_cast<float>(corner.y),
                              static_cast<float>(corner.x) + side, static_cast<float>(corner.y) + side};
  std::array<PerPoint, 4> near{};
  PerPoint nearest{};
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (candidates[i] == nullptr) continue;
    const ProjectedShapeCache::Shape& shape = *candidates[i];
    const PerPoint x = kColumns * side + static_cast<float>(corner.x - shape.origin.x);
    const PerPoint y = kRows * side + static_cast<float>(corner.y - shape.origin.y);
    if (shape.kind == ImageShape::Kind::kQuadric) {
      near[i] = nearness(shape.quadric, x, y);
    } else {
      shapes.for_each_facet(shape, square, [&](const ProjectedFacet& facet) {
        const PerPoint n = nearness(facet, x, y);
        near[i] = n > near[i] ? n : near[i];
      });
    }
    nearest = near[i] > nearest ? near[i] : nearest;
  }
  std::array<float, 4> covered{};
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const PerPoint is_seen = (near[i] == nearest) & (nearest > 0) ? PerPoint{} + 1.0F / kPoints : PerPoint{};
    covered[i] = sum_of(is_seen);
  }
  return covered;
}

bool is_repeated(std::span<const std::uint32_t> surfaces, std::size_t i) {
  const auto end = surfaces.begin() + static_cast<std::ptrdiff_t>(i);
  return std::find(surfaces.begin(), end, surfaces[i]) != end;
}

}  // namespace

void SampledSilhouettes::find_joined() {
  joined_.assign(surfaces_.size(), false);
  for (std::size_t primitive = 0; primitive < surfaces_.size(); ++primitive)
    if (surfaces_[primitive] != primitive) joined_[surfaces_[primitive]] = true;
}

// Returns where a surface's shape is kept; 0 if it is unknown.
ProjectedShapeCache::Place SampledSilhouettes::place_of(std::uint32_t surface, const Vec2d& point) {
  if (surface < joined_.size() && joined_[surface]) return 0;
  const ProjectedShapeCache::Place place = shapes_.find(surface, point);
  return shapes_.shape(place).kind == ImageShape::Kind::kUnknown ? 0 : place;
}

std::optional<std::uint32_t> SampledSilhouettes::nearest(const Vec2d& point,
                                                         std::span<const std::uint32_t> surfaces) {
  std::optional<std::uint32_t> seen;
  float nearest = 0;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (is_repeated(surfaces, i)) continue;
    if (surfaces[i] == 0) {
      if (!seen) seen = 0;
      continue;
    }
    const ProjectedShapeCache::Place place = place_of(surfaces[i], point);
    if (place == 0) return std::nullopt;
    const float near = nearness_at(shapes_, shapes_.shape(place), point);
    if (near > nearest) nearest = near, seen = surfaces[i];
  }
  return seen;
}

std::optional<std::array<float, 4>> SampledSilhouettes::shares(const Vec2d& corner, float side,
                                                               std::span<const std::uint32_t, 4> surfaces) {
  std::array<ProjectedShapeCache::Place, 4> places{};  // new shapes move others
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (surfaces[i] == 0 || is_repeated(surfaces, i)) continue;
    places[i] = place_of(surfaces[i], corner);
    if (places[i] == 0) return std::nullopt;
  }
  Shapes candidates{};
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    if (places[i] != 0) candidates[i] = &shapes_.shape(places[i]);
  std::array<float, 4> shares = covered_by(shapes_, candidates, corner, side);
  const float all = (shares[0] + shares[1]) + (shares[2] + shares[3]);
  for (float& share : shares) share *= 1 / std::max(all, 1.0F);
  const auto background = std::find(surfaces.begin(), surfaces.end(), 0U);
  if (background != surfaces.end())
    shares[static_cast<std::size_t>(background - surfaces.begin())] = std::max(1 - all, 0.0F);
  return shares;
}

}  // namespace pprt
