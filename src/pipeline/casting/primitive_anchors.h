// Primitive anchors: one sample on each primitive that earlier frames have seen. The next frame sends a ray
// to each anchor whose primitive it has not seen yet. Refinement finds small primitives late, by chance or
// never; so they are found again for one ray (docs/decisions/0019-landmarks.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "base/camera.h"
#include "pipeline/core/region.h"
#include "pipeline/core/sample.h"

namespace pprt {

class PrimitiveAnchors {
 public:
  // For primitives numbered from 1 to `primitives`, as in RaySample. Samples on others have no anchor.
  explicit PrimitiveAnchors(std::uint32_t primitives) : slots_(primitives) {}

  // Takes over the samples of a finished frame. A primitive's anchor becomes the sample nearest to the mean
  // of all samples on it; samples whose colour depends on the eye do not count. Anchors are kept in the order
  // in which the frame found their primitives, for refinement finds large ones first. Those of primitives
  // that it has not seen come after them, for kLife frames.
  void note(std::span<const Sample> samples);

  // Moves each anchor with its primitive, and drops those that are no more; see Probe::carry.
  void carry(const std::function<Carried(RaySample&)>& carried);

  // Returns the anchors of primitives that none of the samples lies on, at the points of the region where the
  // camera would see them: the first `most` of them. A visibility ray must tell whether one is hidden.
  std::vector<Sample> unseen(std::span<const Sample> samples, const Camera& camera, const Region& region,
                             std::size_t most);

  // Removes all anchors; keeps the storage.
  void clear() { anchors_.clear(); }

 private:
  static constexpr int kLife = 4;  // frames without a sample on the primitive

  struct Anchor {
    Sample sample;
    int frames_unseen = 0;  // since the frame that it was taken from
    bool is_seen = false;   // a sample lies on its primitive; set by unseen()
    // Over all samples on the primitive in the frame that it was taken from.
    std::uint32_t samples = 0;
    Vec2d sum{0, 0};                                              // of image points
    double from_mean2 = std::numeric_limits<double>::infinity();  // of `sample`, square pixels
  };

  Anchor* find(std::vector<Anchor>& among, std::uint32_t primitive) const;
  void add(std::vector<Anchor>& to, const Anchor& anchor);

  std::vector<std::uint32_t> slots_;  // per primitive: index of its anchor, if it has one
  std::vector<Anchor> anchors_;
  std::vector<Anchor> next_;  // storage of note()
};

}  // namespace pprt
