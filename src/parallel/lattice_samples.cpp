#include "parallel/lattice_samples.h"

#include <algorithm>
#include <utility>

namespace pprt {
namespace {

ProjectedShapeCache::View view_of(const Probe& probe) {
  if (probe.project) return probe.project;
  return [](std::uint32_t, ImageShape& shape) { shape.kind = ImageShape::Kind::kUnknown; };
}

}  // namespace

LatticeSamples::LatticeSamples(const SessionSettings& settings, const Partition& partition, int rank,
                               const Probe& probe)
    : rank_(rank),
      goal_(settings.stop.samples),
      partition_(partition),
      lattice_(region_of(partition, rank), view_of(probe),
               settings.sampler == SamplerChoice::kGrid ? LatticeOrder::kLevels : LatticeOrder::kAdaptive),
      outbox_(static_cast<std::size_t>(partition.ranks)),
      was_own_(partition.owner.size(), 0),
      casts_(settings.cast != CastChoice::kOff),
      keeps_samples_(partition.ranks > 1 || !settings.is_still || settings.report_samples),
      neighbours_(ranks_beside(partition, rank)) {
  if (keeps_samples_) reserve_samples();
}

// Makes room for the samples of a resting picture, which takes no memory before they come. A list that grows
// is copied: with a million samples that takes as long as a frame.
void LatticeSamples::reserve_samples() {
  constexpr std::size_t kMostBytes = std::size_t{256} << 20;
  samples_.reserve(std::min(kMostSamplesPerPixel * region().pixel_count(), kMostBytes / sizeof(Sample)));
}

void LatticeSamples::clear(bool keep_learned) {
  if (keep_learned) {
    lattice_.restart();
  } else {
    lattice_.clear();
  }
  expect_goal();
  samples_.clear();
  for (auto& box : outbox_) box.clear();
  std::fill(was_own_.begin(), was_own_.end(), std::uint8_t{0});
  forwards_ = false;
  weighed_ = 0;
  carried_.clear();
}

// Where a number of samples is the goal each rank takes the share of its area.
void LatticeSamples::expect_goal() {
  if (goal_ == 0) return;
  const PixelRect image{0, 0, partition_.grid.width, partition_.grid.height};
  const double share = static_cast<double>(region().pixel_count()) / static_cast<double>(image.area());
  lattice_.expect(static_cast<double>(goal_) * share - static_cast<double>(lattice_.samples()));
}

// The corners of the base squares, those on the border included: the same point shows the same on each rank
// that needs it, and none must wait for another.
std::vector<SeedPoint> LatticeSamples::seeds() const {
  std::vector<SeedPoint> seeds;
  for (const Vec2d& at : lattice_.base_points())
    seeds.push_back({at, static_cast<std::uint32_t>(seeds.size()), region().owns_point(at.x, at.y)});
  return seeds;
}

bool LatticeSamples::insert_seed(const Sample& sample, std::uint32_t /*number*/) {
  if (!lattice_.insert_at({sample.x, sample.y}, sample.ray)) return false;
  keep(sample);
  return true;
}

bool LatticeSamples::insert(const Sample& sample, int from) {
  if (!lattice_.insert_at({sample.x, sample.y}, sample.ray)) return false;
  keep(sample);
  // What others send is theirs to tell, but for tiles that were this rank's.
  if (partition_.ranks > 1 && (from == rank_ || forwards_)) tell_others(sample, from);
  return true;
}

void LatticeSamples::keep(const Sample& sample) {
  if (keeps_samples_) samples_.push_back(sample);
}

void LatticeSamples::insert_cast(std::span<const Sample> samples, const Inserted& done) {
  carried_.take(samples, region().bounds());
  for (const Sample& sample : samples) done(sample, false);
}

void LatticeSamples::expect_growth(double factor) {
  lattice_.expect((factor - 1) * static_cast<double>(lattice_.samples()));
}

// --- Exchange

LatticeSamples::TileRange LatticeSamples::tiles_that_need(const Sample& sample) const {
  constexpr double kBefore = 0.25 / kPixelSide;  // less than between two nodes
  const LatticeNode node = node_at({sample.x, sample.y});
  const bool is_center = !is_base(node) && level_of(node).kind == LatticeKind::kCenter;
  const double reach = is_center ? 0.5 * level_of(node).side / kPixelSide : 0;
  const TileGrid& grid = partition_.grid;
  return {grid.column_at(sample.x - reach - kBefore), grid.row_at(sample.y - reach - kBefore),
          grid.column_at(sample.x + reach), grid.row_at(sample.y + reach)};
}

void LatticeSamples::tell_others(const Sample& sample, int from) {
  const TileRange tiles = tiles_that_need(sample);
  if (from == rank_ && tiles.x0 == tiles.x1 && tiles.y0 == tiles.y1) return;
  ++applied_;
  told_.clear();
  for (int y = tiles.y0; y <= tiles.y1; ++y) {
    for (int x = tiles.x0; x <= tiles.x1; ++x) {
      const auto tile = static_cast<std::size_t>(y * partition_.grid.columns() + x);
      const int owner = partition_.owner[tile];
      const bool concerns = from == rank_ || was_own_[tile] != 0;
      if (!concerns || owner == rank_ || owner == from) continue;
      if (std::find(told_.begin(), told_.end(), owner) != told_.end()) continue;
      told_.push_back(owner);
      outbox_[static_cast<std::size_t>(owner)].push_back(sample);
    }
  }
}

std::vector<Sample> LatticeSamples::take_outbox(int rank) {
  return std::exchange(outbox_[static_cast<std::size_t>(rank)], {});
}

void LatticeSamples::introduce(std::span<const int> tiles, int taker) {
  std::vector<std::uint8_t> is_given(partition_.owner.size(), 0);
  for (const int tile : tiles) is_given[static_cast<std::size_t>(tile)] = 1;
  for (const Sample& sample : samples_) {
    const TileRange range = tiles_that_need(sample);
    bool concerns = false;
    for (int y = range.y0; y <= range.y1; ++y) {
      for (int x = range.x0; x <= range.x1; ++x)
        concerns |= is_given[static_cast<std::size_t>(y * partition_.grid.columns() + x)] != 0;
    }
    if (concerns) outbox_[static_cast<std::size_t>(taker)].push_back(sample);
  }
}

void LatticeSamples::forward_tile(int tile) {
  const auto t = static_cast<std::size_t>(tile);
  if (partition_.owner[t] == rank_) return;
  was_own_[t] = 1;
  forwards_ = true;
  introduce({&tile, 1}, partition_.owner[t]);
}

bool LatticeSamples::transfer(const Partition& partition) {
  for (std::size_t tile = 0; tile < was_own_.size(); ++tile) {
    if (partition_.owner[tile] == rank_) was_own_[tile] = 1;
    if (partition.owner[tile] == rank_) was_own_[tile] = 0;
  }
  forwards_ = std::find(was_own_.begin(), was_own_.end(), 1) != was_own_.end();
  partition_ = partition;
  neighbours_ = ranks_beside(partition, rank_);
  const Region own = region_of(partition, rank_);
  if (own.tiles() == region().tiles()) return false;
  forget_weights(own);
  lattice_.set_region(own);
  expect_goal();
  return true;
}

std::vector<std::uint32_t> LatticeSamples::known_in_tiles(int rank) const {
  std::vector<std::uint32_t> known(partition_.owner.size(), 0);
  if (rank != rank_) return known;
  for (const Sample& s : samples_) ++known[static_cast<std::size_t>(partition_.grid.tile_at(s.x, s.y))];
  return known;
}

// --- Readings

// Weighing costs as much as some ten samples. What is reported after painting is exact.
RegionQuality LatticeSamples::quality() {
  constexpr double kGrowth = 1.5;
  weigh_after(kGrowth);
  return {region(), weights_, mean_weight_};
}

bool LatticeSamples::is_refined_to(double quality) {
  constexpr double kGrowth = 1.25;
  weigh_after(kGrowth);
  return mean_worth_ <= quality;
}

// Weighs anew when there are so many times the samples of the last time.
void LatticeSamples::weigh_after(double growth) {
  const auto samples = static_cast<double>(lattice_.samples());
  if (weighed_ > 0 && samples <= growth * static_cast<double>(weighed_)) return;
  weighed_ = std::max<std::size_t>(lattice_.samples(), 1);
  mean_worth_ = lattice_.weigh(weights_);
  average_weights(region());
}

// The region becomes another one. If it only gets smaller, what is left has the weights that it had.
void LatticeSamples::forget_weights(const Region& next) {
  const std::vector<int>&before = region().tiles(), &after = next.tiles();
  if (weighed_ == 0 || !std::includes(before.begin(), before.end(), after.begin(), after.end())) {
    weighed_ = 0;
    return;
  }
  for (const int tile : before)
    if (!next.owns_tile(tile)) weights_[static_cast<std::size_t>(tile)] = {};
  average_weights(next);
}

void LatticeSamples::average_weights(const Region& region) {
  TileWeights all;
  for (const int tile : region.tiles()) {
    const TileWeights& weights = weights_[static_cast<std::size_t>(tile)];
    all.count += weights.count, all.total_weight += weights.total_weight;
  }
  mean_weight_ = all.count > 0 ? all.total_weight / static_cast<double>(all.count) : 0;
}

CastResult LatticeSamples::cast(const Camera& next, int next_frame, const CastSettings& settings) const {
  CastSettings lit_only = settings;
  lit_only.lit_only = true;
  return cast_samples(samples_, region(), next, next_frame, lit_only);
}

void LatticeSamples::paint(std::span<const std::int32_t> further_tiles, RegionPixels& pixels) {
  parts_.clear();
  for (const int tile : region().tiles()) parts_.push_back(partition_.grid.pixels(tile));
  for (const int tile : further_tiles) parts_.push_back(partition_.grid.pixels(tile));
  weighed_ = 0;
  lattice_.paint(region().bounds_with(further_tiles), parts_, pixels, [] { return false; });
}

std::size_t LatticeSamples::repaint(std::span<const std::int32_t> tiles, const std::function<bool()>& is_over,
                                    RegionPixels& pixels) {
  parts_.clear();
  for (const std::int32_t tile : tiles) parts_.push_back(partition_.grid.pixels(tile));
  weighed_ = 0;
  return lattice_.paint(region().bounds(), parts_, pixels, is_over);
}

}  // namespace pprt
