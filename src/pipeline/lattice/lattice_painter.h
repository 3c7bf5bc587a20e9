// From the lattice to pixels: each square of the lattice shows the mean over each pixel's area of what its
// corners make of it.
#pragma once

#include <algorithm>
#include <array>

#include "pipeline/core/pixel_block.h"
#include "pipeline/lattice/node_prediction.h"

namespace pprt {

// The values at a square's corners: upper left, upper right, lower left, lower right.
using SquareCorners = std::array<NodeValue, 4>;

// Paints a lattice. The references must outlive the object.
class LatticePainter {
 public:
  LatticePainter(const LatticeStore& store, NodePredictor& predictor, VisibilityBuffer& visibility,
                 const SurfaceSamples& surfaces, LocalErrors& errors, const SurfaceShare& share,
                 SurfaceTextures& textures)
      : store_(store),
        predictor_(predictor),
        visibility_(visibility),
        surfaces_(surfaces),
        errors_(errors),
        share_(share),
        textures_(textures) {}

  // Replaces the pixels of a part of `pixels`, a rectangle of the image within their bounds.
  void paint(const PixelRect& part, PixelBlock& pixels);

 private:
  void paint_square(const LatticeNode& corner, int side, const SquareCorners& corners);
  void fill(const LatticeNode& corner, int side, const SquareCorners& corners);
  float4 mean_over(const LatticeNode& corner, int side, const SquareCorners& corners);
  std::array<SquareCorners, 4> quarters(const LatticeNode& corner, int side, const SquareCorners& corners);
  std::array<SquareCorners, 4> quarters_within_pixel(const LatticeNode& corner, int side,
                                                     const SquareCorners& corners);
  bool is_refined(const LatticeNode& corner, int side) const;
  int finest_side(const LatticeNode& pixel) const;
  float4 mean_of_refined(const LatticeNode& corner, int side, const SquareCorners& corners);

  // What a surface is taken to show at the corners of a square.
  struct SurfaceColors {
    std::uint32_t surface = 0;
    std::array<float4, 4> corners;
    std::array<TextureFactor, 4> textures;  // where these colours come from, if the surface has one
  };
  // A square with samples at its corners only.
  struct Square {
    LatticeNode corner;
    int side;
    const SquareCorners& corners;
  };
  // Calls visit(x, y) for the pixels of a square that are painted.
  template <class Visit>
  void for_each_pixel(const Square& square, const Visit& visit) const {
    const int x = square.corner.x / kPixelSide, y = square.corner.y / kPixelSide;
    const int size = square.side / kPixelSide;
    for (int v = std::max(y, part_.y0); v < std::min(y + size, part_.y1); ++v)
      for (int u = std::max(x, part_.x0); u < std::min(x + size, part_.x1); ++u) visit(u, v);
  }
  void fill_textured(const Square& square);
  SurfaceColors colors_at(const Square& square, std::uint32_t surface);
  const SurfaceColors& colors_of(std::uint32_t surface, const LatticeNode& at, const Square& square);
  void find_colors(const LatticeNode& at, const Square& square, SurfaceColors& colors);
  std::array<TextureFactor, 4> textures_at(const Square& square, std::uint32_t surface);
  float4 shown_in_pixel(const SurfaceColors& colors, const std::array<float, 4>& weights, int x, int y,
                        std::uint32_t primitive) const;
  float4 color_within(const SurfaceColors& colors, const std::array<float, 4>& weights,
                      const TextureFactor& texture) const;
  float4 mixed_mean(const LatticeNode& corner, const Square& square);
  static constexpr std::size_t kMostInPixel = VisibilityBuffer::kMostInPixel;
  // The primitives seen in a pixel, by their tile's own numbers, and the share of each.
  struct NumbersInPixel {
    std::array<std::uint16_t, kMostInPixel> numbers;
    std::array<float, kMostInPixel> shares;
    std::size_t count = 0;
  };
  // The surfaces seen in a pixel, and the share of each.
  struct SeenInPixel {
    std::array<std::uint32_t, kMostInPixel> surfaces, primitives;
    std::array<float, kMostInPixel> shares;
    std::size_t count = 0;
  };
  SeenInPixel seen_in(const LatticeNode& corner) const;
  template <int kDensity>
  static void count_points(const std::uint16_t* first, NumbersInPixel& found);

  float4 mean_of_mixed(const LatticeNode& pixel, const SquareCorners& corners);
  void gather(const LatticeNode& corner, int side, const SquareCorners& corners);
  void paint_mixed(const LatticeNode& corner, int side, const SquareCorners& corners);
  bool is_uniform(const LatticeNode& corner, int pixels) const;
  Color& pixel(int x, int y) {
    const PixelRect& bounds = pixels_->bounds;
    return pixels_
        ->colors[static_cast<std::size_t>(y - bounds.y0) * static_cast<std::size_t>(bounds.width()) +
                 static_cast<std::size_t>(x - bounds.x0)];
  }

  const LatticeStore& store_;
  NodePredictor& predictor_;
  VisibilityBuffer& visibility_;
  const SurfaceSamples& surfaces_;
  LocalErrors& errors_;
  const SurfaceShare& share_;
  SurfaceTextures& textures_;
  bool sees_ = false;                     // whether the visibility is known
  std::array<SurfaceColors, 16> colors_;  // of the surfaces met in a square
  std::size_t known_colors_ = 0;
  struct SurfaceSum {
    std::uint32_t surface = 0;
    float4 sum{};
    float weight = 0;
  };
  std::array<SurfaceSum, 32> sums_;  // of what the samples in a pixel show
  std::size_t summed_ = 0;
  PixelRect part_;
  PixelBlock* pixels_ = nullptr;
  int finest_side_ = 1;  // of the pixel that is painted
};

}  // namespace pprt
