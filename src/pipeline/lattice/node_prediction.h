// What a node is taken to show before it is sampled.
//
// The centre of a square is predicted from its corners, and from the middles of its sides that are sampled.
// The middle of a side is predicted from the side's ends. The centres of the squares on both sides count as
// well if one of them is sampled. Of these nodes those count that lie on the surface seen at the node. Where
// none does, the nearest sample on that surface counts (docs/decisions/0033-visibility.md).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "pipeline/core/display_values.h"
#include "pipeline/lattice/lattice_store.h"
#include "pipeline/lattice/local_errors.h"
#include "pipeline/lattice/surface_colors.h"
#include "pipeline/lattice/surface_lights.h"
#include "pipeline/lattice/surface_samples.h"
#include "pipeline/lattice/surface_share.h"
#include "pipeline/lattice/surface_textures.h"
#include "pipeline/silhouettes/sampled_silhouettes.h"
#include "pipeline/visibility/visibility_buffer.h"

namespace pprt {

// Sums of some colours: as they are, and on the display scale.
struct ColorSums {
  float count = 0;
  float4 all{}, shown{}, squares{};

  void add(const float4& channels) {
    const float4 on_scale = on_display(channels);
    count += 1, all += channels, shown += on_scale, squares += on_scale * on_scale;
  }
  float4 mean() const { return all * (1 / count); }

  // Mean over the channels of the variance of the colours on the display scale.
  float variance() const {
    const float each = 1 / count;
    const float4 mean = shown * each, variances = squares * each - mean * mean;
    return std::max((variances[0] + variances[1] + variances[2]) * (1.0F / 3), 0.0F);
  }
};

// Least variance of colours on the display scale at which edges show.
inline constexpr float kLeastEdgeVariance = 3e-4F;

// Some nodes around a point, at most eight, and what they have in common.
class Surroundings {
 public:
  Surroundings() = default;

  // The corners of a square.
  explicit Surroundings(const Square& square) {
    const std::array<LatticeNode, 4> nodes = nodes_of(square.corner, square.side);
    for (std::size_t i = 0; i < nodes.size(); ++i) add(square.corners[i], nodes[i]);
  }

  void add(const NodeValue& value, const LatticeNode& node) {
    nodes_[count_] = node;
    values_[count_++] = value;
    differ_ |= value.surface() ^ values_[0].surface();
    sums_.add(value.channels());
  }

  // Adds the middle of a side of a square whose corners are values 0 to 3. The side's ends are a and b.
  void add_middle(const NodeValue& value, const LatticeNode& node, std::size_t a, std::size_t b) {
    const float4 all =
        (values_[0].channels() + values_[1].channels()) + (values_[2].channels() + values_[3].channels());
    sums_.all += all * 0.25F - (values_[a].channels() + values_[b].channels()) * 0.5F;
    add(value, node);
  }

  // Returns the same with other colours: color_of(i) of number i.
  template <class ColorOf>
  Surroundings with_colors(const ColorOf& color_of) const {
    Surroundings changed;
    for (std::size_t i = 0; i < count_; ++i) {
      const NodeValue value(color_of(i), values_[i].surface(), values_[i].lights());
      if (i < 4) {
        changed.add(value, nodes_[i]);
        continue;
      }
      // After four corners come middles: left, right, above or below.
      const bool is_upright = nodes_[i].x == nodes_[0].x || nodes_[i].x == nodes_[3].x;
      const std::size_t a =
          is_upright ? (nodes_[i].x == nodes_[0].x ? 0 : 1) : (nodes_[i].y == nodes_[0].y ? 0 : 2);
      changed.add_middle(value, nodes_[i], a, is_upright ? a + 2 : a + 1);
    }
    return changed;
  }

  std::size_t count() const { return count_; }
  const NodeValue& operator[](std::size_t i) const { return values_[i]; }
  const LatticeNode& node(std::size_t i) const { return nodes_[i]; }

  // Whether edges may lie between the nodes, and would be seen.
  bool show_edges() const { return differ_ != 0 && variance() >= kLeastEdgeVariance; }

  // Whether all nodes, one at least, lie on this surface.
  bool are_on(std::uint32_t surface) const { return differ_ == 0 && values_[0].surface() == surface; }

