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
  const auto add = [&](const LatticeNode& other) { around.add(value(other), other); };
  if (level.kind == LatticeKind::kCenter) {
    add({x - half, y - half});
    add({x + half, y - half});
    add({x - half, y + half});
    add({x + half, y + half});
    const auto add_middle = [&](const LatticeNode& middle, std::size_t a, std::size_t b) {
      if (const NodeValue* sample = store_.sample_at(middle)) around.add_middle(*sample, middle, a, b);
    };
    add_middle({x - half, y}, 0, 2);
    add_middle({x + half, y}, 1, 3);
    add_middle({x, y - half}, 0, 1);
    add_middle({x, y + half}, 2, 3);
    return around;
  }
  const int dx = (x & half) != 0 ? half : 0, dy = half - dx;  // along the side
  add({x - dx, y - dy});
  add({x + dx, y + dy});
  const LatticeNode before{x - dy, y - dx}, after{x + dy, y + dx};  // the centres
  const bool is_on_border =
      before.x < 0 || before.y < 0 || after.x > store_.right() || after.y > store_.bottom();
  if (is_on_border) return around;
  const bool has_before = store_.is_sampled(before), has_after = store_.is_sampled(after);
  if (!has_before && !has_after) return around;
  // Beyond a base line may lie squares of another rank.
  const bool is_on_base_line = (dx != 0 ? y : x) % kBaseSide == 0;
  if (!is_on_base_line || ((has_before || knows_base(before)) && (has_after || knows_base(after)))) {
    add(before);
    add(after);
  }
  return around;
}

// `color_of`: what a sample on the surface elsewhere shows of it here.
template <class ColorOfNear>
Prediction NodePredictor::predict_on(std::uint32_t seen, const LatticeNode& node, const Surroundings& around,
                                     const ColorOfNear& color_of) {
  Prediction found;
  found.around = found.on_surface = around.mean();
  if (!visibility_.is_known() || around.are_on(seen)) {
    found.value = NodeValue(found.around, seen, around[0].lights());
    found.variance = around.variance();
    found.basis = Basis::kAllAround;
    return found;
  }
  found.is_all = lights_.of(seen).is_all;
  std::uint8_t lights = around[0].lights();
  ColorSums same;
  std::size_t count = 0;
  for (std::size_t i = 0; i < around.count(); ++i) {
    if (around[i].surface() != seen) continue;
    if (count++ == 0) lights = around[i].lights();
    same.add(around[i].channels());
  }
  if (count > 0) {
    found.variance = same.variance();
    found.basis = basis_of(count, around.count());
    found.on_surface = same.mean();
  } else if (const SurfaceSamples::Known* near = surfaces_.nearest(node, seen)) {
    found.basis = Basis::kNearSample;
    found.on_surface = color_of(*near);
    lights = near->value.lights();
  } else if (found.is_all) {
    found.basis = Basis::kShading;
    found.on_surface = shaded(seen, node, around);
  }
  const float share = found.is_all ? 1 : share_.of(found.basis, errors_.near(node).level);
  found.value = NodeValue(found.around + (found.on_surface - found.around) * share, seen, lights);
  return found;
}

// Returns the colour of a surface of which all is known but the lights seen: in the mean they are those of
// the nodes around.
float4 NodePredictor::shaded(std::uint32_t surface, const LatticeNode& node, const Surroundings& around) {
  const UnshadowedLight& light = lights_.at(node, surface);
  if (!light.is_known) return around.mean();
  float4 sum{};
  for (std::size_t i = 0; i < around.count(); ++i) sum += light.of(around[i].lights());
  return light.unlit + sum * (1.0F / static_cast<float>(around.count()));
}

Prediction NodePredictor::predict_plain(std::uint32_t seen, const LatticeNode& node,
                                        const Surroundings& around) {
  return predict_on(seen, node, around,
                    [](const SurfaceSamples::Known& near) { return near.value.channels(); });
}

// Without visibility all around are taken for one surface, unless their silhouettes tell which is nearest.
Prediction NodePredictor::predict_unseen(const LatticeNode& node, const Surroundings& around) {
  if (!silhouettes_.are_shown() || !around.show_edges())
    return predict_plain(around[0].surface(), node, around);
  std::array<std::uint32_t, 8> surfaces{};
  for (std::size_t i = 0; i < around.count(); ++i) surfaces[i] = around[i].surface();
  const std::optional<std::uint32_t> nearest =
      silhouettes_.nearest(point_of(node), {surfaces.data(), around.count()});
  if (!nearest) return predict_plain(around[0].surface(), node, around);
  ColorSums same;
  std::uint8_t lights = 0;
  for (std::size_t i = 0; i < around.count(); ++i) {
    if (surfaces[i] != *nearest) continue;
    same.add(around[i].channels());
    lights = around[i].lights();
  }
  Prediction found;
  found.around = around.mean(), found.on_surface = same.mean();
  found.variance = around.variance();
  found.basis = basis_of(static_cast<std::size_t>(same.count), around.count());
  const float share = share_.of(found.basis, errors_.near(node).level);
  found.value = NodeValue(found.around + (found.on_surface - found.around) * share, *nearest, lights);
  return found;
}

// Where more is seen of a surface than lights bring, as in mirrors, to know that part is not worth its time
// here.
Prediction NodePredictor::predict(const LatticeNode& node, const Surroundings& around) {
  if (!visibility_.is_known()) return predict_unseen(node, around);
  const std::uint32_t seen = seen_at(visibility_, node);
  if (textures_.has(seen)) return predict_on_texture(seen, node, around);
  if (lights_.is_curved(seen) && lights_.of(seen).is_all) return predict_in_light(seen, node, around);
  return predict_plain(seen, node, around);
}

// What lies around on the texture is taken to where it is wanted: only the light on it is interpolated.
Prediction NodePredictor::predict_on_texture(std::uint32_t seen, const LatticeNode& node,
                                             const Surroundings& around) {
  const TextureFactor here = textures_.at(node, seen);
  if (!is_known(here)) return predict_plain(seen, node, around);
  std::array<TextureFactor, 8> there;
  TextureLight light;
  for (std::size_t i = 0; i < around.count(); ++i) {
    there[i] = around[i].surface() == seen ? textures_.at(around.node(i), seen) : TextureFactor{};
    if (is_known(there[i])) light.add(around[i].channels(), there[i], 1);
  }
  const float4 of_all = light.with(textures_.usual());
  const Surroundings moved = around.with_colors([&](std::size_t i) {
    return is_known(there[i]) ? retextured(around[i].channels(), of_all, there[i], here)
                              : around[i].channels();
  });
  return predict_on(seen, node, moved, [&](const SurfaceSamples::Known& near) {
    return textures_.moved(near.value, near.node, here);
  });
}

// What lies around on the surface is taken to where it is wanted, with the lights that it sees.
Prediction NodePredictor::predict_in_light(std::uint32_t seen, const LatticeNode& node,
                                           const Surroundings& around) {
  const UnshadowedLight& here = lights_.at(node, seen);
  if (!here.is_known) return predict_plain(seen, node, around);
  const Surroundings moved = around.with_colors([&](std::size_t i) {
    return around[i].surface() == seen ? lights_.moved(around[i], around.node(i), here)
                                       : around[i].channels();
  });
  return predict_on(seen, node, moved, [&](const SurfaceSamples::Known& near) {
    return lights_.moved(near.value, near.node, here);
  });
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
