// From the lattice to pixels: each square of the lattice shows the mean over each pixel's area of what its
// corners make of it.
#pragma once

#include <algorithm>
#include <array>

#include "pipeline/core/pixel_block.h"
#include "pipeline/lattice/node_prediction.h"
#include "pipeline/lattice/surface_colors.h"

namespace pprt {

// Paints a lattice. The references must outlive the object.
class LatticePainter {
 public:
  LatticePainter(const LatticeStore& store, NodePredictor& predictor, VisibilityBuffer& visibility,
                 const SurfaceColors& surfaces, SampledSilhouettes& silhouettes, LocalErrors& errors,
                 const SurfaceShare& share)
      : store_(store),
        predictor_(predictor),
        visibility_(visibility),
        surfaces_(surfaces),
        silhouettes_(silhouettes),
        errors_(errors),
        share_(share) {}

  // Replaces the pixels of a part of `pixels`, a rectangle of the image within their bounds.
  void paint(const PixelRect& part, PixelBlock& pixels);

 private:
  void paint_square(const LatticeNode& corner, int side, const SquareCorners& corners);
  void fill(const LatticeNode& corner, int side, const SquareCorners& corners);
  std::array<SquareCorners, 4> quarters(const LatticeNode& corner, int side, const SquareCorners& corners);
  template <class ShownBy>
  std::array<SquareCorners, 4> quarters_within_pixel(const LatticeNode& corner, int side,
                                                     const SquareCorners& corners, const ShownBy& shown_by);
  bool is_refined(const LatticeNode& corner, int side) const;
  int finest_side(const LatticeNode& pixel) const;
  bool shows_silhouettes(const Square& square) const;
  void paint_silhouettes(const Square& square);
  float4 mean_by_silhouettes(const Vec2d& corner, float side, const Square& square,
                             const std::array<float, 4>& weights);
  float4 mean_of_refined(const LatticeNode& corner, int side, const SquareCorners& corners);

  // Calls visit(x, y) for the pixels of a square that are painted.
  template <class Visit>
  void for_each_pixel(const Square& square, const Visit& visit) const {
    const int x = square.corner.x / kPixelSide, y = square.corner.y / kPixelSide;
    const int size = square.side / kPixelSide;
    for (int v = std::max(y, part_.y0); v < std::min(y + size, part_.y1); ++v)
      for (int u = std::max(x, part_.x0); u < std::min(x + size, part_.x1); ++u) visit(u, v);
  }
  void paint_uniform(const Square& square);
  float4 mixed_mean(const LatticeNode& corner, const Square& square);

  // Calls visit(SeenPrimitive) for what is seen in a pixel.
  template <class Visit>
  void for_each_seen(const LatticeNode& corner, const Visit& visit) const {
    const int x = corner.x / kPixelSide, y = corner.y / kPixelSide;
    const SeenInPixel& seen = visibility_.seen_in(x, y);
    const VisibleTile& tile = visibility_.tile(x, y);
    for (std::size_t i = 0; i < seen.count; ++i) {
      if (seen.shares[i] <= 0) continue;
      const std::uint16_t number = seen.numbers[i];
      visit(SeenPrimitive{tile.surfaces()[number], tile.primitive(number),
                          Vec2d(x, y) + Vec2d(seen.places[i]), seen.shares[i]});
    }
  }
  float4 mean_of_mixed(const LatticeNode& pixel, const SquareCorners& corners);
  void gather(const LatticeNode& corner, int side, const SquareCorners& corners);
  void paint_mixed(const Square& square);
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
  SurfaceColors surfaces_;
  SampledSilhouettes& silhouettes_;
  LocalErrors& errors_;
  const SurfaceShare& share_;
  bool sees_ = false;  // whether the visibility is known
  struct SurfaceSum {
    std::uint32_t surface = 0;
    float4 sum{};
    float weight = 0;
  };
  std::array<SurfaceSum, SeenInPixel::kMost> sums_;  // of what the samples in a pixel show
  std::size_t summed_ = 0;
  PixelRect part_;
  PixelBlock* pixels_ = nullptr;
  int finest_side_ = 1;  // of the pixel that is painted
};

}  // namespace pprt