  // Mean colour, exact at the centre of what changes evenly: a middle counts by how it differs from its ends.
  float4 mean() const { return sums_.mean(); }
  float variance() const { return sums_.variance(); }

 private:
  std::array<NodeValue, 8> values_;   // the first count_ of them
  std::array<LatticeNode, 8> nodes_;  // the same
  std::size_t count_ = 0;
  std::uint32_t differ_ = 0;  // bits in which the surfaces do
  ColorSums sums_;            // less what even change makes of the middles' distance from the centre
};

struct Prediction {
  NodeValue value;
  // Mean over the channels of that of the colours on the surface, on the display scale. At a silhouette: of
  // all around, for something else may lie between.
  float variance = 0;
  Basis basis = Basis::kNothing;
  bool is_all = false;            // the whole colour is known but for which lights are seen
  float4 around{}, on_surface{};  // the mean of all around, and the colour that those on the surface make
};

// Whether no other surface has a share in the colour.
inline bool is_of_surface_alone(const Prediction& predicted) {
  return predicted.is_all || predicted.basis == Basis::kAllAround;
}

// Whether the colour is made of others' by the SurfaceShare.
inline bool is_share_used(const Prediction& predicted) {
  return !is_of_surface_alone(predicted) && predicted.basis != Basis::kNothing;
}

// Returns the surface seen at a node. Only if the visibility is known.
inline std::uint32_t seen_at(VisibilityBuffer& visibility, const LatticeNode& node) {
  constexpr int kLog2Side = 4;
  static_assert(1 << kLog2Side == kPixelSide);
  const int shift = kLog2Side - visibility.log2_points_per_side();
  if (((node.x | node.y) & ((1 << shift) - 1)) != 0) return visibility.at(point_of(node));
  return visibility.at(node.x >> shift, node.y >> shift);
}

// Reads a lattice. The references must outlive the object.
class NodePredictor {
 public:
  NodePredictor(LatticeStore& store, VisibilityBuffer& visibility, const SurfaceSamples& surfaces,
                LocalErrors& errors, const SurfaceShare& share, SurfaceTextures& textures,
                SurfaceLights& lights, SampledSilhouettes& silhouettes)
      : store_(store),
        visibility_(visibility),
        silhouettes_(silhouettes),
        surfaces_(surfaces),
        errors_(errors),
        share_(share),
        textures_(textures),
        lights_(lights) {}

  // Returns the nodes that predict a node of this level.
  Surroundings around(const LatticeNode& node, const LatticeLevel& level);

  // Predicts a node from them.
  Prediction predict(const LatticeNode& node, const Surroundings& around);

  // Returns a node's sample or, where there is none, its prediction.
  NodeValue value(const LatticeNode& node) {
    const bool is_corner = LatticeStore::is_corner(node);
    const NodeValue* known = is_corner ? store_.kept_at(node) : store_.sample_at(node);
    if (known != nullptr) return *known;
    return is_corner ? kept_prediction(node) : predicted(node);
  }

 private:
  template <class ColorOfNear>
  Prediction predict_on(std::uint32_t seen, const LatticeNode& node, const Surroundings& around,
                        const ColorOfNear& color_of);
  float4 shaded(std::uint32_t surface, const LatticeNode& node, const Surroundings& around);
  Prediction predict_unseen(const LatticeNode& node, const Surroundings& around);
  Prediction predict_plain(std::uint32_t seen, const LatticeNode& node, const Surroundings& around);
  Prediction predict_on_texture(std::uint32_t seen, const LatticeNode& node, const Surroundings& around);
  Prediction predict_in_light(std::uint32_t seen, const LatticeNode& node, const Surroundings& around);
  NodeValue kept_prediction(const LatticeNode& corner);
  NodeValue predicted(const LatticeNode& node);
  bool knows_base(const LatticeNode& node) const;

  LatticeStore& store_;
  VisibilityBuffer& visibility_;
  SampledSilhouettes& silhouettes_;
  const SurfaceSamples& surfaces_;
  LocalErrors& errors_;
  const SurfaceShare& share_;
  SurfaceTextures& textures_;
  SurfaceLights& lights_;
};

}  // namespace pprt
