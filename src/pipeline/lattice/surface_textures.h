// What textures show at the nodes of the lattice. They are known without a ray, so that only the light on
// them is interpolated (docs/decisions/0036-textures.md).
#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "base/probe.h"
#include "pipeline/lattice/lattice_node.h"
#include "pipeline/lattice/node_cache.h"
#include "pipeline/visibility/visibility_buffer.h"

namespace pprt {

// The factor of a surface's colours at a place. The last lane is 1; 0: not known.
using TextureFactor = float4;
inline bool is_known(const TextureFactor& factor) {
  return factor[3] > 0;
}

// The light on a texture: the factor that explains the colours of some samples best, in each channel, by
// least squares. A doubt of the light that is usual speaks where all texels are black.
struct TextureLight {
  float4 products{}, squares{};  // sums of colour times texture, and of the texture's squares

  void add(const float4& color, const TextureFactor& texture, float weight) {
    products += color * texture * weight, squares += texture * texture * weight;
  }
  float4 with(const float4& usual) const {
    constexpr float kDoubt = 0.01F;
    return (products + usual * kDoubt) / (squares + kDoubt);
  }
};

// Returns a colour under this light where the texture is another.
inline float4 retextured(const float4& color, const float4& light, const TextureFactor& from,
                         const TextureFactor& to) {
  const float4 changed = color + light * (to - from);
  return changed > 0 ? changed : float4{};
}

// The references must outlive the object.
class SurfaceTextures {
 public:
  SurfaceTextures(PrimitiveTextures textures, VisibilityBuffer& visibility)
      : textures_(std::move(textures)), visibility_(visibility) {}

  // What is seen is forgotten.
  void forget() { kept_.clear(); }

  // Whether there are any in the scene.
  bool any() const { return !textures_.are_there.empty(); }

  // Whether a surface shows a texture. Only if the visibility is known.
  bool has(std::uint32_t surface) const {
    return surface < textures_.are_there.size() && textures_.are_there[surface] != 0;
  }

  // Returns what the texture of a surface shows at a node, filtered as a sample there is.
  TextureFactor at(const LatticeNode& node, std::uint32_t surface);

  // Returns the mean over a square of the image about a point. `side`: its side, pixels.
  TextureFactor over(const Vec2d& point, double side, std::uint32_t surface) const;

  // Returns that of a primitive over a pixel.
  TextureFactor in_pixel(const Vec2d& middle, std::uint32_t primitive) const;

  // Means over squares are made of so many in a row from now on.
  void divide_by(int per_side) { per_side_ = per_side; }

  // Returns what a sample's surface shows where its texture is another.
  float4 moved(const NodeValue& value, const LatticeNode& node, const TextureFactor& to);

  // The light on textures, in the mean of all samples.
  void learn(const NodeValue& value, const LatticeNode& node) {
    constexpr float kMost = 16;  // brighter ones would count alone
    all_.add(min(value.channels(), float4{} + kMost), at(node, value.surface()), 1);
  }
  void fade(float share) { all_.products *= share, all_.squares *= share; }
  void update() { usual_ = all_.with(float4{1, 1, 1, 0}); }
  void clear() { all_ = {}, update(); }
  const float4& usual() const { return usual_; }

 private:
  TextureFactor of_primitive(std::uint32_t primitive, const Vec2d& point, double side, int per_side) const;

  PrimitiveTextures textures_;
  VisibilityBuffer& visibility_;
  NodeCache<TextureFactor> kept_;  // by surface
  TextureLight all_;
  float4 usual_{1, 1, 1, 0};
  int per_side_ = 4;
};

}  // namespace pprt
