#include "pipeline/lattice/surface_colors.h"

#include <algorithm>

namespace pprt {
namespace {

float4 bilinear(const std::array<float4, 4>& colors, const std::array<float, 4>& weights) {
  return (colors[0] * weights[0] + colors[1] * weights[1]) +
         (colors[2] * weights[2] + colors[3] * weights[3]);
}

constexpr std::array<float, 4> kInTheMiddle = {0.25F, 0.25F, 0.25F, 0.25F};

}  // namespace

SurfaceColors::AtCorners& SurfaceColors::at_corners(const Square& square, std::uint32_t surface,
                                                    const Vec2d& middle) {
  for (std::size_t i = 0; i < known_; ++i)
    if (found_[i].surface == surface) return found_[i];
  if (known_ == found_.size()) known_ = 0;
  AtCorners& found = found_[known_++];
  found.surface = surface, found.lit_primitive = 0;
  find(square, node_at(middle), found);
  return found;
}

// A corner on another surface takes the colour of those beside it that lie on this one. Without any it takes
// that of the corner across, or of a sample near by. SurfaceShare tells how far, unless the light on the
// surface and its own colour are all that is seen of it.
void SurfaceColors::find(const Square& square, const LatticeNode& at, AtCorners& found) {
  const SquareCorners& corners = square.corners;
  const std::array<LatticeNode, 4> nodes = nodes_of(square.corner, square.side);
  const std::uint32_t surface = found.surface;
  const bool has_texture = textures_.has(surface), is_curved = lights_.is_curved(surface);
  for (std::size_t i = 0; i < 4; ++i) found.colors[i] = corners[i].channels();
  if (has_texture) find_textures(square, found);
  if (is_curved) find_light(square, found);
  std::array<float, 4> on_it;
  float all = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    on_it[i] = corners[i].surface() == surface ? 1 : 0;
    all += on_it[i];
  }
  if (all == 4) return;
  const bool is_all = lights_.of(surface).is_all;
  const SurfaceSamples::Known* near = all > 0 ? nullptr : samples_.nearest(at, surface);
  if (all == 0 && near == nullptr) {
    if (is_all) take_shading(square, at, found);
    return;
  }
  const Basis basis = near != nullptr ? Basis::kNearSample : basis_of(static_cast<std::size_t>(all), 4);
  const float share = is_all ? 1 : share_.of(basis, errors_.near(at).level);
  for (std::size_t i = 0; i < 4; ++i) {
    if (on_it[i] > 0) continue;
    const std::size_t beside = i ^ 1U, above = i ^ 2U, across = i ^ 3U;
    const float adjacent = on_it[beside] + on_it[above];
    const auto beside_it = [&](const auto& value_of) -> float4 {
      return adjacent > 0
                 ? (value_of(beside) * on_it[beside] + value_of(above) * on_it[above]) * (1 / adjacent)
                 : value_of(across);
    };
    if (is_curved) {
      const std::size_t from = on_it[beside] > 0 ? beside : on_it[above] > 0 ? above : across;
      take_light(near != nullptr ? near->value : corners[from], near != nullptr ? near->node : nodes[from],
                 share, i, found);
    }
    const float4 channels = near != nullptr ? near->value.channels()
                                            : beside_it([&](std::size_t k) { return corners[k].channels(); });
    found.colors[i] += (channels - found.colors[i]) * share;
    if (!has_texture) continue;
    const TextureFactor texture = near != nullptr
                                      ? textures_.at(near->node, surface)
                                      : beside_it([&](std::size_t k) { return found.textures[k]; });
    found.textures[i] =
        is_known(texture) ? texture * (1 / texture[3]) : TextureFactor{};  // one may be unknown
  }
}

void SurfaceColors::find_textures(const Square& square, AtCorners& found) {
  const std::array<LatticeNode, 4> nodes = nodes_of(square.corner, square.side);
  for (std::size_t i = 0; i < 4; ++i) {
    const bool is_on_it = square.corners[i].surface() == found.surface;
    found.textures[i] = is_on_it ? textures_.at(nodes[i], found.surface) : TextureFactor{};
  }
}

void SurfaceColors::find_light(const Square& square, AtCorners& found) {
  const std::array<LatticeNode, 4> nodes = nodes_of(square.corner, square.side);
  for (std::size_t i = 0; i < 4; ++i) {
    found.without_lights[i] = found.colors[i], found.seen[i] = 0, found.shares[i] = 0;
    if (square.corners[i].surface() == found.surface) take_light(square.corners[i], nodes[i], 1, i, found);
  }
}

