#include "pipeline/lattice/lattice_refiner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace pprt {
namespace {

// Times, in rays.
constexpr double kRaysOfASample = 5;      // beside its own
constexpr double kSurfacesOfASample = 2;  // what surfaces that are seen add to a sample
constexpr double kRaysOfAMixedPixel = 5;  // painting a pixel that shows several surfaces
constexpr double kFirstRay_s = 1.2e-7;    // CPU time of each of them, when seeing. AMD EPYC: .7e-7 to 1.5e-7
constexpr double kRoot = 2, kRootOfFew = 2.8;  // by which the RMSE falls: frames have few samples
constexpr double kFirstPrice = 5;              // a quadric or facet, before one was seen
constexpr double kGridShare = 0.35;            // of all samples that the grid may take
constexpr float kGreatestFall = 3;             // of the threshold, from pass to pass
constexpr float kShareOfLast = 0.2F;  // that light on textures in the last picture counts as, of this one's

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

}  // namespace

LatticeRefiner::LatticeRefiner(const Region& region, PrimitiveShapes shapes, LatticeOrder order,
                               PrimitiveTextures textures, PrimitiveLights lights)
    : order_(order),
      store_(region.grid().width, region.grid().height),
      own_(store_, region),
      tiles_(in_scattered_bands(store_.tile_columns(), store_.tile_rows())),
      visibility_(store_.right() / kPixelSide, store_.bottom() / kPixelSide, shapes),
      surfaces_(store_.right(), store_.bottom()),
      unsampled_surfaces_(store_.tile_count()),
      errors_(store_.right(), store_.bottom()),
      textures_(std::move(textures), visibility_),
      lights_(std::move(lights), visibility_),
      silhouettes_(std::move(shapes.project), shapes.count, shapes.surfaces),
      predictor_(store_, visibility_, surfaces_, errors_, share_, textures_, lights_, silhouettes_),
      painter_(store_, predictor_, visibility_, {surfaces_, errors_, share_, textures_, lights_},
               silhouettes_, errors_, share_),
      ray_s_(kFirstRay_s),
      greatest_(static_cast<std::size_t>(store_.tile_count()) * kLatticeLevels.size()) {
  clear();
}

void LatticeRefiner::clear() {
  mixed_of_tile_.assign(static_cast<std::size_t>(region().grid().tile_count()), kUnknown);
  was_seen_ = has_last_ = has_seen_ = false;
  price_ = {.each = kFirstPrice};
  mixed_ = {};
  forget_visibility(VisibilityBuffer::kFine);
  estimates_.clear();
  share_.clear();
  gain_.clear();
  textures_.clear();
  errors_.clear();
  forget_samples();
}

// The region changes before restart(), and then nothing is to be seen of it.
void LatticeRefiner::camera_changed() {
  note_seeing();
  forget_visibility(visibility_.fineness());
  silhouettes_.forget();
  visibility_.limit(0);
}

// Learns what it took to see the picture.
void LatticeRefiner::note_seeing() {
  if (!visibility_.has_seen()) return;
  const std::size_t items = std::max<std::size_t>(visibility_.items_within(), 1);
  // Tiles take work, too. Where they hold few shapes, it is most of all.
  constexpr double kMostForEach = 4 * kFirstPrice;
  const double each = std::min(visibility_.work() / static_cast<double>(items), kMostForEach);
  price_ = {.each = each, .seen = items, .further = kFirstPrice};
  mixed_.learn(visibility_.mixed_share());
  was_seen_ = true;
}

void LatticeRefiner::restart() {
  note_seeing();
  has_last_ = true, has_seen_ = std::exchange(was_seen_, false);
  const auto as_many = static_cast<double>(samples_);
  errors_.clear();
  textures_.fade(kShareOfLast);
  forget_samples();
  expect(as_many);
}

void LatticeRefiner::forget_visibility(const VisibilityBuffer::Fineness& fineness) {
  visibility_.forget(fineness);
  textures_.forget();
  lights_.forget();
}

