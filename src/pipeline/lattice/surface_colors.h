// What surfaces show between the corners of a square of the lattice: what their samples found, their textures
// and the light on them (docs/decisions/0036-textures.md, 0037-lights.md).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "pipeline/lattice/lattice_node.h"
#include "pipeline/lattice/local_errors.h"
#include "pipeline/lattice/surface_lights.h"
#include "pipeline/lattice/surface_samples.h"
#include "pipeline/lattice/surface_share.h"
#include "pipeline/lattice/surface_textures.h"

namespace pprt {

// The corners of a square: left and right above, then left and right below.
using SquareCorners = std::array<NodeValue, 4>;

// A square with samples at its corners only.
struct Square {
  LatticeNode corner;
  int side;
  const SquareCorners& corners;
};

inline std::array<LatticeNode, 4> nodes_of(const LatticeNode& corner, int side) {
  const auto [x, y] = corner;
  return {{{x, y}, {x + side, y}, {x, y + side}, {x + side, y + side}}};
}

// A primitive that is seen in a pixel, a point of the image where it is, the mean of those found, and its
// share.
struct SeenPrimitive {
  std::uint32_t surface = 0, primitive = 0;
  Vec2d at{0, 0};   // pixels
  float share = 1;  // of the pixel
};

// The references must outlive the object. All is asked only if the visibility is known.
class SurfaceColors {
 public:
  SurfaceColors(const SurfaceSamples& samples, LocalErrors& errors, const SurfaceShare& share,
                SurfaceTextures& textures, SurfaceLights& lights)
      : samples_(samples), errors_(errors), share_(share), textures_(textures), lights_(lights) {}

  // Another square: what was found in the last one is forgotten.
  void begin() { known_ = 0; }

  // Whether a surface may show something else between the corners of a square than the bilinear mean.
  bool varies_in(const Square& square, std::uint32_t surface);

  // Returns what a primitive shows in a pixel of the square. `weights`: those of the corners there.
  float4 in_pixel(const Square& square, const SeenPrimitive& seen, const Vec2d& middle,
                  const std::array<float, 4>& weights);

  // Returns the mean over a square of at most a pixel that shows one surface.
  float4 mean_over(const Square& square);

 private:
  // A primitive with a smaller part of a pixel is lit as in the last one of the square.
  static constexpr float kLittle = 0.25F;

  // What a surface is taken to show at the corners of a square.
  struct AtCorners {
    std::uint32_t surface = 0;
    std::array<float4, 4> colors;
    std::array<TextureFactor, 4> textures;  // where these colours come from, if the surface has one
    // If lights are known on it: the colours without these, the lights seen, and how much they count.
    std::array<float4, 4> without_lights;
    std::array<std::uint8_t, 4> seen;
    std::array<float, 4> shares;
    // What the surface was lit by last in the square, by the lights that the first corner sees.
    std::uint32_t lit_primitive = 0;
    UnshadowedLight light;
    float4 of_seen;
  };

  AtCorners& at_corners(const Square& square, std::uint32_t surface, const Vec2d& middle);
  void find(const Square& square, const LatticeNode& at, AtCorners& found);
  void find_textures(const Square& square, AtCorners& found);
  void find_light(const Square& square, AtCorners& found);
  void take_light(const NodeValue& from, const LatticeNode& node, float share, std::size_t corner,
                  AtCorners& found);
  void take_shading(const Square& square, const LatticeNode& at, AtCorners& found);
  float4 on_texture(const AtCorners& at, const std::array<float, 4>& weights,
                    const TextureFactor& texture) const;
  static float4 in_light(const AtCorners& at, const std::array<float, 4>& weights,
                         const UnshadowedLight& light, const float4& of_seen);

  const SurfaceSamples& samples_;
  LocalErrors& errors_;
  const SurfaceShare& share_;
  SurfaceTextures& textures_;
  SurfaceLights& lights_;
  std::array<AtCorners, 16> found_;  // of the surfaces met in the square
  std::size_t known_ = 0;
};

}  // namespace pprt
