#include "parallel/balance/balancer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "parallel/clock/work_units.h"

namespace pprt {
namespace {

// Costs below that of a sample are all the same.
constexpr double kOneSample = 1300;

}  // namespace

Balancer::Balancer(int rank, int ranks, int tile_count)
    : rank_(rank),
      now_(static_cast<std::size_t>(tile_count)),
      last_(static_cast<std::size_t>(tile_count)),
      theirs_(static_cast<std::size_t>(ranks)) {}

void Balancer::begin_frame(bool fresh_mesh, Known known_before) {
  std::fill(theirs_.begin(), theirs_.end(), RankProgress());
  known_before_ = known_before;
  share_of_now_ = known_before == Known::kNothing ? 1 : 0;
  received_last_ = std::exchange(received_now_, 0);
  if (!fresh_mesh) return;
  last_ = now_;
  std::fill(now_.begin(), now_.end(), TileEstimate());
}

void Balancer::take(const TileTransfer& transfer) {
  now_[static_cast<std::size_t>(transfer.tile)] = transfer.now;
  last_[static_cast<std::size_t>(transfer.tile)] = transfer.last;
}

RankProgress Balancer::progress(const SampleMesh& mesh, double elapsed) {
  share_of_now_ = known_before_ == Known::kNothing ? 1 : known_before_ == Known::kAll ? 0 : elapsed;
  const double quality = mesh.refinement();
  if (quality <= 0) return {};
  learn_cost_per_triangle(mesh);
  // The mean weight falls as the reciprocal of the samples: what it will be when the frame ends.
  const double target = target_quality(quality * elapsed);
  return {quality, target, future_cost_of_region(mesh, target)};
}

void Balancer::learn_cost_per_triangle(const SampleMesh& mesh) {
  double cost = 0, triangles = 0;
  for (const int tile : mesh.region().tiles()) {
    cost += now_[static_cast<std::size_t>(tile)].cost;
    triangles += mesh.tile_weights()[static_cast<std::size_t>(tile)].triangles;
  }
  cost_per_triangle_ = triangles > 0 ? cost / triangles : 0;
}

// What a tile's refinement so far has cost. One with hardly a sample, though with triangles that wait for
// one, would else seem to cost nothing to refine; few samples fall into a small tile. The region's mean is
// the least.
double Balancer::cost_of(const SampleMesh& mesh, int tile) const {
  const auto t = static_cast<std::size_t>(tile);
  return std::max(now_[t].cost, static_cast<double>(mesh.tile_weights()[t].triangles) * cost_per_triangle_);
}

// What the tile was in the frame before gives way to what it is in this one as the frame goes on.
double Balancer::future_cost_of(const SampleMesh& mesh, int tile, double quality) const {
  const auto t = static_cast<std::size_t>(tile);
  const TileWeights& weights = mesh.tile_weights()[t];
  const double mean =
      weights.triangles > 0 ? weights.total_weight / static_cast<double>(weights.triangles) : 0;
  const double paid = now_[t].cost;
  const double cost_at_1 = (1 - share_of_now_) * last_[t].cost * last_[t].average_weight +
                           share_of_now_ * cost_of(mesh, tile) * mean;
  const double pixels = static_cast<double>(mesh.region().grid().pixels(tile).area());
  return cost_at_1 / quality - paid + pixels * static_cast<double>(price(Work::kPixel));
}

double Balancer::future_cost_of_region(const SampleMesh& mesh, double quality) const {
  const double still_to_come =
      known_before_ == Known::kNothing ? 0 : std::max(0.0, received_last_ - received_now_);
  double sum = still_to_come;
  for (const int tile : mesh.region().tiles()) sum += future_cost_of(mesh, tile, quality);
  return sum;
}

// How much more this rank has to pay than its neighbours for what they aim at: the geometric mean of the
// ratios; 1 where nothing was heard.
double Balancer::load_by_neighbours(const SampleMesh& mesh, const std::vector<int>& neighbours) const {
  double sum = 0;
  int heard = 0;
  for (const int rank : neighbours) {
    const RankProgress& theirs = theirs_[static_cast<std::size_t>(rank)];
    if (theirs.quality <= 0) continue;
    const double own = future_cost_of_region(mesh, theirs.target);
    sum += std::log(std::max(own, kOneSample) / std::max(theirs.future_cost, kOneSample));
    ++heard;
  }
  return heard > 0 ? std::exp(sum / heard) : 1;
}

bool Balancer::wants_to_give(const SampleMesh& mesh, const std::vector<int>& neighbours,
                             bool is_giving) const {
  return load_by_neighbours(mesh, neighbours) > (is_giving ? 1 : settings_.giving_ratio);
}

// The neighbours that take and that this rank should give to, the one that is farthest ahead first.
std::vector<int> Balancer::takers(const SampleMesh& mesh, const std::vector<int>& neighbours,
                                  const TransferHandshake& handshake) const {
  const double quality = mesh.refinement();
  std::vector<std::pair<double, int>> ahead;
  for (const int rank : neighbours) {
    const RankProgress& theirs = theirs_[static_cast<std::size_t>(rank)];
    if (!handshake.takes(rank) || !handshake.has_counted_gifts(rank) || theirs.quality <= 0) continue;
    const double own_cost = future_cost_of_region(mesh, theirs.target);
    if (!should_give(settings_, quality, own_cost, theirs)) continue;
    ahead.emplace_back(theirs.future_cost / own_cost, rank);
  }
  std::sort(ahead.begin(), ahead.end());
  std::vector<int> ranks;
  ranks.reserve(ahead.size());
  for (const auto& [ratio, rank] : ahead) ranks.push_back(rank);
  return ranks;
}

std::vector<int> Balancer::tiles_for(const SampleMesh& mesh, const SampleExchange& exchange,
                                     const Partition& partition, int taker, double most_samples) const {
  const RankProgress& theirs = theirs_[static_cast<std::size_t>(taker)];
  const std::vector<std::uint32_t> known = exchange.known_in_tiles(mesh, taker);
  const std::vector<std::uint32_t> all = exchange.known_in_tiles(mesh, rank_);
  const double difference = future_cost_of_region(mesh, theirs.target) - theirs.future_cost;
  const auto offer = [&](int tile) {
    const auto t = static_cast<std::size_t>(tile);
    return TileOffer{future_cost_of(mesh, tile, theirs.target), static_cast<double>(all[t]),
                     static_cast<double>(known[t])};
  };
  return tiles_to_give(settings_, partition, rank_, taker, difference,
                       static_cast<double>(price(Work::kReceivedSample)), most_samples, offer);
}

std::vector<TileTransfer> Balancer::give(const SampleMesh& mesh, SampleExchange& exchange,
                                         TransferHandshake& handshake, double most_samples) {
  std::vector<TileTransfer> transfers;
  if (!handshake.may_give()) return transfers;
  Partition partition = exchange.partition();
  for (const int taker : takers(mesh, exchange.neighbours(), handshake)) {
    const std::vector<int> tiles = tiles_for(mesh, exchange, partition, taker, most_samples);
    if (tiles.empty())
      continue;  // it touches this region at a corner only, or every tile is too big a transfer
    exchange.introduce(mesh, tiles, taker);
    for (const int tile : tiles) {
      const auto t = static_cast<std::size_t>(tile);
      transfers.push_back({tile, taker, partition.version[t] + 1, now_[t], last_[t]});
      partition.owner[t] = taker;
    }
    handshake.gave(taker);
  }
  return transfers;
}

std::vector<TileReport> Balancer::report(const SampleMesh& mesh) {
  learn_cost_per_triangle(mesh);
  std::vector<TileReport> reports;
  const double received =
      received_now_ / static_cast<double>(std::max<std::size_t>(1, mesh.region().tiles().size()));
  for (const int tile : mesh.region().tiles()) {
    const auto t = static_cast<std::size_t>(tile);
    const TileWeights& weights = mesh.tile_weights()[t];
    now_[t].cost = cost_of(mesh, tile);
    if (weights.triangles > 0)
      now_[t].average_weight = weights.total_weight / static_cast<double>(weights.triangles);
    const double pixels = static_cast<double>(mesh.region().grid().pixels(tile).area());
    reports.push_back({tile, static_cast<std::int32_t>(weights.triangles), weights.total_weight, now_[t].cost,
                       pixels * static_cast<double>(price(Work::kPixel)), received});
  }
  return reports;
}

}  // namespace pprt