void LatticeRefiner::forget_samples() {
  visibility_.limit(0);  // until it is settled what it is worth
  silhouettes_.show(false);
  store_.clear();
  surfaces_.clear();
  unsampled_surfaces_.clear();
  has_looked_ = has_fineness_ = false;
  surfaces_wanted_.clear();
  forecast_.reset();
  samples_ = rays_ = learned_from_ = 0;
  expected_ = 0;
  has_base_ = has_grid_ = is_region_new_ = false;
  grid_levels_ = 0;
  last_threshold_ = 0;
  pass_ = {};
  growth_ = {};  // the last passes of a picture are small
  tiles_left_ = {};
  level_ = pass_.end_level;
  nodes_.clear();
  next_ = 0;
  std::fill(greatest_.begin(), greatest_.end(), kNotWanted);
  awaited_.clear();
  arrived_ = 0;
}

// The region.

// The nodes that the pass has not come to stay candidates, which a later one finds by `greatest_`.
void LatticeRefiner::leave_nodes() {
  const auto leave = [this](const LatticeNode& node, std::size_t level) {
    NodeState& greatest = greatest_in(store_.tile_at(node), level);
    greatest = std::max(greatest, store_.state(node));
  };
  if (!pass_.takes_all) {
    for (; next_ < nodes_.size(); ++next_) leave(nodes_[next_], level_ - 1);
    for (std::size_t i = arrived_; i < awaited_.size(); ++i)
      if (awaited_[i].area == 0) leave(awaited_[i].node, index_of(awaited_[i].level));
  }
  awaited_.clear();
  arrived_ = 0;
  nodes_.clear();
  next_ = 0;
}

