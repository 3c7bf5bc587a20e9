// The lattice: image points at which the lattice sampler may take samples (docs/decisions/0021-lattice.md).
//
// Coordinates count sixteenths of a pixel from the image's upper left corner. The coarsest nodes lie
// kBaseSide apart. Every level halves the area of a node: first the centres of the squares between the nodes,
// then the middles of the squares' sides. The nodes so far then form squares of half the side.
//
//   o . o      o     o corners     side 4:   its centre    then the middles    then side 2
//   . . .         +                          of its sides
//   o . o      o     o             o     o   o     o   o + o   o + o
//                                     +         +      + + +   + x +  ...
//                                  o     o   o     o   o + o   o + o
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/simd.h"
#include "base/vector.h"

namespace pprt {

inline constexpr int kPixelSide = 16;             // sixteenths of a pixel, as all sides
inline constexpr int kBaseSide = 8 * kPixelSide;  // of the coarsest squares

struct LatticeNode {
  int x = 0, y = 0;  // sixteenths of a pixel

  friend bool operator==(const LatticeNode&, const LatticeNode&) = default;
};

// Whether the node is a corner of base squares: these belong to no level.
constexpr bool is_base(const LatticeNode& node) {
  return (node.x | node.y) % kBaseSide == 0;
}

// The image point of a node, pixels, and the node at or before a point.
inline Vec2d point_of(const LatticeNode& node) {
  return {static_cast<double>(node.x) / kPixelSide, static_cast<double>(node.y) / kPixelSide};
}
inline LatticeNode node_at(const Vec2d& point) {
  return {static_cast<int>(kPixelSide * point.x), static_cast<int>(kPixelSide * point.y)};
}

// Whether the node lies between the four corners of a square of this side, or between two of them. A square's
// side is even.
enum class LatticeKind : std::uint8_t { kCenter, kMiddle };
struct LatticeLevel {
  int side = kBaseSide;
  LatticeKind kind = LatticeKind::kCenter;

  // The image area that a node of the level stands for once all nodes of the level are known, square pixels.
  float area() const {
    const float pixels = static_cast<float>(side) / kPixelSide;
    return pixels * pixels * (kind == LatticeKind::kCenter ? 0.5F : 0.25F);
  }

  friend bool operator==(const LatticeLevel&, const LatticeLevel&) = default;
};

// From coarse to fine.
inline constexpr std::array<LatticeLevel, 14> kLatticeLevels = [] {
  std::array<LatticeLevel, 14> levels;
  for (std::size_t i = 0; i < levels.size(); ++i)
    levels[i] = {kBaseSide >> (i / 2), i % 2 == 0 ? LatticeKind::kCenter : LatticeKind::kMiddle};
  return levels;
}();

// Returns the place of a level among kLatticeLevels.
inline std::size_t index_of(const LatticeLevel& level) {
  const auto halvings = static_cast<std::size_t>(std::bit_width(unsigned{kBaseSide}) -
                                                 std::bit_width(static_cast<unsigned>(level.side)));
  return 2 * halvings + (level.kind == LatticeKind::kMiddle ? 1 : 0);
}

// Returns the level of a node that is no corner of a base square.
constexpr LatticeLevel level_of(const LatticeNode& node) {
  const int half = 1 << std::countr_zero(static_cast<unsigned>(node.x | node.y));
  const bool is_center = (node.x & half) != 0 && (node.y & half) != 0;
  return {2 * half, is_center ? LatticeKind::kCenter : LatticeKind::kMiddle};
}

// Returns the side of the square of the image that a sample at a node stands for, pixels.
inline double footprint_of(const LatticeNode& node) {
  return is_base(node) ? double{kBaseSide} / kPixelSide : double{std::sqrt(level_of(node).area())};
}

// The number of no surface. There is no visibility with as many.
inline constexpr std::uint32_t kNoSurface = 0xFFFFFF;

// What is seen at a node: colour, linear, and the surface's number (Probe::surfaces).
class NodeValue {
 public:
  NodeValue() = default;
  // The last lane of `channels` does not count. `lights`: those seen, a bit each (seen_from()). Surfaces are
  // told apart by 24 bits: there is no visibility with more primitives.
  NodeValue(const float4& channels, std::uint32_t surface, std::uint8_t lights = 0xFF) {
    int4 bits = std::bit_cast<int4>(channels);
    bits[3] = std::bit_cast<std::int32_t>((surface & 0xFFFFFFU) | std::uint32_t{lights} << 24);
    lanes_ = std::bit_cast<float4>(bits);
  }

  // Red, green, blue and 0.
  float4 channels() const { return std::bit_cast<float4>(std::bit_cast<int4>(lanes_) & int4{-1, -1, -1, 0}); }
  std::uint32_t surface() const { return surface_and_lights() & 0xFFFFFFU; }
  std::uint32_t surface_and_lights() const {
    return std::bit_cast<std::uint32_t>(std::bit_cast<int4>(lanes_)[3]);
  }
  std::uint8_t lights() const { return static_cast<std::uint8_t>(surface_and_lights() >> 24); }

 private:
  float4 lanes_;
};

}  // namespace pprt
