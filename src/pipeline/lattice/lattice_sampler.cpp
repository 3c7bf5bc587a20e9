#include "pipeline/lattice/lattice_sampler.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pprt {
LatticeSampler::LatticeSampler(const SamplerSetup& setup, LatticeOrder order)
    : LatticeSampler(setup.region, order, {.samples = setup.samples, .keeps_samples = setup.keeps_samples},
                     {setup.probe.project, setup.probe.primitives, setup.probe.surfaces, setup.probe.bound},
                     setup.probe.textures, setup.probe.lights) {}

LatticeSampler::LatticeSampler(const Region& region, LatticeOrder order, const Goal& goal,
                               PrimitiveShapes shapes, PrimitiveTextures textures, PrimitiveLights lights)
    : goal_(goal), refiner_(region, std::move(shapes), order, std::move(textures), std::move(lights)) {
  if (goal_.keeps_samples) reserve_samples();
}

// Makes room for the samples of a resting picture, which takes no memory before they come. A list that grows
// is copied: with a million samples that takes as long as a frame.
void LatticeSampler::reserve_samples() {
  constexpr std::size_t kMostBytes = std::size_t{256} << 20;
  samples_.reserve(std::min(kMostSamplesPerPixel * region().pixel_count(), kMostBytes / sizeof(Sample)));
}

void LatticeSampler::clear(bool keep_learned) {
  if (keep_learned) {
    refiner_.restart();
  } else {
    refiner_.clear();
  }
  expect_goal();
  samples_.clear();
  weighed_ = 0;
  carried_.clear();
}

void LatticeSampler::expect_goal() {
  if (goal_.samples == 0) return;
  const TileGrid& grid = region().grid();
  const double pixels = static_cast<double>(grid.width) * grid.height;
  const double share = static_cast<double>(region().pixel_count()) / pixels;
  refiner_.expect(static_cast<double>(goal_.samples) * share - static_cast<double>(refiner_.samples()));
}

void LatticeSampler::set_region(const Region& region) {
  forget_weights(region);
  refiner_.set_region(region);
  expect_goal();
}

double LatticeSampler::reach(const Sample& sample) const {
  const LatticeNode node = node_at({sample.x, sample.y});
  const bool is_center = !is_base(node) && level_of(node).kind == LatticeKind::kCenter;
  return is_center ? 0.5 * level_of(node).side / kPixelSide : 0;
}

// The corners of the base squares, those on the border included: the same point shows the same on each rank
// that needs it, and none must wait for another.
std::vector<SeedPoint> LatticeSampler::seeds() const {
  std::vector<SeedPoint> seeds;
  for (const Vec2d& at : refiner_.base_points())
    seeds.push_back({at, static_cast<std::uint32_t>(seeds.size()), region().owns_point(at.x, at.y)});
  return seeds;
}

double LatticeSampler::footprint(const Vec2d& point) const {
  return footprint_of(node_at(point));
}

bool LatticeSampler::insert(const Sample& sample) {
  if (!refiner_.insert({sample.x, sample.y}, sample.ray)) return false;
  if (goal_.keeps_samples) samples_.push_back(sample);
  return true;
}

void LatticeSampler::expect_growth(double factor) {
  refiner_.expect((factor - 1) * static_cast<double>(refiner_.samples()));
}

// --- Quality

// Weighing costs as much as some ten samples. What is reported after painting is exact.
RegionQuality LatticeSampler::quality() {
  constexpr double kGrowth = 1.5;
  weigh_after(kGrowth);
  return {region(), weights_, mean_weight_};
}

// It is weighed anew where it is expected to suffice: what a sample is worth falls as about the fourth power
// of their number. A forecast errs, and each round is too often.
bool LatticeSampler::is_refined_to(double weight) {
  constexpr double kFall = 4, kLeastGrowth = 1.02, kGreatestGrowth = 1.25;
  const double growth = weight > 0 ? std::pow(mean_worth_ / weight, 1 / kFall) : kGreatestGrowth;
  weigh_after(std::clamp(growth, kLeastGrowth, kGreatestGrowth));
  return mean_worth_ <= weight;
}

// Weighs anew when there are so many times the samples of the last time.
void LatticeSampler::weigh_after(double growth) {
  const auto samples = static_cast<double>(refiner_.samples());
  if (weighed_ > 0 && samples <= growth * static_cast<double>(weighed_)) return;
  weighed_ = std::max<std::size_t>(refiner_.samples(), 1);
  mean_worth_ = refiner_.weigh(weights_);
  average_weights(region());
}

// The region becomes another one. If it only gets smaller, what is left has the weights that it had.
void LatticeSampler::forget_weights(const Region& next) {
  const std::vector<int>&before = region().tiles(), &after = next.tiles();
  if (weighed_ == 0 || !std::includes(before.begin(), before.end(), after.begin(), after.end())) {
    weighed_ = 0;
    return;
  }
  for (const int tile : before)
    if (!next.owns_tile(tile)) weights_[static_cast<std::size_t>(tile)] = {};
  average_weights(next);
}

void LatticeSampler::average_weights(const Region& region) {
  TileWeights all;
  for (const int tile : region.tiles()) {
    const TileWeights& weights = weights_[static_cast<std::size_t>(tile)];
    all.count += weights.count, all.total_weight += weights.total_weight;
  }
  mean_weight_ = all.count > 0 ? all.total_weight / static_cast<double>(all.count) : 0;
}

// --- Pixels

void LatticeSampler::paint(std::span<const std::int32_t> further_tiles, PixelBlock& pixels) {
  parts_.clear();
  for (const int tile : region().tiles()) parts_.push_back(region().grid().pixels(tile));
  for (const int tile : further_tiles) parts_.push_back(region().grid().pixels(tile));
  paint_tiles(
      region().bounds_with(further_tiles), [] { return false; }, pixels);
}

std::size_t LatticeSampler::repaint(std::span<const std::int32_t> tiles, const std::function<bool()>& is_over,
                                    PixelBlock& pixels) {
  parts_.clear();
  for (const std::int32_t tile : tiles) parts_.push_back(region().grid().pixels(tile));
  return paint_tiles(PixelRect(pixels.bounds), is_over, pixels);
}

std::size_t LatticeSampler::paint_tiles(const PixelRect& bounds, const std::function<bool()>& is_over,
                                        PixelBlock& pixels) {
  weighed_ = 0;
  return refiner_.paint(bounds, parts_, pixels, is_over);
}

// --- From frame to frame

CastResult LatticeSampler::cast(const Camera& next, int next_frame, const CastSettings& settings) const {
  CastSettings lit_only = settings;
  lit_only.lit_only = true;
  return cast_samples(samples_, region(), next, next_frame, lit_only);
}

}  // namespace pprt
