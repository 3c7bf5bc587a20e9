#include "pipeline/lattice/node_prediction.h"

#include "pipeline/core/display_values.h"
#include "pipeline/silhouettes/shape_nearness.h"

namespace pprt {
namespace {

float nearness_at(const ProjectedShapeCache& shapes, const ProjectedShapeCache::Shape& shape, double x,
                  double y) {
  const auto from_x = static_cast<float>(x - shape.origin.x), from_y = static_cast<float>(y - shape.origin.y);
  if (shape.kind == ImageShape::Kind::kQuadric) return nearness(shape.quadric, from_x, from_y);
  const auto left = static_cast<float>(x), top = static_cast<float>(y);
  float nearest = 0;
  shapes.for_each_facet(shape, {left, top, left, top}, [&](const ProjectedFacet& facet) {
    nearest = std::max(nearest, nearness(facet, from_x, from_y));
  });
  return nearest;
}

// The primitive that is nearest at a point, among those around; whether there is one that is known to be
// seen.
struct Seen {
  std::uint32_t primitive = 0;
  bool is_known = false;
};

Seen seen_at(const Vec2d& point, const Surroundings& around, ProjectedShapeCache& shapes) {
  Seen seen;
  float nearest = 0;
  bool sees_background = false;
  for (std::size_t i = 0; i < around.count(); ++i) {
    const std::uint32_t primitive = around[i].primitive();
    if (!around.is_first(i)) continue;
    if (primitive == 0) {
      sees_background = true;
      continue;
    }
    const ProjectedShapeCache::Shape& shape = shapes.shape(shapes.find(primitive, point));
    if (shape.kind == ImageShape::Kind::kUnknown) return {};
    const float n = nearness_at(shapes, shape, point.x, point.y);
    if (n > nearest) nearest = n, seen = {primitive, true};
  }
  if (!seen.is_known) seen.is_known = sees_background;
  return seen;
}

}  // namespace

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

Prediction NodePredictor::predict(const LatticeNode& node, const Surroundings& around, float variance,
                                  int primitives) {
  const float4 mean = around.mean();
  if (primitives == 1 || variance < kLeastEdgeVariance) return {NodeValue(mean, around[0].primitive())};
  const Seen seen = seen_at(point_of(node), around, shapes_);
  if (!seen.is_known) return {NodeValue(mean, around[0].primitive())};
  const float4 on_primitive = around.mean_on(seen.primitive);
  const float share = share_.of(primitives, errors_.near(node).level);
  return {NodeValue(mean + (on_primitive - mean) * share, seen.primitive), true, on_primitive};
}

NodeValue NodePredictor::kept_prediction(const LatticeNode& corner) {
  const NodeValue now = predicted(corner);
  store_.keep_prediction(corner, now);
  return now;
}

// Nothing predicts the corners of base squares: without a sample they are black.
NodeValue NodePredictor::predicted(const LatticeNode& node) {
  if (is_base(node)) return {};
  return predict(node, around(node, level_of(node)));
}

}  // namespace pprt
