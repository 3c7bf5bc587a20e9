#include "parallel/rank/tile_ownership.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

namespace pprt {
namespace {

std::vector<OwnerChange> changes_of(const std::vector<TileTransfer>& transfers) {
  std::vector<OwnerChange> changes;
  changes.reserve(transfers.size());
  for (const TileTransfer& transfer : transfers) changes.push_back(transfer.change());
  return changes;
}

}  // namespace

TileOwnership::TileOwnership(const SessionSettings& settings, int rank, int ranks, RankSampling& sampler,
                             CostEstimator& costs, TransferHandshake& handshake, FrameClock& clock,
                             StageTimer& timer)
    : settings_(settings),
      rank_(rank),
      sampler_(sampler),
      costs_(costs),
      handshake_(handshake),
      clock_(clock),
      timer_(timer),
      balancer_(rank, ranks, costs) {}

void TileOwnership::begin_frame() {
  given_.clear();
  choices_.clear();
  partition_bytes_ = 0;
  balancer_.begin_frame(clock_.pace());
}

bool TileOwnership::balances_locally() const {
  const bool is_alone = sampler_.exchange().partition().ranks == 1;
  return !is_alone &&
         (settings_.balance == BalanceMode::kLocal || settings_.balance == BalanceMode::kCombined);
}

bool TileOwnership::may_give(bool fresh_mesh) const {
  // Where a number of samples is the goal each rank takes the share of its area, which stays as it is.
  if (!balances_locally() || settings_.stop.samples > 0) return false;
  if (settings_.frames_per_second == 0 && !sampler_.traits().balances_without_rate) return false;
  const double elapsed = clock_.sampling_share();
  const std::uint64_t samples = sampler_.in_region();
  // Under a resting camera a region with more samples than pixels is fine enough, and its samples are too
  // many to hand over.
  if (!fresh_mesh && samples > sampler_.region().pixel_count()) return false;
  // Where most samples were cast each tile has so many from the start that only the first transfers bring
  // more than they cost. A repartition costs hardly anything there, for the samples move anyhow.
  const bool mostly_cast =
      fresh_mesh && sampler_.traits().cast_use == CastUse::kSamples && 2 * sampler_.counts().cast > samples;
  if (mostly_cast && (settings_.balance == BalanceMode::kCombined || elapsed > 0.25)) return false;
  return balancer_.is_early_enough(elapsed);
}

std::vector<TileTransfer> TileOwnership::give_tiles(bool fresh_mesh, int round) {
  if (!may_give(fresh_mesh)) return {};
  const StageTimer::Balancing timed(timer_);
  const SampleExchange& exchange = sampler_.exchange();
  const RegionQuality refined = sampler_.sampler().quality();
  // What the taker must take in may cost it a tenth of the frame.
  const double most_samples = settings_.frames_per_second > 0
                                  ? static_cast<double>(clock_.affordable(Work::kReceivedSample, 0.1))
                                  : std::numeric_limits<double>::infinity();
  const double elapsed = clock_.sampling_share();
  handshake_.set_giving(
      balancer_.wants_to_give(refined, exchange.neighbours(), elapsed, handshake_.is_giving()));
  const std::vector<TileTransfer> transfers =
      balancer_.choose_transfers(refined,
                                 {.partition = exchange.partition(),
                                  .ranks_beside = exchange.neighbours(),
                                  .known_in_tiles = [&](int rank) { return exchange.known_in_tiles(rank); }},
                                 handshake_, elapsed, most_samples);
  if (settings_.report_transfers && !transfers.empty()) {
    TransferChoice& choice = choices_.emplace_back(TransferChoice{.giver = rank_, .round = round});
    for (const TileTransfer& transfer : transfers) choice.given.push_back({transfer.tile, transfer.owner});
  }
  for (auto first = transfers.begin(); first != transfers.end();) {
    const int taker = first->owner;
    std::vector<int> tiles;
    for (; first != transfers.end() && first->owner == taker; ++first) tiles.push_back(first->tile);
    sampler_.introduce(tiles, taker);
    handshake_.transfer_sent(taker);
    given_.insert(given_.end(), tiles.begin(), tiles.end());
  }
  apply_changes(changes_of(transfers));
  return transfers;
}

std::vector<OwnerChange> TileOwnership::take_gains() {
  constexpr double kLateEnough = 0.9;  // of the sampling time; tiles are given before
  if (settings_.frames_per_second == 0 || clock_.sampling_share() < kLateEnough) return {};
  const Partition& partition = sampler_.exchange().partition();
  std::vector<OwnerChange> gains;
  for (const std::int32_t tile : std::exchange(gained_, {})) {
    const auto t = static_cast<std::size_t>(tile);
    if (partition.owner[t] == rank_) gains.push_back({tile, rank_, partition.version[t]});
  }
  return gains;
}

RankProgress TileOwnership::progress() {
  if (!balances_locally()) return {};
  const StageTimer::Balancing timed(timer_);
  const double elapsed = clock_.sampling_share();
  const RegionQuality refined = sampler_.sampler().quality();
  costs_.update(refined, elapsed);
  return balancer_.progress(refined, elapsed);
}

void TileOwnership::apply(const TileNews& news) {
  if (news.empty()) return;
  const StageTimer::Balancing timed(timer_);
  std::vector<OwnerChange> changes = changes_of(news.given);
  changes.insert(changes.end(), news.changes.begin(), news.changes.end());
  const std::vector<OwnerChange> made = apply_changes(changes);
  // Bundles of frames before are looked at more than once: only the first time gains a tile.
  for (const TileTransfer& transfer : news.given) {
    const bool is_gained =
        transfer.owner == rank_ && std::any_of(made.begin(), made.end(), [&](const OwnerChange& change) {
          return change.tile == transfer.tile && change.version == transfer.version;
        });
    if (!is_gained) continue;
    costs_.accept(transfer);
    gained_.push_back(transfer.tile);
  }
}

std::vector<OwnerChange> TileOwnership::apply_changes(std::span<const OwnerChange> changes) {
  Partition next = sampler_.exchange().partition();
  std::vector<OwnerChange> made;
  for (const OwnerChange& change : changes) {
    const auto tile = static_cast<std::size_t>(change.tile);
    if (tile >= next.owner.size() || change.owner < 0 || change.owner >= next.ranks) {
      throw ProtocolError("a tile was given that is none, or to nobody");
    }
    if (change.version <= next.version[tile]) continue;
    made.push_back(change);
    next.owner[tile] = change.owner;
    next.version[tile] = change.version;
  }
  if (!made.empty()) sampler_.transfer(next);
  return made;
}

void TileOwnership::forward_lost_tiles(std::span<const TileTransfer> given) {
  const std::vector<std::int32_t>& owners = sampler_.exchange().partition().owner;
  for (const TileTransfer& transfer : given) {
    if (transfer.owner != rank_ || owners[static_cast<std::size_t>(transfer.tile)] == rank_) continue;
    const StageTimer::Balancing timed(timer_);
    sampler_.forward_tile(transfer.tile);
  }
}

void TileOwnership::repartition(const FrameOrder& order, bool keep_samples) {
  const StageTimer::Balancing timed(timer_);
  Partition next = sampler_.exchange().partition();
  if (order.owners.size() != next.owner.size()) throw ProtocolError("a partition of another image");
  next.owner = order.owners;
  std::fill(next.version.begin(), next.version.end(), first_version(order.generation));
  for (int rank = 0; keep_samples && rank < next.ranks; ++rank) {
    std::vector<int> moved;
    for (const int tile : sampler_.region().tiles()) {
      if (rank != rank_ && next.owner[static_cast<std::size_t>(tile)] == rank) moved.push_back(tile);
    }
    if (!moved.empty()) sampler_.introduce(moved, rank);
  }
  std::size_t own = 0;
  for (std::size_t tile = 0; tile < next.owner.size() && own < order.tiles.size(); ++tile) {
    if (next.owner[tile] != rank_) continue;
    const TileEstimate& found = order.tiles[own++];
    const auto t = static_cast<int>(tile);
    if (!sampler_.region().owns_tile(t)) costs_.expect(t, found);
  }
  partition_bytes_ += order.partition_bytes;
  gained_.clear();
  sampler_.repartition(next);
}

Carry TileOwnership::carry_into(const FrameOrder& order) const {
  return !order.owners.empty() && !settings_.keep_samples ? Carry::kNothing : order.carry;
}

void TileOwnership::leave_out(const FrameOrder& order) {
  if (!order.owners.empty()) repartition(order, false);
  const Carry carry = carry_into(order);
  if (carry == Carry::kAccumulate) return;
  missed_ = {.picture = true, .begun_in = order.index, .cut = missed_.cut || carry == Carry::kNothing};
}

MissedFrames TileOwnership::take_missed() {
  return std::exchange(missed_, {});
}

}  // namespace pprt
