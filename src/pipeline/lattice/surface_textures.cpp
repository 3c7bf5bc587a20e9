#include "pipeline/lattice/surface_textures.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace pprt {

TextureFactor SurfaceTextures::of_primitive(std::uint32_t primitive, const Vec2d& point, double side,
                                            int per_side) const {
  if (primitive == 0) return TextureFactor{};
  const std::optional<Color> factor = textures_.over(primitive, point.x, point.y, side, per_side);
  return factor ? TextureFactor{factor->x, factor->y, factor->z, 1} : TextureFactor{};
}

TextureFactor SurfaceTextures::over(const Vec2d& point, double side, std::uint32_t surface) const {
  const int per_side = std::max(1, static_cast<int>(per_side_ * side));  // a power of two, too
  return of_primitive(visibility_.primitive_at(point, surface), point, side, per_side);
}

TextureFactor SurfaceTextures::in_pixel(const Vec2d& middle, std::uint32_t primitive) const {
  return of_primitive(primitive, middle, 1, per_side_);
}

float4 SurfaceTextures::moved(const NodeValue& value, const LatticeNode& node, const TextureFactor& to) {
  const TextureFactor from = at(node, value.surface());
  if (!is_known(from)) return value.channels();
  TextureLight light;
  light.add(value.channels(), from, 1);
  return retextured(value.channels(), light.with(usual_), from, to);
}

TextureFactor SurfaceTextures::at(const LatticeNode& node, std::uint32_t surface) {
  return kept_.get(node, surface, [&] {
    const double side = std::min(1.0, footprint_of(node));  // as RankSampling::trace
    return of_primitive(visibility_.primitive_at(point_of(node), surface), point_of(node), side, 1);
  });
}

}  // namespace pprt
