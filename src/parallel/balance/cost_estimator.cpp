#include "parallel/balance/cost_estimator.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace pprt {
namespace {

double mean_weight(const TileWeights& weights) {
  return weights.count > 0 ? weights.total_weight / static_cast<double>(weights.count) : 0;
}

}  // namespace

double reconstruction_cost(const TileGrid& grid, int tile) {
  return static_cast<double>(grid.pixels(tile).area()) * static_cast<double>(price(Work::kPixel));
}

CostEstimator::CostEstimator(const TileGrid& grid, const SampleWork& work)
    : grid_(grid),
      own_sample_(static_cast<double>(price(work.own))),
      received_sample_(static_cast<double>(price(work.received))),
      now_(static_cast<std::size_t>(grid.tile_count())),
      last_(static_cast<std::size_t>(grid.tile_count())) {}

void CostEstimator::begin_frame(bool fresh_picture, FrameLikeness likeness, double mixed_pixel) {
  likeness_ = likeness;
  mixed_pixel_ = mixed_pixel;
  share_of_now_ = likeness == FrameLikeness::kUnknown ? 1 : 0;
  received_last_ = std::exchange(received_now_, 0);
  if (!fresh_picture) return;
  last_ = now_;
  std::fill(now_.begin(), now_.end(), TileEstimate());
}

void CostEstimator::add_own(const Sample& sample) {
  const int tile = grid_.tile_at(sample.x, sample.y);
  const double cost = static_cast<double>(price(Work::kRay) * sample.ray.rays) + own_sample_;
  now_[static_cast<std::size_t>(tile)].cost += cost;
  counted_ += cost;
}

void CostEstimator::add_received() {
  received_now_ += received_sample_;
  counted_ += received_sample_;
}

void CostEstimator::accept(const TileTransfer& transfer) {
  now_[static_cast<std::size_t>(transfer.tile)] = transfer.now;
  last_[static_cast<std::size_t>(transfer.tile)] = transfer.last;
}

void CostEstimator::update(const RegionQuality& refined, double elapsed) {
  switch (likeness_) {
    case FrameLikeness::kUnknown:
      share_of_now_ = 1;
      break;
    case FrameLikeness::kSimilar:
      share_of_now_ = elapsed;
      break;
    case FrameLikeness::kSame:
      share_of_now_ = 0;
      break;
  }
  if (refined.mean_weight > 0) learn_cost_per_triangle(refined);
}

void CostEstimator::learn_cost_per_triangle(const RegionQuality& refined) {
  double cost = 0, triangles = 0;
  for (const int tile : refined.region.tiles()) {
    cost += now(tile).cost;
    triangles += refined.tile(tile).count;
  }
  cost_per_candidate_ = triangles > 0 ? cost / triangles : 0;
}

// What a tile's refinement so far has cost; at least the region's mean for its triangles. A tile with hardly
// a sample, but with triangles that wait for one, would else seem to cost nothing to refine: few samples fall
// into a small tile.
double CostEstimator::cost_of(const RegionQuality& refined, int tile) const {
  const TileWeights& weights = refined.tile(tile);
  return std::max(now(tile).cost, static_cast<double>(weights.count) * cost_per_candidate_);
}

double CostEstimator::future_cost(const RegionQuality& refined, int tile, double target) const {
  const double weight = mean_weight(refined.tile(tile));
  const double paid = now(tile).cost;
  const double cost_at_1 = (1 - share_of_now_) * last(tile).cost * last(tile).average_weight +
                           share_of_now_ * cost_of(refined, tile) * weight;
  return cost_at_1 / target - paid + reconstruction_cost(grid_, tile) + mixed_cost(refined, tile);
}

double CostEstimator::future_cost_of_region(const RegionQuality& refined, double target) const {
  double sum = likeness_ == FrameLikeness::kUnknown ? 0 : std::max(0.0, received_last_ - received_now_);
  for (const int tile : refined.region.tiles()) sum += future_cost(refined, tile, target);
  return sum;
}

std::vector<TileReport> CostEstimator::report(const RegionQuality& refined) {
  learn_cost_per_triangle(refined);
  std::vector<TileReport> reports;
  const double received =
      received_now_ / static_cast<double>(std::max<std::size_t>(1, refined.region.tiles().size()));
  for (const int tile : refined.region.tiles()) {
    const TileWeights& weights = refined.tile(tile);
    TileEstimate& estimate = now_[static_cast<std::size_t>(tile)];
    estimate.cost = cost_of(refined, tile);
    if (weights.count > 0) estimate.average_weight = mean_weight(weights);
    reports.push_back({.tile = tile,
                       .triangles = static_cast<std::int32_t>(weights.count),
                       .total_weight = weights.total_weight,
                       .cost = estimate.cost,
                       .preparation = received + mixed_cost(refined, tile)});
  }
  return reports;
}

}  // namespace pprt
