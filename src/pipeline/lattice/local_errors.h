// How wrong predictions proved to be near each image point, and how many rays samples took there. Errors come
// in clusters: one that is found says more of its neighbourhood than all colours around it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/core/octaves.h"
#include "pipeline/lattice/lattice_node.h"

namespace pprt {

// Sums in cells of 4x4 pixels. What is asked of a cell is the mean over it and its eight neighbours, kept
// until start_round() or until a larger error is found there.
class LocalErrors {
 public:
  // For the nodes of a lattice up to (right, bottom), sixteenths of a pixel.
  LocalErrors(int right, int bottom);

  void clear();

  // Means are computed anew when they are asked for next.
  void start_round();

  struct Mean {
    float rays = 0;          // a sample
    std::uint8_t level = 0;  // of the squared errors: error_level() of their mean
    std::uint8_t round = 0;  // in which it was computed; 0: none
  };
  const Mean& near(const LatticeNode& node) {
    Mean& mean = means_[cell_of(node)];
    if (mean.round != round_) compute(cell_of(node), mean);
    return mean;
  }

  // Notes a sample. `weight`: 1, or less for one that was not predicted.
  void note(const LatticeNode& node, float squared_error, float rays, float weight = 1);

 private:
  struct alignas(16) Sums {
    float error = 0, rays = 0, samples = 0, unused = 0;
  };

  // Cells have a border of empty ones.
  std::size_t cell_of(const LatticeNode& node) const {
    constexpr int kCell = 4 * kPixelSide;
    const int cell = (node.y / kCell + 1) * columns_ + node.x / kCell + 1;
    return static_cast<std::size_t>(cell);
  }
  void compute(std::size_t cell, Mean& mean) const;

  int columns_;
  std::uint8_t round_ = 1;
  std::vector<Sums> sums_;
  std::vector<Mean> means_;
};

}  // namespace pprt
