// Where each surface that is seen near a base square has been sampled: a few samples for each surface,
// found by it. What is too thin for the corners of a square takes its colour from here.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/lattice/lattice_node.h"

namespace pprt {

class SurfaceSamples {
 public:
  struct Known {
    LatticeNode node;
    std::uint32_t next;  // of its square
    NodeValue value;
  };

  // For the nodes of a lattice up to (right, bottom), sixteenths of a pixel.
  SurfaceSamples(int right, int bottom)
      : columns_(right / kBaseSide + 1),
        rows_(bottom / kBaseSide + 1),
        first_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), kNone) {}

  void clear() {
    std::fill(first_.begin(), first_.end(), kNone);
    samples_.clear();
  }

  // Notes a sample, unless its square has kMost of its surface.
  void add(const LatticeNode& node, const NodeValue& value) {
    std::uint32_t& first = first_[square_of(node)];
    int same = 0;
    for (std::uint32_t i = first; i != kNone; i = samples_[i].next)
      same += samples_[i].value.surface() == value.surface() ? 1 : 0;
    if (same >= kMost) return;
    samples_.push_back({node, first, value});
    first = static_cast<std::uint32_t>(samples_.size() - 1);
  }

  // Returns the nearest sample on a surface in the node's square or one beside it; null: there is none.
  const Known* nearest(const LatticeNode& node, std::uint32_t surface) const {
    const int column = node.x / kBaseSide, row = node.y / kBaseSide;
    const Known* found = nullptr;
    int least = 1 << 30;
    const auto look_in = [&](int x, int y) {
      if (x < 0 || y < 0 || x >= columns_ || y >= rows_) return;
      for (std::uint32_t i = first_[static_cast<std::size_t>(y * columns_ + x)]; i != kNone;
           i = samples_[i].next) {
        const Known& known = samples_[i];
        if (known.value.surface() != surface) continue;
        const int dx = known.node.x - node.x, dy = known.node.y - node.y, distance = dx * dx + dy * dy;
        if (distance < least) least = distance, found = &known;
      }
    };
    look_in(column, row);
    if (found != nullptr) return found;
    for (int y = row - 1; y <= row + 1; ++y)
      for (int x = column - 1; x <= column + 1; ++x)
        if (x != column || y != row) look_in(x, y);
    return found;
  }

  // Whether the square of a node holds a sample on a surface.
  bool has(const LatticeNode& corner, std::uint32_t surface) const {
    for (std::uint32_t i = first_[square_of(corner)]; i != kNone; i = samples_[i].next)
      if (samples_[i].value.surface() == surface) return true;
    return false;
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  static constexpr int kMost = 2;

  std::size_t square_of(const LatticeNode& node) const {
    return static_cast<std::size_t>(node.y / kBaseSide * columns_ + node.x / kBaseSide);
  }

  int columns_, rows_;
  std::vector<std::uint32_t> first_;  // per base square
  std::vector<Known> samples_;
};

}  // namespace pprt
