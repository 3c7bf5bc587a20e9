#include "scene/polygons/ear_ranking.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace pprt {

EarRanking::EarRanking(std::size_t vertices, double quality)
    : leaves_(std::bit_ceil(vertices)), tree_(2 * leaves_, -std::numeric_limits<double>::infinity()) {
  std::fill_n(tree_.begin() + static_cast<std::ptrdiff_t>(leaves_), vertices, quality);
  for (std::size_t k = leaves_ - 1; k > 0; --k) tree_[k] = std::max(tree_[2 * k], tree_[2 * k + 1]);
}

void EarRanking::set(std::uint32_t vertex, double quality) {
  std::size_t k = leaves_ + vertex;
  tree_[k] = quality;
  for (k /= 2; k > 0; k /= 2) {
    const double larger = std::max(tree_[2 * k], tree_[2 * k + 1]);
    if (tree_[k] == larger) return;
    tree_[k] = larger;
  }
}

std::uint32_t EarRanking::best(std::uint32_t start) const {
  const double largest = tree_[1];
  // Climbs from `start` to the first subtree at or after it that holds the largest quality.
  std::size_t k = leaves_ + start;
  while (tree_[k] != largest) {
    while (k % 2 == 1 && k > 1) k /= 2;  // the last of its parent: nothing of the parent is left
    if (k <= 1) break;
    ++k;
  }
  if (k <= 1) k = 1;  // none after `start`: the first of all
  while (k < leaves_) k = tree_[2 * k] == largest ? 2 * k : 2 * k + 1;
  return static_cast<std::uint32_t>(k - leaves_);
}

}  // namespace pprt
