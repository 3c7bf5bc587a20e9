#include "parallel/balance/balancer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "parallel/clock/work_units.h"

namespace pprt {

Balancer::Balancer(int rank, int ranks, const CostEstimator& costs)
    : rank_(rank), costs_(costs), theirs_(static_cast<std::size_t>(ranks)) {}

void Balancer::begin_frame(double pace) {
  pace_ = pace;
  std::fill(theirs_.begin(), theirs_.end(), RankProgress());
}

RankProgress Balancer::progress(const RegionQuality& refined, double elapsed) const {
  const double quality = refined.mean_weight;
  if (quality <= 0) return {};
  // The mean weight falls as the reciprocal of the samples: what it will be when the frame ends.
  const double target = target_quality(quality * elapsed);
  return {
      .quality = quality, .target = target, .future_cost = own_future_cost(refined, target), .pace = pace_};
}

// In time.
double Balancer::own_future_cost(const RegionQuality& refined, double quality) const {
  return pace_ * costs_.future_cost_of_region(refined, quality);
}

// How much more this rank has to pay than its neighbours for what they aim at: the geometric mean of the
// ratios; 1 where no neighbour has reported.
double Balancer::load_by_neighbours(const RegionQuality& refined, const std::vector<int>& neighbours) const {
  constexpr double kOneSample = 1300;  // time at pace 1; costs below are all the same
  double sum = 0;
  int count = 0;
  for (const int rank : neighbours) {
    const RankProgress& theirs = theirs_[static_cast<std::size_t>(rank)];
    if (theirs.quality <= 0) continue;
    const double own = own_future_cost(refined, theirs.target);
    sum += std::log(std::max(own, kOneSample) / std::max(theirs.future_cost, kOneSample));
    ++count;
  }
  return count > 0 ? std::exp(sum / count) : 1;
}

bool Balancer::wants_to_give(const RegionQuality& refined, const std::vector<int>& neighbours, double elapsed,
                             bool is_giving) const {
  const double ratio = settings_.giving_ratio + settings_.giving_noise * relative_noise(refined, elapsed);
  return load_by_neighbours(refined, neighbours) > (is_giving ? 1 : ratio);
}

// The neighbours that this rank should give to, the one that is farthest ahead first.
std::vector<int> Balancer::takers(const RegionQuality& refined, const std::vector<int>& neighbours,
                                  double elapsed, const TransferHandshake& handshake) const {
  const double quality = refined.mean_weight, noise = relative_noise(refined, elapsed);
  std::vector<std::pair<double, int>> ahead;
  for (const int rank : neighbours) {
    const RankProgress& theirs = theirs_[static_cast<std::size_t>(rank)];
    if (!handshake.accepts(rank) || !handshake.has_confirmed_transfers(rank) || theirs.quality <= 0) continue;
    const double own_cost = own_future_cost(refined, theirs.target);
    if (!should_give(settings_, quality, own_cost, noise, theirs)) continue;
    ahead.emplace_back(theirs.future_cost / own_cost, rank);
  }
  std::sort(ahead.begin(), ahead.end());
  std::vector<int> ranks;
  ranks.reserve(ahead.size());
  for (const auto& [ratio, rank] : ahead) ranks.push_back(rank);
  return ranks;
}

std::vector<int> Balancer::tiles_for(const RegionQuality& refined, const RegionSamples& samples,
                                     const Partition& partition, int taker, double most_samples) const {
  const RankProgress& theirs = theirs_[static_cast<std::size_t>(taker)];
  const std::vector<std::uint32_t> known = samples.known_in_tiles(taker);
  const std::vector<std::uint32_t> all = samples.known_in_tiles(rank_);
  const double mean_pace = 0.5 * (pace_ + theirs.pace);
  const auto offer = [&](int tile) {
    const auto t = static_cast<std::size_t>(tile);
    return TileOffer{.future_cost = mean_pace * costs_.future_cost(refined, tile, theirs.target),
                     .samples = static_cast<double>(all[t]),
                     .known_to_taker = static_cast<double>(known[t])};
  };
  const TransferBounds bounds{
      .difference = own_future_cost(refined, theirs.target) - theirs.future_cost,
      .insertion_cost = theirs.pace * static_cast<double>(price(Work::kReceivedSample)),
      .most_samples = most_samples};
  return tiles_to_give(settings_, partition, rank_, taker, bounds, offer);
}

std::vector<TileTransfer> Balancer::choose_transfers(const RegionQuality& refined,
                                                     const RegionSamples& samples,
                                                     const TransferHandshake& handshake, double elapsed,
                                                     double most_samples) const {
  std::vector<TileTransfer> transfers;
  if (!handshake.may_transfer()) return transfers;
  Partition partition = samples.partition();
  for (const int taker : takers(refined, samples.neighbours(), elapsed, handshake)) {
    // None where the taker touches this region at a corner only, or where every tile is too big a transfer.
    for (const int tile : tiles_for(refined, samples, partition, taker, most_samples)) {
      const auto t = static_cast<std::size_t>(tile);
      transfers.push_back({.tile = tile,
                           .owner = taker,
                           .version = partition.version[t] + 1,
                           .now = costs_.now(tile),
                           .last = costs_.last(tile)});
      partition.owner[t] = taker;
    }
  }
  return transfers;
}

}  // namespace pprt
