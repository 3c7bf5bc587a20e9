// A sample on each primitive that the frames before have seen, where the next one looks for it. What
// refinement comes upon by chance, small things late or never, is so found again for the price of a ray.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/camera.h"
#include "pipeline/region.h"
#include "pipeline/sample.h"

namespace pprt {

class PrimitiveAnchors {
 public:
  // Of primitives numbered from 1 to `primitives`, as in RaySample; others have none.
  explicit PrimitiveAnchors(std::uint32_t primitives) : slots_(primitives) {}

  // A frame is over. Of its samples on a primitive, those whose colour does not depend on the eye, that in
  // their middle marks it. PrimitiveAnchors are kept in the order in which the frame has found their
  // primitives, as refinement finds large things first; those of primitives that it has not seen come after,
  // for kLife frames.
  void note(std::span<const Sample> samples);

  // The anchors of primitives that none of the samples lies on, at the image points where the camera would
  // see them, which lie in the region; at most so many, the first ones. Whether something hides them a ray
  // must tell.
  std::vector<Sample> unseen(std::span<const Sample> samples, const Camera& camera, const Region& region,
                             std::size_t most);

  // Nothing has been seen. Keeps the storage.
  void clear() { anchors_.clear(); }

 private:
  static constexpr int kLife = 4;

  struct PrimitiveAnchor {
    Sample sample;
    int frames_unseen = 0;  // since the one that noted it
    bool is_met = false;    // by a sample, when it was last asked
    // Of all samples on the primitive: how many, the sum of their image points, and how far from their middle
    // this one is, square pixels.
    std::uint32_t samples = 0;
    Vec2d sum{0, 0};
    double from_middle2 = std::numeric_limits<double>::infinity();
  };

  PrimitiveAnchor* find(std::vector<PrimitiveAnchor>& among, std::uint32_t primitive) const;
  void add(std::vector<PrimitiveAnchor>& to, const PrimitiveAnchor& anchor);

  // By primitive: where its anchor is, if it is there.
  std::vector<std::uint32_t> slots_;
  std::vector<PrimitiveAnchor> anchors_, noted_;
};

}  // namespace pprt