// A corner's colour becomes that of a node on the surface, to the share.
void SurfaceColors::take_light(const NodeValue& from, const LatticeNode& node, float share,
                               std::size_t corner, AtCorners& found) {
  const float4 own = from.channels() - lights_.part_of(from, node);
  float4& without = found.without_lights[corner];
  without += (own - without) * share;
  found.seen[corner] = from.lights(), found.shares[corner] = share;
}

// No sample tells of the surface, but which lights are seen is known of others around.
void SurfaceColors::take_shading(const Square& square, const LatticeNode& at, AtCorners& found) {
  const UnshadowedLight& light = lights_.at(at, found.surface);
  if (!light.is_known) return;
  for (std::size_t i = 0; i < 4; ++i) {
    found.without_lights[i] = light.unlit, found.seen[i] = square.corners[i].lights(), found.shares[i] = 1;
    found.colors[i] = light.unlit + light.of(found.seen[i]);
  }
}

// The light on a texture is bilinear, and so is what samples show of the texture itself. `texture` is known.
float4 SurfaceColors::on_texture(const AtCorners& at, const std::array<float, 4>& weights,
                                 const TextureFactor& texture) const {
  float4 known{};
  TextureLight light;
  for (std::size_t i = 0; i < 4; ++i) {
    const TextureFactor& there = at.textures[i];
    known += (is_known(there) ? there : texture) * weights[i];
    if (is_known(there)) light.add(at.colors[i], there, weights[i]);
  }
  return retextured(bilinear(at.colors, weights), light.with(textures_.usual()), known, texture);
}

float4 SurfaceColors::in_light(const AtCorners& at, const std::array<float, 4>& weights,
                               const UnshadowedLight& light, const float4& of_seen) {
  float4 color = bilinear(at.without_lights, weights);
  if (at.seen[0] == at.seen[1] && at.seen[0] == at.seen[2] && at.seen[0] == at.seen[3]) {
    float share = 0;
    for (std::size_t i = 0; i < 4; ++i) share += at.shares[i] * weights[i];
    color += of_seen * share;
  } else {
    for (std::size_t i = 0; i < 4; ++i) color += light.of(at.seen[i]) * (at.shares[i] * weights[i]);
  }
  return color > 0 ? color : float4{};
}

float4 SurfaceColors::in_pixel(const Square& square, const SeenPrimitive& seen, const Vec2d& middle,
                               const std::array<float, 4>& weights) {
  AtCorners& at = at_corners(square, seen.surface, middle);
  if (textures_.has(seen.surface)) {
    const TextureFactor texture = textures_.in_pixel(middle, seen.primitive);
    if (is_known(texture)) return on_texture(at, weights, texture);
  } else if (lights_.is_curved(seen.surface)) {
    if (seen.share >= kLittle || at.lit_primitive != seen.primitive) {
      lights_.at(seen.at, seen.primitive, at.light);
      at.lit_primitive = seen.primitive, at.of_seen = at.light.of(at.seen[0]);
    }
    if (at.light.is_known) return in_light(at, weights, at.light, at.of_seen);
  }
  return bilinear(at.colors, weights);
}

// The light is compared with that of the corners in the middle alone.
bool SurfaceColors::varies_in(const Square& square, std::uint32_t surface) {
  if (textures_.has(surface)) return true;
  if (!lights_.is_curved(surface)) return false;
  constexpr float kNotSeen = 0.5F / 255;
  const int half = square.side / 2;
  const LatticeNode middle{square.corner.x + half, square.corner.y + half};
  const AtCorners& at = at_corners(square, surface, point_of(middle));
  const UnshadowedLight& light = lights_.at(middle, surface);
  const float4 difference =
      abs(in_light(at, kInTheMiddle, light, light.of(at.seen[0])) - bilinear(at.colors, kInTheMiddle));
  return light.is_known && std::max({difference[0], difference[1], difference[2]}) > kNotSeen;
}

float4 SurfaceColors::mean_over(const Square& square) {
  const std::uint32_t surface = square.corners[0].surface();
  std::array<float4, 4> colors;
  for (std::size_t i = 0; i < 4; ++i) colors[i] = square.corners[i].channels();
  if (!textures_.has(surface)) return bilinear(colors, kInTheMiddle);
  const double side = static_cast<double>(square.side) / kPixelSide;
  const Vec2d middle = point_of(square.corner) + Vec2d(0.5, 0.5) * side;
  const TextureFactor texture = textures_.over(middle, side, surface);
  if (!is_known(texture)) return bilinear(colors, kInTheMiddle);
  AtCorners at;
  at.surface = surface, at.colors = colors;
  find_textures(square, at);
  return on_texture(at, kInTheMiddle, texture);
}

}  // namespace pprt
