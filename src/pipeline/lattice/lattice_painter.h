// From the lattice to pixels: each square of the lattice shows the mean over each pixel's area of what its
// corners make of it.
#pragma once

#include <array>

#include "pipeline/core/pixel_block.h"
#include "pipeline/lattice/node_prediction.h"

namespace pprt {

// The values at a square's corners: upper left, upper right, lower left, lower right.
using SquareCorners = std::array<NodeValue, 4>;

// Paints a lattice. The references must outlive the object.
class LatticePainter {
 public:
  LatticePainter(const LatticeStore& store, NodePredictor& predictor, ProjectedShapeCache& shapes,
                 LocalErrors& errors, const EdgeShare& share)
      : store_(store), predictor_(predictor), shapes_(shapes), errors_(errors), share_(share) {}

  // Replaces the pixels of a part of `pixels`, a rectangle of the image within their bounds.
  void paint(const PixelRect& part, PixelBlock& pixels);

 private:
  void paint_square(const LatticeNode& corner, int side, const SquareCorners& corners);
  void fill(const LatticeNode& corner, int side, const SquareCorners& corners);
  std::array<SquareCorners, 4> quarters(const LatticeNode& corner, int side, const SquareCorners& corners);
  std::array<SquareCorners, 4> quarters_within_pixel(const LatticeNode& corner, int side,
                                                     const SquareCorners& corners);
  bool is_refined(const LatticeNode& corner, int side) const;
  int finest_side(const LatticeNode& pixel) const;
  float4 mean_of_refined(const LatticeNode& corner, int side, const SquareCorners& corners);
  float4 mean_of(const LatticeNode& corner, int side, const SquareCorners& corners);
  float4 mean_of_edge(const LatticeNode& corner, int side, const SquareCorners& corners);

  // The shapes of the corners' primitives; null for repeated ones and the background.
  struct EdgeShapes {
    std::array<const ProjectedShapeCache::Shape*, 4> shapes{};
    bool are_known = false;
  };
  EdgeShapes shapes_of(const LatticeNode& corner, const SquareCorners& corners);
  void paint_edge(const LatticeNode& corner, const SquareCorners& corners);
  float4 mean_by_shapes(const Vec2d& at, float size, const SquareCorners& corners, const EdgeShapes& shapes,
                        const std::array<float, 4>& weights, float share);
  Color& pixel(int x, int y) {
    const PixelRect& bounds = pixels_->bounds;
    return pixels_
        ->colors[static_cast<std::size_t>(y - bounds.y0) * static_cast<std::size_t>(bounds.width()) +
                 static_cast<std::size_t>(x - bounds.x0)];
  }

  const LatticeStore& store_;
  NodePredictor& predictor_;
  ProjectedShapeCache& shapes_;
  LocalErrors& errors_;
  const EdgeShare& share_;
  PixelRect part_;
  PixelBlock* pixels_ = nullptr;
  int finest_side_ = 1;  // of the pixel that is painted
};

}  // namespace pprt
