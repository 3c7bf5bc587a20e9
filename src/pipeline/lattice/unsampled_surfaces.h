// Surfaces that are seen in a base square but that no sample there lies on: twigs between the nodes, corners
// of facets. Each is wanted as much as the area is large that one sample on it sets right.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/lattice/lattice_store.h"
#include "pipeline/lattice/surface_samples.h"
#include "pipeline/visibility/visibility_buffer.h"

namespace pprt {

// A surface of a base square on which there is no sample.
struct UnsampledSurface {
  LatticeNode node;
  std::uint32_t surface = 0;
  float area = 0;      // square pixels
  float variance = 0;  // of the colours around, on the display scale
  NodeState priority = kLeastCandidate;
};

// They are kept by tile of the store.
class UnsampledSurfaces {
 public:
  explicit UnsampledSurfaces(int tiles) : of_tile_(static_cast<std::size_t>(tiles)) {}

  void clear();

  // Returns those of the base square with this upper left corner, until the next call. Only if the visibility
  // is known.
  std::span<UnsampledSurface> find(VisibilityBuffer& visibility, const SurfaceSamples& samples,
                                   const LatticeNode& corner);

  // Moves those of a tile with at least this priority to `taken`.
  void take(int tile, NodeState least, std::vector<UnsampledSurface>& taken);

  void keep(int tile, const UnsampledSurface& surface);

  // Calls visit(surface) for all that are kept.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (const std::vector<UnsampledSurface>& all : of_tile_)
      for (const UnsampledSurface& surface : all) visit(surface);
  }

  // How many there are of each priority.
  const std::array<std::int64_t, 256>& counts() const { return counts_; }

 private:
  // The points of a square on one surface.
  struct Points {
    int count = 0, x = 0, y = 0;  // sums
    int unsampled = -1;           // its number in `found_`
    int least = 0;                // distance from the middle
  };

  std::vector<std::vector<UnsampledSurface>> of_tile_;
  std::array<std::int64_t, 256> counts_{};
  std::vector<Points> points_;          // by the tile's own numbers
  std::vector<std::uint16_t> numbers_;  // those of the square
  std::vector<UnsampledSurface> found_;
};

}  // namespace pprt
