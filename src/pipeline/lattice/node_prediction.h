// What a node is taken to show before it is sampled.
//
// The centre of a square is predicted from its corners, and from the middles of its sides that are sampled.
// That way what is thin is followed from one square to the next. The middle of a side is predicted from the
// side's ends. The centres of the squares on both sides count as well if one of them is sampled. Where these
// nodes lie on different primitives, the one nearest at the node's point is seen, as in
// docs/decisions/0017-edges.md.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "pipeline/core/display_values.h"
#include "pipeline/lattice/edge_share.h"
#include "pipeline/lattice/lattice_store.h"
#include "pipeline/lattice/local_errors.h"
#include "pipeline/silhouettes/projected_shape_cache.h"

namespace pprt {

// Least variance of colours at which edges are looked for.
inline constexpr float kLeastEdgeVariance = 3e-4F;

// Some nodes around a point, two to eight.
class Surroundings {
 public:
  Surroundings() = default;
  explicit Surroundings(const std::array<NodeValue, 4>& values) : count_(values.size()) {
    std::copy(values.begin(), values.end(), values_.begin());
  }

  void add(const NodeValue& value) { values_[count_++] = value; }

  // Adds the middle of a side of a square whose corners are values 0 to 3. The side's ends are a and b.
  void add_middle(const NodeValue& value, std::size_t a, std::size_t b) {
    const float4 all =
        (values_[0].channels() + values_[1].channels()) + (values_[2].channels() + values_[3].channels());
    off_center_ += (values_[a].channels() + values_[b].channels()) * 0.5F - all * 0.25F;
    add(value);
  }

  std::size_t count() const { return count_; }
  const NodeValue& operator[](std::size_t i) const { return values_[i]; }

  // Mean colour, exact at the centre of what changes evenly: a middle counts by how it differs from its ends.
  float4 mean() const;

  // Mean over the channels of the variance of the colours on the display scale.
  float variance() const;

  // The number of different primitives.
  int primitives() const;

  // Whether value i is the first on its primitive.
  bool is_first(std::size_t i) const;

  // Mean colour of the values on a primitive that one of them is on.
  float4 mean_on(std::uint32_t primitive) const;

 private:
  std::array<NodeValue, 8> values_;  // the first count_ of them
  std::size_t count_ = 0;
  float4 off_center_{};  // sum over the middles: what even change makes of the difference to the centre
};

struct Prediction {
  NodeValue value;
  bool shows_edge = false;
  float4 on_primitive{};  // where it does: the mean colour around of those on the primitive seen
};

// Reads a lattice. The references must outlive the object.
class NodePredictor {
 public:
  NodePredictor(LatticeStore& store, ProjectedShapeCache& shapes, LocalErrors& errors, const EdgeShare& share)
      : store_(store), shapes_(shapes), errors_(errors), share_(share) {}

  // Returns the nodes that predict a node of this level.
  Surroundings around(const LatticeNode& node, const LatticeLevel& level);

  // Predicts a node from them. `variance` and `primitives` are theirs.
  Prediction predict(const LatticeNode& node, const Surroundings& around, float variance, int primitives);
  NodeValue predict(const LatticeNode& node, const Surroundings& around) {
    return predict(node, around, around.variance(), around.primitives()).value;
  }

  // Returns a node's sample or, where there is none, its prediction.
  NodeValue value(const LatticeNode& node) {
    const bool is_corner = LatticeStore::is_corner(node);
    const NodeValue* known = is_corner ? store_.kept_at(node) : store_.sample_at(node);
    if (known != nullptr) return *known;
    return is_corner ? kept_prediction(node) : predicted(node);
  }

 private:
  NodeValue kept_prediction(const LatticeNode& corner);
  NodeValue predicted(const LatticeNode& node);
  bool knows_base(const LatticeNode& node) const;

  LatticeStore& store_;
  ProjectedShapeCache& shapes_;
  LocalErrors& errors_;
  const EdgeShare& share_;
};

inline float4 Surroundings::mean() const {
  float4 sum = -off_center_;
  for (std::size_t i = 0; i < count_; ++i) sum += values_[i].channels();
  return sum * (1.0F / static_cast<float>(count_));
}

inline float Surroundings::variance() const {
  float4 sum{}, squares{};
  for (std::size_t i = 0; i < count_; ++i) {
    const float4 shown = on_display(values_[i].channels());
    sum += shown, squares += shown * shown;
  }
  const float each = 1.0F / static_cast<float>(count_);
  const float4 mean = sum * each, variances = squares * each - mean * mean;
  const float variance = (variances[0] + variances[1] + variances[2]) * (1.0F / 3);
  return variance > 0 ? variance : 0;
}

inline float4 Surroundings::mean_on(std::uint32_t primitive) const {
  float4 sum{};
  float count = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if (values_[i].primitive() != primitive) continue;
    sum += values_[i].channels(), count += 1;
  }
  return sum * (1 / count);
}

inline bool Surroundings::is_first(std::size_t i) const {
  for (std::size_t k = 0; k < i; ++k)
    if (values_[k].primitive() == values_[i].primitive()) return false;
  return true;
}

inline int Surroundings::primitives() const {
  if (count_ == 0) return 0;
  if (is_on_one_primitive({values_.data(), count_})) return 1;
  int count = 0;
  for (std::size_t i = 0; i < count_; ++i) count += is_first(i) ? 1 : 0;
  return count;
}

}  // namespace pprt
