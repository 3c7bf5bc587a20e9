#include "pipeline/lattice/node_prediction.h"

namespace pprt {

// Whether all corners of the base square around a node are known. Those of another rank's need not be.
bool NodePredictor::knows_base(const LatticeNode& node) const {
  const int x = node.x / kBaseSide * kBaseSide, y = node.y / kBaseSide * kBaseSide;
  return store_.is_sampled({x, y}) && store_.is_sampled({x + kBaseSide, y}) &&
         store_.is_sampled({x, y + kBaseSide}) && store_.is_sampled({x + kBaseSide, y + kBaseSide});
}

Surroundings NodePredictor::around(const LatticeNode& node, const LatticeLevel& level) {
  const int half = level.side / 2;
  const auto [x, y] = node;
  Surroundings around;
  if (level.kind == LatticeKind::kCenter) {
    around.add(value({x - half, y - half}));
    around.add(value({x + half, y - half}));
    around.add(value({x - half, y + half}));
    around.add(value({x + half, y + half}));
    if (const NodeValue* sample = store_.sample_at({x - half, y})) around.add_middle(*sample, 0, 2);
    if (const NodeValue* sample = store_.sample_at({x + half, y})) around.add_middle(*sample, 1, 3);
    if (const NodeValue* sample = store_.sample_at({x, y - half})) around.add_middle(*sample, 0, 1);
    if (const NodeValue* sample = store_.sample_at({x, y + half})) around.add_middle(*sample, 2, 3);
    return around;
  }
  const int dx = (x & half) != 0 ? half : 0, dy = half - dx;  // along the side
  around.add(value({x - dx, y - dy}));
  around.add(value({x + dx, y + dy}));
  const LatticeNode before{x - dy, y - dx}, after{x + dy, y + dx};  // the centres
  const bool is_on_border =
      before.x < 0 || before.y < 0 || after.x > store_.right() || after.y > store_.bottom();
  if (is_on_border) return around;
  const bool has_before = store_.is_sampled(before), has_after = store_.is_sampled(after);
  if (!has_before && !has_after) return around;
  // Beyond a base line may lie squares of another rank.
  const bool is_on_base_line = (dx != 0 ? y : x) % kBaseSide == 0;
  if (!is_on_base_line || ((has_before || knows_base(before)) && (has_after || knows_base(after)))) {
    around.add(value(before));
    around.add(value(after));
  }
  return around;
}

// Without visibility all around are taken for one surface.
Prediction NodePredictor::predict(const LatticeNode& node, const Surroundings& around) {
  const bool is_known = visibility_.is_known();
  const std::uint32_t seen = is_known ? seen_at(visibility_, node) : around[0].surface();
  Prediction found;
  found.around = found.on_surface = around.mean();
  if (!is_known || around.are_on(seen)) {
    found.value = NodeValue(found.around, seen);
    found.variance = around.variance();
    found.basis = Basis::kAllAround;
    return found;
  }
  Surroundings same;
  for (std::size_t i = 0; i < around.count(); ++i)
    if (around[i].surface() == seen) same.add(around[i]);
  if (same.count() > 0) {
    found.variance = same.variance();
    found.basis = basis_of(same.count(), around.count());
    found.on_surface = same.mean();
  } else if (const NodeValue* near = surfaces_.nearest(node, seen)) {
    found.basis = Basis::kNearSample;
    found.on_surface = near->channels();
  }
  const float share = share_.of(found.basis, errors_.near(node).level);
  found.value = NodeValue(found.around + (found.on_surface - found.around) * share, seen);
  return found;
}

NodeValue NodePredictor::kept_prediction(const LatticeNode& corner) {
  const NodeValue now = predicted(corner);
  store_.keep_prediction(corner, now);
  return now;
}

// Nothing predicts the corners of base squares: without a sample they are black.
NodeValue NodePredictor::predicted(const LatticeNode& node) {
  if (is_base(node)) return {};
  return predict(node, around(node, level_of(node))).value;
}

}  // namespace pprt
