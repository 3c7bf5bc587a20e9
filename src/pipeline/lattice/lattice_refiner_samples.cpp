// What a sample is worth, and what is learned from it.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "pipeline/core/display_values.h"
#include "pipeline/lattice/lattice_refiner.h"

namespace pprt {
namespace {

constexpr float kInsertion = 2;     // time of choosing and inserting a sample, in rays
constexpr float kSurprise = 1e-4F;  // squared error

// Calls visit(x, y) for the four corners of a square of nodes.
template <class Visit>
void for_each_corner(const LatticeNode& corner, int side, const Visit& visit) {
  visit(corner.x, corner.y), visit(corner.x + side, corner.y);
  visit(corner.x, corner.y + side), visit(corner.x + side, corner.y + side);
}

float sum_of_channels(const float4& v) {
  return v[0] + v[1] + v[2];
}

float squared_error(const float4& a, const float4& b) {
  const float4 difference = on_display(a) - on_display(b);
  return sum_of_channels(difference * difference) * (1.0F / 3);
}

// Below a pixel an error is a part of what the pixel shows.
float effect_of(const LatticeLevel& level) {
  const float area = level.area();
  return level.side <= kPixelSide ? 2 * area * area : area;
}

}  // namespace

// Whether a node is worth a sample in this pass. Keeps its priority otherwise.
bool LatticeRefiner::is_wanted(const LatticeNode& node, const LatticeLevel& level) {
  wanted_.node = node, wanted_.level = level, wanted_.is_base = false;
  wanted_.predicted = predictor_.predict(node, predictor_.around(node, level));
  if (pass_.takes_all) return true;
  const float worth = worth_of(node, level);
  if (worth >= pass_.threshold) return true;
  store_.set_state(node, priority_of(worth));
  return false;
}

// Returns the expected error at a node times its area, per time. Flat squares below a pixel come late, and
// only near errors: something thin may pass between their corners.
float LatticeRefiner::worth_of(const LatticeNode& node, const LatticeLevel& level) {
  constexpr float kFlat = 1e-5F, kShareOfFlat = 0.1F;
  constexpr int kLeastLevel = 5;  // mean squared errors of 2^-10
  const Wanted& at = wanted_;
  const LocalErrors::Mean& near = errors_.near(node);
  const bool is_flat =
      level.side <= kPixelSide && at.predicted.variance < kFlat && at.predicted.basis == Basis::kAllAround;
  if (is_flat && near.level < kLeastLevel) return 0;
  const Prediction& predicted = at.predicted;
  const float factor = estimates_.factor(class_of(predicted.basis, predicted.variance, near.level));
  const float worth = effect_of(level) * detail_of(predicted.variance) * factor / (kInsertion + near.rays);
  return is_flat ? kShareOfFlat * worth : worth;
}

// Takes in the sample of the wanted node.
void LatticeRefiner::insert_wanted(const Wanted& at, const RaySample& sample) {
  const float4 seen{sample.color.x, sample.color.y, sample.color.z, 0};
  const auto rays = static_cast<float>(sample.rays);
  ++samples_, rays_ += sample.rays;
  if (at.is_base) {
    constexpr float kWeight = 0.02F;  // nothing was predicted
    errors_.note(at.node, kUnpredicted, rays, kWeight);
    set_sample(at.node, NodeValue(seen, visibility_.surface_of(sample.primitive), seen_from(sample.lights)));
    make_candidates(at.node, {2 * kBaseSide, LatticeKind::kMiddle},
                    worth_around(at, kUnpredicted, 0, Basis::kAllAround));
    return;
  }
  const Prediction& predicted = at.predicted;
  const float error = squared_error(seen, predicted.value.channels());
  const LocalErrors::Mean near = errors_.near(at.node);
  const float effect = at.area > 0 ? at.area : effect_of(at.level);
  estimates_.learn(class_of(predicted.basis, predicted.variance, near.level),
                   effect * detail_of(predicted.variance), effect * std::sqrt(error));
  if (is_share_used(predicted)) learn_share(at, seen);
  if (at.area == 0)
    errors_.note(at.node, error, rays);  // others' are no worse for a surface that was not known
  set_sample(at.node, NodeValue(seen, visibility_.surface_of(sample.primitive), seen_from(sample.lights)));
  if (at.area > 0) return;
  const float worth = worth_around(at, error, predicted.variance, predicted.basis);
  make_candidates(at.node, at.level, worth);
  if (at.level.kind == LatticeKind::kMiddle && error > kSurprise) look_beyond(at.node, at.level.side, worth);
}

void LatticeRefiner::learn_share(const Wanted& at, const float4& seen) {
  const float4 mean = on_display(at.predicted.around);
  const float4 direction = on_display(at.predicted.on_surface) - mean;
  share_.learn(at.predicted.basis, errors_.near(at.node).level,
               sum_of_channels((on_display(seen) - mean) * direction),
               sum_of_channels(direction * direction));
}

// What seeing brings is known before anything is seen: the corners of base squares are compared with those
// beside them that lie on the same surface. Where a texture or all light is known, one sample tells all.
void LatticeRefiner::learn_from_base() {
  gain_.fade();
  mixed_.begin();
  for (const LatticeNode& node : own_.base_nodes()) {
    const NodeValue* seen = store_.sample_at(node);
    if (seen == nullptr) continue;
    const std::uint32_t surface = seen->surface();
    const bool is_known = lights_.of(surface).is_all || textures_.has(surface);
    std::array<float4, 4> same;
    std::size_t on_it = 0, count = 0;
    float4 sum{}, sum_on_it{};
    for (int side = 0; side < 4; ++side) {
      const int step = side % 2 == 0 ? kBaseSide : -kBaseSide;
      const LatticeNode beside{node.x + (side < 2 ? step : 0), node.y + (side < 2 ? 0 : step)};
      const NodeValue* other = store_.has(beside) ? store_.sample_at(beside) : nullptr;
      if (other == nullptr) continue;
      const float4 color = on_display(other->channels());
      sum += color, ++count;
      if (other->surface() == surface) same[on_it++] = color, sum_on_it += color;
    }
    if (count == 0) continue;
    const float4 mean = sum * (1.0F / static_cast<float>(count));
    const float4 differs = on_display(seen->channels()) - mean;
    if (is_known) {
      gain_.learn_known(sum_of_channels(differs * differs));
    } else {
      const float4 direction = on_it == 0 ? float4{} : sum_on_it * (1.0F / static_cast<float>(on_it)) - mean;
      gain_.learn(sum_of_channels(differs * differs), sum_of_channels(differs * direction),
                  sum_of_channels(direction * direction));
    }
    mixed_.note(count, count - on_it);
    if (on_it == count) continue;
    for (std::size_t i = 0; i < on_it; ++i) {
      const float4 direction = same[i] - mean;
      const float4 found = is_known ? direction : differs;
      share_.learn(Basis::kOne, errors_.near(node).level, sum_of_channels(found * direction),
                   sum_of_channels(direction * direction));
    }
  }
  share_.update();
}

void LatticeRefiner::set_sample(const LatticeNode& node, const NodeValue& value) {
  store_.set_sample(node, value);
  surfaces_.add(node, value);
  // Seeds come before it is settled whether anything is to be seen first.
  if (has_fineness_ && textures_.has(value.surface()) && visibility_.is_known()) textures_.learn(value, node);
}

// Looks at the own base squares, tile by tile.
void LatticeRefiner::look_for_unsampled() {
  unsampled_surfaces_.clear();
  if (!visibility_.is_known()) return;
  for (const int tile : tiles_) {
    if (!own_.touches_tile(tile)) continue;
    const LatticeNode corner = store_.corner_of(tile);
    constexpr int kTileSide = kPixelSide * LatticeStore::kTilePixels;
    for (int y = corner.y; y < std::min(corner.y + kTileSide, store_.bottom()); y += kBaseSide) {
      for (int x = corner.x; x < std::min(corner.x + kTileSide, store_.right()); x += kBaseSide)
        if (own_.owns({x, y})) look_for_unsampled({x, y}, tile);
    }
  }
}

void LatticeRefiner::look_for_unsampled(const LatticeNode& square, int tile) {
  const std::span<UnsampledSurface> found = unsampled_surfaces_.find(visibility_, surfaces_, square);
  if (found.empty()) return;
  const float variance = base_corners(square).variance();
  for (UnsampledSurface& surface : found) {
    surface.variance = variance;
    surface.priority = priority_of(worth_of_surface(surface));
    unsampled_surfaces_.keep(tile, surface);
  }
}

// Chooses the next surface of the tile that is worth a sample in this pass. Keeps the others.
bool LatticeRefiner::next_surface() {
  while (!surfaces_wanted_.empty()) {
    UnsampledSurface surface = surfaces_wanted_.back();
    surfaces_wanted_.pop_back();
    if (store_.is_sampled(surface.node) || !own_.owns(surface.node) ||
        surfaces_.has(surface.node, surface.surface))
      continue;
    const float worth = worth_of_surface(surface);
    if (worth < pass_.threshold) {
      surface.priority = std::min<NodeState>(priority_of(worth), pass_.least - 1);
      unsampled_surfaces_.keep(tile_, surface);
      continue;
    }
    wanted_.node = surface.node, wanted_.is_base = false, wanted_.area = surface.area;
    wanted_.predicted = predictor_.predict(surface.node, base_corners(surface.node));
    wanted_.predicted.variance = surface.variance, wanted_.predicted.basis = Basis::kNothing;
    return true;
  }
  return false;
}

Surroundings LatticeRefiner::base_corners(const LatticeNode& node) {
  const int x = node.x / kBaseSide * kBaseSide, y = node.y / kBaseSide * kBaseSide;
  Surroundings corners;
  for_each_corner({x, y}, kBaseSide, [&](int u, int v) { corners.add(predictor_.value({u, v}), {u, v}); });
  return corners;
}

// Returns what the first sample on a surface is worth, in the measure of worth_of(). The less one sample says
// of a surface, as in mirrors, the less it is.
float LatticeRefiner::worth_of_surface(const UnsampledSurface& surface) {
  const LocalErrors::Mean& near = errors_.near(surface.node);
  const float factor = estimates_.factor(class_of(Basis::kNothing, surface.variance, near.level));
  return share_.gain_of_one() * surface.area * detail_of(surface.variance) * factor /
         (kInsertion + near.rays);
}

// Nothing is learned from a sample whose neighbours may not be known here.
bool LatticeRefiner::insert(const Vec2d& point, const RaySample& sample) {
  Wanted at;
  at.node = node_at(point);
  if (arrived_ < awaited_.size() && awaited_[arrived_].node == at.node) {
    if (store_.is_sampled(at.node)) return false;
    insert_wanted(awaited_[arrived_++], sample);
    return true;
  }
  if (point_of(at.node) != point || !store_.has(at.node) || store_.is_sampled(at.node)) return false;
  const float4 seen{sample.color.x, sample.color.y, sample.color.z, 0};
  const auto rays = static_cast<float>(sample.rays);
  if (is_base(at.node)) {
    at.is_base = true;
    insert_wanted(at, sample);
    return true;
  }
  ++samples_, rays_ += sample.rays;
  at.level = level_of(at.node);
  const Surroundings around = known_around(at.node, at.level);
  float error = kUnpredicted;
  if (around.count() > 0) {
    at.predicted = predictor_.predict(at.node, around);
    error = squared_error(seen, at.predicted.value.channels());
  }
  errors_.note(at.node, error, rays);
  set_sample(at.node, NodeValue(seen, visibility_.surface_of(sample.primitive), seen_from(sample.lights)));
  make_candidates(at.node, at.level, worth_around(at, error, at.predicted.variance, at.predicted.basis));
  return true;
}

// Returns the samples at the corners of a node's square or at the ends of its side.
Surroundings LatticeRefiner::known_around(const LatticeNode& node, const LatticeLevel& level) const {
  Surroundings around;
  const auto add = [&](int x, int y) {
    const NodeValue* sample = store_.has({x, y}) ? store_.sample_at({x, y}) : nullptr;
    if (sample != nullptr) around.add(*sample, {x, y});
  };
  const int half = level.side / 2;
  if (level.kind == LatticeKind::kCenter) {
    for_each_corner({node.x - half, node.y - half}, level.side, add);
  } else {
    const int dx = (node.x & half) != 0 ? half : 0, dy = half - dx;
    add(node.x - dx, node.y - dy), add(node.x + dx, node.y + dy);
  }
  return around;
}

// Returns what a square pixel near a new sample is expected to be worth: what the sample did not find as
// predicted is a difference between the nodes around it.
float LatticeRefiner::worth_around(const Wanted& at, float squared_error, float variance, Basis basis) {
  const float next = 0.25F * squared_error + 0.5F * variance;
  const LocalErrors::Mean& near = errors_.near(at.node);
  return detail_of(next) * estimates_.factor(class_of(basis, next, near.level)) / (kInsertion + near.rays);
}

// The nodes that a new sample predicts. `worth_per_area`: what is expected of them, for each square pixel.
void LatticeRefiner::make_candidates(const LatticeNode& node, const LatticeLevel& level,
                                     float worth_per_area) {
  const auto [x, y] = node;
  if (level.kind == LatticeKind::kCenter) {
    const int half = level.side / 2;
    const LatticeLevel next{level.side, LatticeKind::kMiddle};
    const NodeState priority = priority_of(worth_per_area * effect_of(next));
    make_candidate({x - half, y}, next, priority);
    make_candidate({x + half, y}, next, priority);
    make_candidate({x, y - half}, next, priority);
    make_candidate({x, y + half}, next, priority);
  } else if (level.side > 2) {
    const int quarter = level.side / 4;
    const LatticeLevel next{level.side / 2, LatticeKind::kCenter};
    const NodeState priority = priority_of(worth_per_area * effect_of(next));
    make_candidate({x - quarter, y - quarter}, next, priority);
    make_candidate({x + quarter, y - quarter}, next, priority);
    make_candidate({x - quarter, y + quarter}, next, priority);
    make_candidate({x + quarter, y + quarter}, next, priority);
  }
}

// What came as a surprise on the side of two squares may go on in them: their centres get another chance.
void LatticeRefiner::look_beyond(const LatticeNode& middle, int side, float worth_per_area) {
  const int half = side / 2, dx = (middle.x & half) != 0 ? 0 : half, dy = half - dx;  // across the side
  const LatticeLevel level{side, LatticeKind::kCenter};
  const NodeState priority = priority_of(worth_per_area * effect_of(level));
  make_candidate({middle.x - dx, middle.y - dy}, level, priority);
  make_candidate({middle.x + dx, middle.y + dy}, level, priority);
}

void LatticeRefiner::make_candidate(const LatticeNode& node, const LatticeLevel& level, NodeState priority) {
  if (!store_.has(node) || !own_.owns(node) || !store_.raise(node, priority)) return;
  NodeState& greatest = greatest_in(store_.tile_at(node), index_of(level));
  greatest = std::max(greatest, priority);
}

// Tells how many pixels of each tile show several surfaces. A tile that was not seen here counts as the rest.
void LatticeRefiner::add_mixed_pixels(std::vector<TileWeights>& weights) const {
  double mixed = 0, pixels = 0;
  for (const int tile : region().tiles()) {
    const std::int64_t here = mixed_of_tile_[static_cast<std::size_t>(tile)];
    if (here == kUnknown) continue;
    mixed += static_cast<double>(here), pixels += region().grid().pixels(tile).area();
  }
  const double share = pixels > 0 ? mixed / pixels : 0;
  for (const int tile : region().tiles()) {
    const std::int64_t here = mixed_of_tile_[static_cast<std::size_t>(tile)];
    const double as_others = share * region().grid().pixels(tile).area();
    weights[static_cast<std::size_t>(tile)].mixed_pixels = here != kUnknown ? here : std::llround(as_others);
  }
}

double LatticeRefiner::weigh(std::vector<TileWeights>& weights) const {
  const TileGrid& grid = region().grid();
  weights.assign(static_cast<std::size_t>(grid.tile_count()), {});
  store_.for_each_square([&](int x, int y, std::int64_t count, double root) {
    TileWeights& here = weights[static_cast<std::size_t>(grid.tile_at(x, y))];
    here.count += count, here.total_weight += root;
  });
  std::array<std::int64_t, 256> of = store_.candidates();
  unsampled_surfaces_.for_each([&](const UnsampledSurface& surface) {
    const Vec2d at = point_of(surface.node);
    TileWeights& here = weights[static_cast<std::size_t>(grid.tile_at(at.x, at.y))];
    ++here.count, ++of[surface.priority];
    here.total_weight += std::sqrt(static_cast<double>(least_worth(surface.priority)));
  });
  add_mixed_pixels(weights);
  double worth = 0;
  for (std::size_t i = kLeastCandidate + 1; i <= kGreatestCandidate; ++i)
    worth += static_cast<double>(of[i]) * static_cast<double>(least_worth(static_cast<NodeState>(i)));
  const std::int64_t candidates = std::accumulate(of.begin() + kLeastCandidate, of.end(), std::int64_t{0});
  return candidates > 0 ? worth / static_cast<double>(candidates) : 0;
}

}  // namespace pprt
