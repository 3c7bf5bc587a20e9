#include "parallel/balancer.h"

#include <algorithm>

#include "parallel/work_units.h"

namespace pprt {
namespace {

// Below the cost of so many samples a tile's estimate from this frame alone is too rough.
constexpr double kEnoughUnits = 20 * 1300;

}  // namespace

Balancer::Balancer(int rank, int ranks, int tile_count)
    : rank_(rank),
      now_(static_cast<std::size_t>(tile_count)),
      last_(static_cast<std::size_t>(tile_count)),
      theirs_(static_cast<std::size_t>(ranks)) {}

void Balancer::begin_frame(bool fresh_mesh) {
  std::fill(theirs_.begin(), theirs_.end(), RankProgress());
  if (!fresh_mesh) return;
  last_ = now_;
  std::fill(now_.begin(), now_.end(), TileEstimate());
}

void Balancer::take(const TileGrant& grant) {
  now_[static_cast<std::size_t>(grant.tile)] = grant.now;
  last_[static_cast<std::size_t>(grant.tile)] = grant.last;
}

RankProgress Balancer::progress(const SampleMesh& mesh) const {
  const double quality = mesh.refinement();
  if (quality <= 0) return {};
  const double target = target_quality(quality);
  return {quality, target, future_cost_of_region(mesh, target)};
}

double Balancer::future_cost_of(const SampleMesh& mesh, int tile, double quality) const {
  const auto t = static_cast<std::size_t>(tile);
  const TileWeights& weights = mesh.tile_weights()[t];
  const double paid = now_[t].cost;
  if (paid < kEnoughUnits && last_[t].cost > 0) return future_cost(last_[t], paid, quality);
  const double mean =
      weights.triangles > 0 ? weights.total_weight / static_cast<double>(weights.triangles) : 0;
  return future_cost({paid, mean}, paid, quality);
}

double Balancer::future_cost_of_region(const SampleMesh& mesh, double quality) const {
  double sum = 0;
  for (const int tile : mesh.region().tiles()) sum += future_cost_of(mesh, tile, quality);
  return sum;
}

// The neighbours that this rank should give to, the best first; none unless this rank's quality is worse than
// that of every neighbour heard of.
std::vector<int> Balancer::neighbours_ahead(const SampleMesh& mesh,
                                            const std::vector<int>& neighbours) const {
  const double quality = mesh.refinement();
  const auto theirs = [this](int rank) -> const RankProgress& {
    return theirs_[static_cast<std::size_t>(rank)];
  };
  std::vector<int> ahead;
  for (const int rank : neighbours) {
    if (theirs(rank).quality <= 0) continue;
    if (theirs(rank).quality > quality || (theirs(rank).quality == quality && rank < rank_)) return {};
    const double own_cost = future_cost_of_region(mesh, theirs(rank).target);
    if (should_give(settings_, quality, own_cost, theirs(rank))) ahead.push_back(rank);
  }
  std::sort(ahead.begin(), ahead.end(), [&](int a, int b) {
    return theirs(a).quality != theirs(b).quality ? theirs(a).quality < theirs(b).quality : a < b;
  });
  return ahead;
}

std::vector<int> Balancer::tiles_for(const SampleMesh& mesh, const SampleExchange& exchange, int taker,
                                     double most_samples) const {
  const RankProgress& theirs = theirs_[static_cast<std::size_t>(taker)];
  const std::vector<std::uint32_t> known = exchange.known_in_tiles(mesh, taker);
  const std::vector<std::uint32_t> all = exchange.known_in_tiles(mesh, rank_);
  const double difference = future_cost_of_region(mesh, theirs.target) - theirs.future_cost;
  const auto offer = [&](int tile) {
    const auto t = static_cast<std::size_t>(tile);
    return TileOffer{future_cost_of(mesh, tile, theirs.target), static_cast<double>(all[t]),
                     static_cast<double>(known[t])};
  };
  return tiles_to_give(settings_, exchange.partition(), rank_, taker, difference,
                       static_cast<double>(price(Work::kReceivedSample)), most_samples, offer);
}

std::vector<TileGrant> Balancer::give(const SampleMesh& mesh, SampleExchange& exchange, double most_samples) {
  std::vector<TileGrant> grants;
  // One taker at a time: after the first gift the estimates for the others no longer hold.
  for (const int taker : neighbours_ahead(mesh, exchange.neighbours())) {
    const std::vector<int> tiles = tiles_for(mesh, exchange, taker, most_samples);
    if (tiles.empty()) continue;  // it touches this region at a corner only, or every tile is too big a gift
    exchange.introduce(mesh, tiles, taker);
    for (const int tile : tiles) {
      const auto t = static_cast<std::size_t>(tile);
      grants.push_back({tile, taker, exchange.partition().version[t] + 1, now_[t], last_[t]});
    }
    // What was heard no longer holds: wait for the taker's next word.
    theirs_[static_cast<std::size_t>(taker)] = RankProgress();
    break;
  }
  return grants;
}

std::vector<TileReport> Balancer::report(const SampleMesh& mesh) {
  std::vector<TileReport> reports;
  for (const int tile : mesh.region().tiles()) {
    const auto t = static_cast<std::size_t>(tile);
    const TileWeights& weights = mesh.tile_weights()[t];
    if (weights.triangles > 0)
      now_[t].average_weight = weights.total_weight / static_cast<double>(weights.triangles);
    const double pixels = static_cast<double>(mesh.region().grid().pixels(tile).area());
    reports.push_back({tile, static_cast<std::int32_t>(weights.triangles), weights.total_weight, now_[t].cost,
                       pixels * static_cast<double>(price(Work::kPixel)), 0});
  }
  return reports;
}

}  // namespace pprt
