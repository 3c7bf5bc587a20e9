// The vertices of a polygon ranked by their quality as ears.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pprt {

// A number for each vertex, and the vertex of the largest one in logarithmic time. A tournament: entry k > 0
// of the tree is the larger of entries 2k and 2k + 1, and the leaves are the vertices.
class EarRanking {
 public:
  // All vertices begin with `quality`.
  EarRanking(std::size_t vertices, double quality);

  double operator[](std::uint32_t vertex) const { return tree_[leaves_ + vertex]; }
  void set(std::uint32_t vertex, double quality);

  // Returns the vertex of the largest quality. If several have it, returns the first at or after `start`,
  // else the first of all.
  std::uint32_t best(std::uint32_t start) const;

 private:
  std::size_t leaves_;  // a power of two
  std::vector<double> tree_;
};

}  // namespace pprt