void LatticeRefiner::set_region(const Region& region) {
  const LatticeRegion before = std::exchange(own_, LatticeRegion(store_, region));
  own_.for_each_change(before, [&](const LatticeNode& corner, bool is_own) {
    if (is_own) {
      begin_square(corner);
    } else {
      leave_square(corner);
    }
  });
  has_base_ = has_looked_ = false;
  surfaces_wanted_.clear();
  leave_nodes();
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
    Prediction predicted;
    if (is_base(at.node)) {
      at.level = {2 * kBaseSide, LatticeKind::kMiddle};
    } else {
      at.level = level_of(at.node);
      const Surroundings around = known_around(at.node, at.level);
      if (around.count() > 0) predicted = predictor_.predict(node, around);
    }
    make_candidates(at.node, at.level, worth_around(at, kUnpredicted, predicted.variance, Basis::kAllAround));
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

// Many at once, so that deciding and tracing each find their code and data in the caches. Nodes of one level
// in a tile do not predict each other. Which ones come together does not depend on when sampling pauses.
std::span<const Vec2d> LatticeRefiner::next_points(std::size_t most) {
  awaited_.erase(awaited_.begin(),
                 awaited_.begin() + static_cast<std::ptrdiff_t>(std::exchange(arrived_, 0)));
  std::erase_if(awaited_, [this](const Wanted& at) { return !is_open(at.node, at.is_base); });
  if (awaited_.empty())
    while (awaited_.size() < most && choose_next(awaited_.empty())) awaited_.push_back(wanted_);
  points_.clear();
  for (const Wanted& at : awaited_) points_.push_back(point_of(at.node));
  return std::span(points_).first(std::min(most, points_.size()));
}

// Chooses the next sample. `may_go_on`: to another level or tile. False if there is none.
bool LatticeRefiner::choose_next(bool may_go_on) {
  for (;;) {
    if (next_surface()) return true;
    if (next_ == nodes_.size()) {
      if (!may_go_on || !next_nodes()) return false;
      continue;
    }
    const LatticeNode node = nodes_[next_++];
    // By now the node may hold another region's sample, or its square may have gone.
    if (!is_open(node, pass_.takes_base)) continue;
    wanted_.area = 0;
    if (pass_.takes_base) {
      wanted_.node = node, wanted_.is_base = true;
      return true;
    }
    if (is_wanted(node, kLatticeLevels[level_ - 1])) return true;
  }
}

// Collects the nodes of the next level, in the next tile or pass if need be. False when no pass is left.
bool LatticeRefiner::next_nodes() {
  next_ = 0;
  nodes_.clear();
  if (std::exchange(is_region_new_, false) && !missing_base().empty()) return leave_pass();
  if (level_ == pass_.end_level && !next_tile()) return start_pass();
  if (!surfaces_wanted_.empty()) return true;
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

// What the pass has found so far is expected of its other tiles. Where a picture is empty the candidates of a
// whole level wait: a few of them tell that there is nothing.
void LatticeRefiner::learn_within_pass() {
  constexpr std::size_t kLeast = 64, kShare = 32;
  if (samples_ - learned_from_ < std::max(kLeast, samples_ / kShare)) return;
  estimates_.update();
  learned_from_ = samples_;
}

// Goes on to the next tile of the pass.
bool LatticeRefiner::next_tile() {
  learn_within_pass();
  while (!tiles_left_.empty()) {
    tile_ = tiles_left_.front();
    tiles_left_ = tiles_left_.subspan(1);
    if (!own_.touches_tile(tile_)) continue;
    level_ = pass_.first_level;
    if (!pass_.takes_all) unsampled_surfaces_.take(tile_, pass_.least, surfaces_wanted_);
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
      if (own_.needs_base({x, y})) nodes_.push_back({x, y});
  }
}

bool LatticeRefiner::start_pass() {
  growth_.end_pass(samples_);
  estimates_.update();
  learned_from_ = samples_;
  share_.update();
  textures_.update();
  errors_.start_round();
  store_.forget_predictions();
  ask_again();
  return start_grid_pass() || (order_ == LatticeOrder::kAdaptive && start_refinement_pass());
}

// While a camera rests a picture gets many times the samples that it was begun for. The frame in which it
// begins has its forecast.
void LatticeRefiner::ask_again() {
  if (!has_fineness_ || forecast_ || visibility_.has_seen()) return;
  if (static_cast<double>(samples_) >= ask_again_at_) has_fineness_ = has_looked_ = false;
}

void LatticeRefiner::start(const Pass& pass) {
  pass_ = pass;
  growth_.begin_pass(samples_, pass_.promised);
  tiles_left_ = tiles_;
  level_ = pass_.end_level;
}

// Where there are few samples finer edges would not show. What they cost does not grow with the samples, nor
// does what it costs to see. So seeing may take the more time, the more of the error it takes away. A picture
// that begins without an estimate of its samples gets all: a still without their number, and on the work
// clock a first frame.
void LatticeRefiner::choose_fineness() {
  constexpr double kFew = 0.1, kEnough = 0.4;  // samples a pixel
  learn_from_base();
  has_fineness_ = true;
  if (expected_ == 0) {
    ask_again_at_ = VisibilityBuffer::kNoLimit;
    visibility_.limit(VisibilityBuffer::kNoLimit, price_, region().bounds());
    return;
  }
  const double samples = static_cast<double>(samples_) + samples_left();
  constexpr double kMany = 2;
  ask_again_at_ = forecast_ ? 0 : kMany * samples;
  const double per_pixel = samples_if_seen(samples) / static_cast<double>(region().pixel_count());
  const VisibilityBuffer::Fineness fineness = per_pixel < kFew      ? VisibilityBuffer::kCoarse
                                              : per_pixel < kEnough ? VisibilityBuffer::kMiddle
                                                                    : VisibilityBuffer::kFine;
  if (fineness != visibility_.fineness()) forget_visibility(fineness);
  visibility_.limit(time_for_seeing(samples), price_, region().bounds());
  // A picture that is asked again keeps its silhouettes.
  if (!forecast_) return;
  const double began_s = forecast_->used_s ? forecast_->used_s() : 0;
  if (visibility_.is_known()) {
    see_in_time(began_s);
  } else {
    constexpr double kForgotten = 0.02;
    ray_s_ += kForgotten * (kFirstRay_s - ray_s_);
  }
  // Where there is no time for what would be worth much, silhouettes of what samples have found bring a part.
  constexpr double kWorthMuch = 0.8;
  silhouettes_.show(gain_.worthwhile_share(kRootOfFew) > kWorthMuch && !visibility_.is_known());
}

// Sees the region at once, so that neither samples nor painting take longer for it, and learns what it takes.
// Only then it is known how many pixels show several surfaces. If there is no time to paint so many, the
// picture counts as unseen. `began_s`: when bounding began.
void LatticeRefiner::see_in_time(double began_s) {
  for (const int tile : region().tiles()) {
    const PixelRect pixels = region().grid().pixels(tile);
    visibility_.see_within(pixels);
    if (!visibility_.is_known()) return;  // one has turned out to have no shape
    mixed_of_tile_[static_cast<std::size_t>(tile)] = visibility_.mixed_within(pixels);
    if (forecast_->pause) forecast_->pause();
  }
  if (!forecast_->used_s) return;
  const double rays = visibility_.bounding() + visibility_.work(), took_s = forecast_->used_s() - began_s;
  constexpr double kEnough = 1000;            // rays; fewer say nothing
  constexpr double kLeast = 0.2, kMost = 10;  // of the first: what is beyond was disturbed
  if (rays >= kEnough) ray_s_ = std::clamp(took_s / rays, kLeast * kFirstRay_s, kMost * kFirstRay_s);
  const double seeing = took_s / forecast_->sample_s;
  const double painting = forecast_->mixed_pixel * static_cast<double>(visibility_.mixed_pixels());
  if (static_cast<double>(samples_) + seeing + painting <= forecast_->samples) return;
  note_seeing();
  visibility_.limit(0);
}

// Returns how many there will be if what is visible is seen. Seeing takes about as long as painting.
double LatticeRefiner::samples_if_seen(double samples) const {
  if (!forecast_ || has_seen_) return samples;
  return std::max(samples - 2 * expected_mixed() * forecast_->mixed_pixel, static_cast<double>(samples_));
}

// Returns how many rays seeing may take, if there will be so many samples. With a rate it must fit beside the
// samples that there are, and takes others away. Without one it comes on top of them. Painting takes longer,
// too, where surfaces meet.
double LatticeRefiner::time_for_seeing(double samples) const {
  // Shares of the time, and their factor where the picture before was seen, too: a change flickers.
  constexpr double kMostShare = 0.9, kSeenAgain = 1.1;
  const double gain = gain_.worthwhile_share(forecast_ || has_last_ ? kRootOfFew : kRoot);
  const double share = std::min(kMostShare, (has_seen_ ? kSeenAgain : 1) * gain);
  const auto now = static_cast<double>(samples_);
  const double rays = static_cast<double>(rays_) / std::max(now, 1.0);
  const double unseen = rays + kRaysOfASample, seen = unseen + kSurfacesOfASample;  // a sample
  const double mixed = expected_mixed();
  if (!forecast_) {
    return samples * (share * seen - kSurfacesOfASample) / (1 - share) - kRaysOfAMixedPixel * mixed;
  }
  const double time = forecast_->samples;  // in samples
  const double most = std::min(share * time, time - now), surcharge = kSurfacesOfASample / seen;
  const double seeing = (most - surcharge * time) / (1 - surcharge) - mixed * forecast_->mixed_pixel;
  return seeing * forecast_->sample_s / ray_s_;
}

// With many samples a pixel the shares of what is seen in it must not err by more than its colours, nor must
// the textures. A place of a texture takes about a hundredth of a sample's time.
void LatticeRefiner::choose_shares() {
  constexpr double kMany = 1.5;  // samples a pixel
  const double per_pixel = static_cast<double>(samples_) / static_cast<double>(region().pixel_count());
  if (per_pixel > kMany) visibility_.refine_shares();
  constexpr double kOnePlace = 0.02, kFour = 0.3, kSixteen = 3;
  textures_.divide_by(per_pixel < kOnePlace ? 1 : per_pixel < kFour ? 2 : per_pixel < kSixteen ? 4 : 8);
}

// Takes a whole level, while the levels so far are but a part of all samples to come.
bool LatticeRefiner::start_grid_pass() {
  if (!std::exchange(has_base_, true)) {
    start({.first_level = 0, .end_level = 1, .takes_base = true, .takes_all = true});
    return true;
  }
  if (!has_fineness_) choose_fineness();
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
  if (!std::exchange(has_looked_, true)) look_for_unsampled();
  std::array<std::int64_t, 256> counts = store_.candidates();
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += unsampled_surfaces_.counts()[i];
  const double all = std::accumulate(counts.begin() + kLeastCandidate + 1, counts.end(), 0.0);
  if (all == 0) return false;
  const double left = std::max(samples_left(), 1.0) / growth_.get();
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

std::size_t LatticeRefiner::paint(const PixelRect& bounds, std::span<const PixelRect> parts,
                                  PixelBlock& pixels, const std::function<bool()>& is_over) {
  store_.forget_predictions();
  if (!has_fineness_ && samples_ >= least_samples()) choose_fineness();  // no others were asked for
  choose_shares();
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
