#include "pipeline/lattice/lattice_refiner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "pipeline/core/display_values.h"

namespace pprt {
namespace {

constexpr double kGridShare = 0.35;        // of all samples that the grid may take
constexpr float kInsertion = 2;            // time of choosing and inserting a sample, in rays
constexpr float kGreatestFall = 3;         // of the threshold, from pass to pass
constexpr double kFirstGrowth = 3;         // pessimistic: nothing is learned yet
constexpr float kSurprise = 1e-4F;         // squared error
constexpr float kShareOfLast = 0.2F;       // that an error of the last picture counts as, of one of this
constexpr float kUnpredicted = 1.0F / 32;  // squared error that a sample without a prediction counts as

// Calls visit(x, y) for the four corners of a square of nodes.
template <class Visit>
void for_each_corner(const LatticeNode& corner, int side, const Visit& visit) {
  visit(corner.x, corner.y), visit(corner.x + side, corner.y);
  visit(corner.x, corner.y + side), visit(corner.x + side, corner.y + side);
}

// Returns the tiles in bands of two rows. Bands follow each other by steps of the golden section, which fall
// evenly over the picture.
std::vector<int> in_scattered_bands(int columns, int rows) {
  constexpr int kBand = 2;
  constexpr double kGolden = 0.6180339887;
  std::vector<int> bands(static_cast<std::size_t>((rows + kBand - 1) / kBand));
  std::iota(bands.begin(), bands.end(), 0);
  const auto turn = [](int band) { return std::fmod(kGolden * band, 1.0); };
  std::sort(bands.begin(), bands.end(), [&](int a, int b) { return turn(a) < turn(b); });
  std::vector<int> tiles;
  for (const int band : bands) {
    for (int row = kBand * band; row < std::min(kBand * (band + 1), rows); ++row)
      for (int column = 0; column < columns; ++column) tiles.push_back(row * columns + column);
  }
  return tiles;
}

float squared_error(const float4& a, const float4& b) {
  const float4 difference = on_display(a) - on_display(b), squares = difference * difference;
  return (squares[0] + squares[1] + squares[2]) * (1.0F / 3);
}

// Below a pixel an error is a part of what the pixel shows.
float effect_of(const LatticeLevel& level) {
  const float area = level.area();
  return level.side <= kPixelSide ? 2 * area * area : area;
}

}  // namespace

LatticeRefiner::LatticeRefiner(const Region& region, ProjectedShapeCache::View view, LatticeOrder order)
    : order_(order),
      store_(region.grid().width, region.grid().height),
      own_(store_, region),
      tiles_(in_scattered_bands(store_.tile_columns(), store_.tile_rows())),
      shapes_(std::move(view)),
      errors_(store_.right(), store_.bottom()),
      predictor_(store_, shapes_, errors_, share_),
      painter_(store_, predictor_, shapes_, errors_, share_),
      greatest_(static_cast<std::size_t>(store_.tile_count()) * kLatticeLevels.size()) {
  clear();
}

void LatticeRefiner::clear() {
  shapes_.forget();
  estimates_.clear();
  share_.clear();
  growth_ = kFirstGrowth;
  errors_.clear();
  forget_samples();
}

void LatticeRefiner::restart() {
  const double as_many = static_cast<double>(samples_);
  growth_ = kFirstGrowth;  // of the last, small passes until now
  errors_.fade(kShareOfLast);
  forget_samples();
  expect(as_many);
}

void LatticeRefiner::forget_samples() {
  store_.clear();
  samples_ = 0;
  expected_ = 0;
  has_base_ = has_grid_ = is_region_new_ = false;
  grid_levels_ = 0;
  last_threshold_ = 0;
  pass_ = {};
  tiles_left_ = {};
  level_ = pass_.end_level;
  nodes_.clear();
  next_ = 0;
  std::fill(greatest_.begin(), greatest_.end(), kNotWanted);
  has_wanted_ = false;
}

// The region.

void LatticeRefiner::set_region(const Region& region) {
  const LatticeRegion before = std::exchange(own_, LatticeRegion(store_, region));
  own_.for_each_change(before, [&](const LatticeNode& corner, bool is_own) {
    if (is_own) {
      begin_square(corner);
    } else {
      leave_square(corner);
    }
  });
  has_base_ = false;
  is_region_new_ = true;
  if (order_ == LatticeOrder::kLevels) grid_levels_ = 0;
}

// What is known of a square already makes candidates in it.
void LatticeRefiner::begin_square(const LatticeNode& corner) {
  std::vector<LatticeNode> known;
  store_.for_each_known(corner, kBaseSide, [&](const LatticeNode& node) { known.push_back(node); });
  for (const LatticeNode& node : known) {
    if (!store_.is_sampled(node)) continue;
    Wanted at;
    at.node = node;
    if (is_base(at.node)) {
      at.level = {2 * kBaseSide, LatticeKind::kMiddle};
    } else {
      at.level = level_of(at.node);
      at.around = known_around(at.node, at.level);
      at.variance = at.around.count() > 0 ? at.around.variance() : 0;
      at.primitives = std::max(at.around.primitives(), 1);
    }
    make_candidates(at.node, at.level, worth_around(at, kUnpredicted, at.primitives));
  }
}

void LatticeRefiner::leave_square(const LatticeNode& corner) {
  store_.for_each_known(corner, kBaseSide, [&](const LatticeNode& node) {
    if (!own_.owns(node) && !store_.is_sampled(node)) store_.set_state(node, kNotWanted);
  });
}

std::vector<Vec2d> LatticeRefiner::base_points() const {
  std::vector<Vec2d> points;
  for (const LatticeNode& node : own_.base_nodes()) points.push_back(point_of(node));
  return points;
}

std::vector<Vec2d> LatticeRefiner::missing_base() const {
  std::vector<Vec2d> points;
  for (const LatticeNode& node : own_.base_nodes())
    if (!store_.is_sampled(node)) points.push_back(point_of(node));
  return points;
}

double LatticeRefiner::samples_left() const {
  const auto now = static_cast<double>(samples_);
  return expected_ > now ? expected_ - now : now;
}

// The order of nodes.

std::optional<Vec2d> LatticeRefiner::next_point() {
  for (;;) {
    while (next_ == nodes_.size()) {
      if (!next_nodes()) return std::nullopt;
    }
    const LatticeNode node = nodes_[next_++];
    // By now the node may hold another region's sample, or its square may have gone.
    if (store_.is_sampled(node) || !(pass_.takes_base ? own_.needs_base(node) : own_.owns(node))) continue;
    if (pass_.takes_base) {
      wanted_.node = node, wanted_.is_base = true, wanted_.variance = 0;
    } else if (!is_wanted(node, kLatticeLevels[level_ - 1])) {
      continue;
    }
    has_wanted_ = true;
    return point_of(node);
  }
}

// Collects the nodes of the next level, in the next tile or pass if need be. False when no pass is left.
bool LatticeRefiner::next_nodes() {
  next_ = 0;
  nodes_.clear();
  if (std::exchange(is_region_new_, false) && !missing_base().empty()) return leave_pass();
  if (level_ == pass_.end_level && !next_tile()) return start_pass();
  const std::size_t level = level_++;
  if (pass_.takes_base) {
    collect_base(tile_);
  } else if (pass_.takes_all) {
    store_.collect_all(tile_, kLatticeLevels[level], nodes_);
    std::erase_if(nodes_, [&](const LatticeNode& node) { return !own_.owns(node); });
  } else if (NodeState& greatest = greatest_in(tile_, level); greatest >= pass_.least) {
    greatest = pass_.least;  // no greater one will be left; new ones may come
    store_.collect(tile_, kLatticeLevels[level], pass_.least, nodes_);
  }
  return true;
}

// Goes on to the next tile of the pass.
bool LatticeRefiner::next_tile() {
  while (!tiles_left_.empty()) {
    tile_ = tiles_left_.front();
    tiles_left_ = tiles_left_.subspan(1);
    if (!own_.touches_tile(tile_)) continue;
    level_ = pass_.first_level;
    return true;
  }
  return false;
}

// Begins another pass before this one has ended.
bool LatticeRefiner::leave_pass() {
  if (pass_.takes_all && !pass_.takes_base) grid_levels_ = std::min(grid_levels_, pass_.first_level);
  return start_pass();
}

void LatticeRefiner::collect_base(int tile) {
  const LatticeNode corner = store_.corner_of(tile);
  constexpr int kTileSide = kPixelSide * LatticeStore::kTilePixels;
  for (int y = corner.y; y < corner.y + kTileSide; y += kBaseSide) {
    for (int x = corner.x; x < corner.x + kTileSide; x += kBaseSide)
      if (store_.has({x, y}) && own_.needs_base({x, y})) nodes_.push_back({x, y});
  }
}

bool LatticeRefiner::start_pass() {
  learn_growth();
  estimates_.update();
  share_.update();
  errors_.start_round();
  store_.forget_predictions();
  return start_grid_pass() || (order_ == LatticeOrder::kAdaptive && start_refinement_pass());
}

void LatticeRefiner::start(const Pass& pass) {
  pass_ = pass;
  pass_.begun_with = static_cast<std::int64_t>(samples_);
  tiles_left_ = tiles_;
  level_ = pass_.end_level;
}

// Takes a whole level, while the levels so far are but a part of all samples to come.
bool LatticeRefiner::start_grid_pass() {
  if (!std::exchange(has_base_, true)) {
    start({.first_level = 0, .end_level = 1, .takes_base = true, .takes_all = true});
    return true;
  }
  if (has_grid_ || grid_levels_ == kLatticeLevels.size()) return false;
  const LatticeLevel& level = kLatticeLevels[grid_levels_];
  const auto with_level = static_cast<double>(region().pixel_count()) / level.area();
  const double expected = static_cast<double>(samples_) + samples_left();
  const bool is_affordable = with_level <= kGridShare * expected && level.side > kPixelSide;
  if (!is_affordable && order_ == LatticeOrder::kAdaptive) {
    has_grid_ = true;
    return false;
  }
  start({.first_level = grid_levels_, .end_level = grid_levels_ + 1, .takes_all = true});
  ++grid_levels_;
  return true;
}

// What candidates find makes new ones, which count as well: the more, the farther a candidate's worth lies
// above the threshold. Halving a node's area leaves a quarter of its worth to each of two, so that its square
// root tells how many there will be. A pass asks for half of the samples left, for all that is but an
// estimate.
bool LatticeRefiner::start_refinement_pass() {
  constexpr double kShare = 0.5, kLast = 0.25, kMost = 0.6;
  const std::array<std::int64_t, 256>& counts = store_.candidates();
  const double all = std::accumulate(counts.begin() + kLeastCandidate + 1, counts.end(), 0.0);
  if (all == 0) return false;
  const double left = std::max(samples_left(), 1.0) / growth_;
  const double affordable = left < kLast * static_cast<double>(samples_) ? left : kShare * left;
  NodeState least = kGreatestCandidate + 1;
  double above = 0, roots = 0, root = 0;
  do {
    --least;
    root = std::sqrt(static_cast<double>(least_worth(least)));
    above += static_cast<double>(counts[least]);
    roots += static_cast<double>(counts[least]) * root;
  } while (least > kLeastCandidate + 1 && above < kMost * all && roots < affordable * root);
  // Lower thresholds at once would let new candidates run away from what was asked for.
  last_threshold_ = std::max(least_worth(least), last_threshold_ / kGreatestFall);
  start({.first_level = 0,
         .end_level = kLatticeLevels.size(),
         .least = priority_of(last_threshold_),
         .threshold = last_threshold_,
         .promised = roots / std::sqrt(static_cast<double>(last_threshold_))});
  return true;
}

void LatticeRefiner::learn_growth() {
  constexpr std::int64_t kEnough = 200;
  if (pass_.takes_all || pass_.promised == 0) return;
  const std::int64_t made = static_cast<std::int64_t>(samples_) - pass_.begun_with;
  const double growth = static_cast<double>(made) / pass_.promised;
  if (made >= kEnough) growth_ = 0.5 * growth_ + 0.5 * std::clamp(growth, 0.3, 4.0);
}

// The worth of a sample.

// Whether a node is worth a sample in this pass. Keeps its priority otherwise.
bool LatticeRefiner::is_wanted(const LatticeNode& node, const LatticeLevel& level) {
  wanted_.node = node, wanted_.level = level, wanted_.is_base = false;
  wanted_.around = predictor_.around(node, level);
  wanted_.variance = wanted_.around.variance();
  wanted_.primitives = wanted_.around.primitives();
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
  const bool is_flat = level.side <= kPixelSide && at.variance < kFlat;
  if (is_flat && near.level < kLeastLevel) return 0;
  const float factor = estimates_.factor(class_of(at.primitives, at.variance, near.level));
  const float worth = effect_of(level) * detail_of(at.variance) * factor / (kInsertion + near.rays);
  return is_flat ? kShareOfFlat * worth : worth;
}

// Takes in the sample of the wanted node.
void LatticeRefiner::insert_wanted(const RaySample& sample) {
  const Wanted& at = wanted_;
  has_wanted_ = false;
  const float4 seen{sample.color.x, sample.color.y, sample.color.z, 0};
  const auto rays = static_cast<float>(sample.rays);
  ++samples_;
  if (at.is_base) {
    constexpr float kWeight = 0.5F;
    errors_.note(at.node, kUnpredicted, rays, kWeight);
    store_.set_sample(at.node, NodeValue(seen, sample.primitive));
    make_candidates(at.node, {2 * kBaseSide, LatticeKind::kMiddle}, worth_around(at, kUnpredicted, 1));
    return;
  }
  const Prediction predicted = predictor_.predict(at.node, at.around, at.variance, at.primitives);
  const float error = squared_error(seen, predicted.value.channels());
  const LocalErrors::Mean near = errors_.near(at.node);
  const float effect = effect_of(at.level);
  estimates_.learn(class_of(at.primitives, at.variance, near.level), effect * detail_of(at.variance),
                   effect * std::sqrt(error));
  if (predicted.shows_edge) learn_edge(at, seen, predicted);
  errors_.note(at.node, error, rays);
  store_.set_sample(at.node, NodeValue(seen, sample.primitive));
  const int primitives = std::max(at.primitives, predicted.value.primitive() == sample.primitive ? 1 : 2);
  const float worth = worth_around(at, error, primitives);
  make_candidates(at.node, at.level, worth);
  if (at.level.kind == LatticeKind::kMiddle && error > kSurprise) look_beyond(at.node, at.level.side, worth);
}

// Nothing is learned from a sample whose neighbours may not be known here.
bool LatticeRefiner::insert(const Vec2d& point, const RaySample& sample) {
  Wanted at;
  at.node = node_at(point);
  if (has_wanted_ && wanted_.node == at.node) {
    insert_wanted(sample);
    return true;
  }
  if (point_of(at.node) != point || !store_.has(at.node) || store_.is_sampled(at.node)) return false;
  const float4 seen{sample.color.x, sample.color.y, sample.color.z, 0};
  const auto rays = static_cast<float>(sample.rays);
  if (is_base(at.node)) {
    at.is_base = true;
    wanted_ = at;
    insert_wanted(sample);
    return true;
  }
  ++samples_;
  at.level = level_of(at.node);
  at.around = known_around(at.node, at.level);
  float error = kUnpredicted;
  if (at.around.count() > 0) {
    at.variance = at.around.variance();
    at.primitives = at.around.primitives();
    error = squared_error(seen, at.around.mean());
  }
  errors_.note(at.node, error, rays);
  store_.set_sample(at.node, NodeValue(seen, sample.primitive));
  make_candidates(at.node, at.level, worth_around(at, error, at.primitives));
  return true;
}

// Returns the samples at the corners of a node's square or at the ends of its side.
Surroundings LatticeRefiner::known_around(const LatticeNode& node, const LatticeLevel& level) const {
  Surroundings around;
  const auto add = [&](int x, int y) {
    const NodeValue* sample = store_.has({x, y}) ? store_.sample_at({x, y}) : nullptr;
    if (sample != nullptr) around.add(*sample);
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
float LatticeRefiner::worth_around(const Wanted& at, float squared_error, int primitives) {
  const float variance = 0.25F * squared_error + 0.5F * at.variance;
  const LocalErrors::Mean& near = errors_.near(at.node);
  return detail_of(variance) * estimates_.factor(class_of(primitives, variance, near.level)) /
         (kInsertion + near.rays);
}

void LatticeRefiner::learn_edge(const Wanted& at, const float4& seen, const Prediction& predicted) {
  const float4 mean = on_display(at.around.mean());
  const float4 direction = on_display(predicted.on_primitive) - mean;
  const float4 along = (on_display(seen) - mean) * direction, squared = direction * direction;
  share_.learn(at.primitives, errors_.near(at.node).level, along[0] + along[1] + along[2],
               squared[0] + squared[1] + squared[2]);
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

double LatticeRefiner::weigh(std::vector<TileWeights>& weights) const {
  const TileGrid& grid = region().grid();
  weights.assign(static_cast<std::size_t>(grid.tile_count()), {});
  store_.for_each_square([&](int x, int y, std::int64_t count, double root) {
    TileWeights& here = weights[static_cast<std::size_t>(grid.tile_at(x, y))];
    here.count += count, here.total_weight += root;
  });
  const std::array<std::int64_t, 256>& of = store_.candidates();
  double worth = 0;
  for (std::size_t i = kLeastCandidate + 1; i <= kGreatestCandidate; ++i)
    worth += static_cast<double>(of[i]) * static_cast<double>(least_worth(static_cast<NodeState>(i)));
  const std::int64_t candidates = std::accumulate(of.begin() + kLeastCandidate, of.end(), std::int64_t{0});
  return candidates > 0 ? worth / static_cast<double>(candidates) : 0;
}

std::size_t LatticeRefiner::paint(const PixelRect& bounds, std::span<const PixelRect> parts,
                                  PixelBlock& pixels, const std::function<bool()>& is_over) {
  store_.forget_predictions();
  errors_.start_round();
  pixels.bounds = bounds;
  pixels.colors.resize(bounds.area());
  std::size_t painted = 0;
  while (painted < parts.size()) {
    painter_.paint(parts[painted++], pixels);
    if (is_over()) break;
  }
  return painted;
}

}  // namespace pprt
