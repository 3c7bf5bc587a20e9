#include "unit/parallel/balance/ownership_model.h"

#include <algorithm>
#include <utility>

#include "parallel/balance/local_balance.h"

namespace pprt {
namespace {

using Kind = OwnershipStep::Kind;

bool same(const TileTransfer& a, const TileTransfer& b) {
  return a.tile == b.tile && a.owner == b.owner && a.version == b.version;
}

bool same(const OwnershipMessage& a, const OwnershipMessage& b) {
  return a.frame == b.frame && a.handshake == b.handshake &&
         std::equal(a.transfers.begin(), a.transfers.end(), b.transfers.begin(), b.transfers.end(),
                    [](const TileTransfer& x, const TileTransfer& y) { return same(x, y); });
}

bool same(const OwnershipRank& a, const OwnershipRank& b) {
  return a.partition.owner == b.partition.owner && a.partition.version == b.partition.version &&
         a.handshake == b.handshake && a.frame == b.frame;
}

bool are_beside(const TileGrid& grid, int a, int b) {
  const int columns = grid.columns();
  return std::abs(a % columns - b % columns) + std::abs(a / columns - b / columns) == 1;
}

}  // namespace

bool operator==(const OwnershipState& a, const OwnershipState& b) {
  const auto same_messages = [](const auto& x, const auto& y) {
    return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                      [](const OwnershipMessage& p, const OwnershipMessage& q) { return same(p, q); });
  };
  return a.repartitions == b.repartitions && a.left == b.left &&
         std::equal(a.ranks.begin(), a.ranks.end(), b.ranks.begin(), b.ranks.end(),
                    [](const OwnershipRank& x, const OwnershipRank& y) { return same(x, y); }) &&
         std::equal(a.under_way.begin(), a.under_way.end(), b.under_way.begin(), b.under_way.end(),
                    same_messages);
}

// Of what can be seen; operator== looks at the rest, too.
std::size_t OwnershipStateHash::operator()(const OwnershipState& state) const {
  std::uint64_t hash = 14695981039346656037u;
  const auto mix = [&hash](std::uint64_t value) {
    hash = (hash ^ value) * 1099511628211u, hash ^= hash >> 29;
  };
  mix(static_cast<std::uint64_t>(state.repartitions * 4096 + state.left.decisions * 256 +
                                 state.left.unasked * 16 + state.left.transfers));
  for (std::size_t k = 0; k < state.ranks.size(); ++k) {
    const OwnershipRank& rank = state.ranks[k];
    for (const std::int32_t owner : rank.partition.owner) mix(static_cast<std::uint64_t>(owner));
    for (const std::uint64_t version : rank.partition.version) mix(version);
    mix(static_cast<std::uint64_t>(rank.frame));
    mix(rank.handshake.may_transfer());
    TransferHandshake copy = rank.handshake;
    for (int other = 0; other < static_cast<int>(state.ranks.size()); ++other) {
      mix(rank.handshake.has_pending_reply(other) * 4u + rank.handshake.accepts(other) * 2u +
          rank.handshake.has_confirmed_transfers(other));
      const HandshakeState state_sent = copy.send(other);
      mix(state_sent.phase), mix(state_sent.acknowledged), mix(state_sent.transfers_received);
    }
  }
  for (const auto& messages : state.under_way) {
    mix(messages.size());
    for (const OwnershipMessage& message : messages) {
      mix(message.handshake.phase), mix(message.handshake.acknowledged),
          mix(message.handshake.transfers_received);
      for (const TileTransfer& transfer : message.transfers)
        mix(transfer.version), mix(static_cast<std::uint64_t>(transfer.tile));
    }
  }
  return static_cast<std::size_t>(hash);
}

OwnershipModel::OwnershipModel(const Partition& first, std::vector<Partition> repartitions,
                               const OwnershipLimits& limits, const OwnershipRules& rules)
    : first_(first), repartitions_(std::move(repartitions)), limits_(limits), rules_(rules) {
  for (std::size_t i = 0; i < repartitions_.size(); ++i) {
    const auto generation = rules_.repartitions_raise_version ? static_cast<std::uint32_t>(i + 1) : 0;
    std::fill(repartitions_[i].version.begin(), repartitions_[i].version.end(), first_version(generation));
  }
}

OwnershipState OwnershipModel::start() const {
  OwnershipState state;
  for (int rank = 0; rank < rank_count(); ++rank) {
    state.ranks.push_back({first_, TransferHandshake(rank_count()), 0});
  }
  state.under_way.resize(static_cast<std::size_t>(rank_count() * rank_count()));
  state.left = limits_;
  return state;
}

std::vector<OwnershipMessage>& OwnershipModel::messages(OwnershipState& state, int from, int to) const {
  return state.under_way[static_cast<std::size_t>(from * rank_count() + to)];
}

const std::vector<OwnershipMessage>& OwnershipModel::messages(const OwnershipState& state, int from,
                                                              int to) const {
  return state.under_way[static_cast<std::size_t>(from * rank_count() + to)];
}

// --- What can happen ---

std::vector<OwnershipStep> OwnershipModel::steps(const OwnershipState& state) const {
  std::vector<OwnershipStep> steps;
  if (state.repartitions < static_cast<int>(repartitions_.size()))
    steps.push_back({.kind = Kind::kOrderRepartition});
  for (int rank = 0; rank < rank_count(); ++rank) {
    const OwnershipRank& r = state.ranks[static_cast<std::size_t>(rank)];
    if (state.left.decisions > 0) steps.push_back({.kind = Kind::kChangeSide, .rank = rank});
    if (r.frame < state.repartitions) steps.push_back({.kind = Kind::kReceiveRepartition, .rank = rank});
    for (int other = 0; other < rank_count(); ++other) {
      if (other == rank) continue;
      const bool owed = rules_.acknowledges && r.handshake.has_pending_reply(other);
      if (owed || state.left.unasked > 0)
        steps.push_back({.kind = Kind::kSend, .rank = rank, .other = other});
      const auto& coming = messages(state, other, rank);
      for (std::size_t i = 0; i < coming.size(); ++i) {
        if (i > 0 && rules_.messages_keep_order) break;
        if (can_deliver(state, rank, coming[i]))
          steps.push_back({.kind = Kind::kDeliver, .rank = rank, .other = other, .position = i});
      }
      if (!may_give(state, rank, other)) continue;
      for (int tile = 0; tile < first_.grid.tile_count(); ++tile) {
        if (can_spare(state, rank, other, tile))
          steps.push_back({.kind = Kind::kTransfer, .rank = rank, .other = other, .tiles = {tile}});
      }
    }
  }
  return steps;
}

bool OwnershipModel::may_give(const OwnershipState& state, int giver, int taker) const {
  const TransferHandshake& handshake = state.ranks[static_cast<std::size_t>(giver)].handshake;
  const bool gives = rules_.waits_for_acknowledgement ? handshake.may_transfer() : handshake.is_giving();
  return state.left.transfers > 0 && gives && handshake.accepts(taker) &&
         handshake.has_confirmed_transfers(taker);
}

bool OwnershipModel::can_deliver(const OwnershipState& state, int to, const OwnershipMessage& message) const {
  return message.frame <= state.ranks[static_cast<std::size_t>(to)].frame || !rules_.messages_wait_for_frame;
}

// Beside the taker's, and what is left of the giver's hangs together: as the giver sees it.
bool OwnershipModel::can_spare(const OwnershipState& state, int giver, int taker, int tile) const {
  Partition partition = state.ranks[static_cast<std::size_t>(giver)].partition;
  const std::int32_t owner = partition.owner[static_cast<std::size_t>(tile)];
  if (owner == taker || (owner != giver && rules_.only_owners_give)) return false;
  bool beside = false;
  for (int other = 0; other < partition.grid.tile_count(); ++other) {
    beside = beside || (partition.owner[static_cast<std::size_t>(other)] == taker &&
                        are_beside(partition.grid, tile, other));
  }
  if (!beside) return false;
  partition.owner[static_cast<std::size_t>(tile)] = taker;
  return (is_connected(partition, giver) || !rules_.keeps_regions_whole) &&
         std::count(partition.owner.begin(), partition.owner.end(), giver) > 0;
}

std::vector<int> OwnershipModel::graded_tiles(const OwnershipState& state, int giver, int taker) const {
  return tiles_to_give({}, state.ranks[static_cast<std::size_t>(giver)].partition, giver, taker,
                       {.difference = 10, .insertion_cost = 0, .most_samples = 1e9},
                       [](int) { return TileOffer{.future_cost = 1, .samples = 1}; });
}

// --- What it does ---

std::optional<std::string> OwnershipModel::take(OwnershipState& state, const OwnershipStep& step) const {
  OwnershipRank& rank = state.ranks[static_cast<std::size_t>(step.rank)];
  switch (step.kind) {
    case Kind::kChangeSide:
      rank.handshake.set_giving(!rank.handshake.is_giving());
      --state.left.decisions;
      break;
    case Kind::kSend:
      if (!rank.handshake.has_pending_reply(step.other)) --state.left.unasked;
      send(state, step.rank, step.other, {});
      break;
    case Kind::kTransfer:
      return give(state, step);
    case Kind::kDeliver:
      deliver(state, step.rank, step.other, step.position);
      break;
    case Kind::kOrderRepartition:
      ++state.repartitions;
      break;
    case Kind::kReceiveRepartition:
      receive_repartition(state, step.rank);
      break;
  }
  return std::nullopt;
}

void OwnershipModel::send(OwnershipState& state, int from, int to,
                          const std::vector<TileTransfer>& transfers) const {
  OwnershipRank& rank = state.ranks[static_cast<std::size_t>(from)];
  messages(state, from, to).push_back({rank.frame, rank.handshake.send(to), transfers});
}

// Sends the transfers to all ranks, as Worker::send_bundles does.
std::optional<std::string> OwnershipModel::give(OwnershipState& state, const OwnershipStep& step) const {
  OwnershipRank& giver = state.ranks[static_cast<std::size_t>(step.rank)];
  std::optional<std::string> wrong;
  for (int from = 0; from < rank_count(); ++from) {
    for (const OwnershipMessage& message : messages(state, from, step.rank)) {
      for (const TileTransfer& transfer : message.transfers) {
        if (transfer.owner == step.rank &&
            transfer.version >= giver.partition.version[static_cast<std::size_t>(transfer.tile)])
          wrong = "a rank gives while a tile is on its way to it";
      }
    }
  }
  std::vector<TileTransfer> transfers;
  for (const int tile : step.tiles) {
    const auto t = static_cast<std::size_t>(tile);
    giver.partition.version[t] += rules_.transfers_raise_version;
    giver.partition.owner[t] = step.other;
    transfers.push_back({.tile = tile, .owner = step.other, .version = giver.partition.version[t]});
  }
  giver.handshake.transfer_sent(step.other);
  --state.left.transfers;
  for (int to = 0; to < rank_count(); ++to) {
    if (to != step.rank) send(state, step.rank, to, transfers);
  }
  return wrong;
}

void OwnershipModel::deliver(OwnershipState& state, int to, int from, std::size_t position) const {
  auto& coming = messages(state, from, to);
  const OwnershipMessage message = std::move(coming[position]);
  coming.erase(coming.begin() + static_cast<std::ptrdiff_t>(position));
  OwnershipRank& rank = state.ranks[static_cast<std::size_t>(to)];
  rank.handshake.receive(from, message.handshake);
  bool is_taker = false;
  for (const TileTransfer& transfer : message.transfers) {
    const auto t = static_cast<std::size_t>(transfer.tile);
    is_taker = is_taker || transfer.owner == to;
    if (transfer.version <= rank.partition.version[t]) continue;
    rank.partition.owner[t] = transfer.owner;
    rank.partition.version[t] = transfer.version;
  }
  if (is_taker) rank.handshake.transfer_received(from);
}

void OwnershipModel::receive_repartition(OwnershipState& state, int rank) const {
  OwnershipRank& r = state.ranks[static_cast<std::size_t>(rank)];
  r.partition = repartitions_[static_cast<std::size_t>(r.frame++)];
}

// --- What must hold ---

// What any rank knows of a tile, or is about to receive.
std::vector<TileTransfer> OwnershipModel::claims(const OwnershipState& state, int tile) const {
  const auto t = static_cast<std::size_t>(tile);
  std::vector<TileTransfer> claims;
  for (const OwnershipRank& r : state.ranks) {
    claims.push_back({.tile = tile, .owner = r.partition.owner[t], .version = r.partition.version[t]});
  }
  for (const auto& messages : state.under_way) {
    for (const OwnershipMessage& message : messages) {
      for (const TileTransfer& transfer : message.transfers) {
        if (transfer.tile == tile) claims.push_back(transfer);
      }
    }
  }
  for (int repartition = 0; repartition < state.repartitions; ++repartition) {
    const Partition& partition = repartitions_[static_cast<std::size_t>(repartition)];
    claims.push_back({.tile = tile, .owner = partition.owner[t], .version = partition.version[t]});
  }
  return claims;
}

// Or will know: the transfer is on its way to the owner.
bool OwnershipModel::owner_knows(const OwnershipState& state, const TileTransfer& truth) const {
  const OwnershipRank& owner = state.ranks[static_cast<std::size_t>(truth.owner)];
  const auto t = static_cast<std::size_t>(truth.tile);
  if (owner.partition.version[t] == truth.version && owner.partition.owner[t] == truth.owner) return true;
  if (owner.frame < state.repartitions) return true;
  for (int from = 0; from < rank_count(); ++from) {
    for (const OwnershipMessage& message : messages(state, from, truth.owner)) {
      if (std::any_of(message.transfers.begin(), message.transfers.end(),
                      [&](const TileTransfer& transfer) { return same(transfer, truth); }))
        return true;
    }
  }
  return false;
}

std::optional<std::string> OwnershipModel::fault(const OwnershipState& state) const {
  Partition truth = first_;
  for (int tile = 0; tile < first_.grid.tile_count(); ++tile) {
    const auto t = static_cast<std::size_t>(tile);
    TileTransfer highest{.tile = tile};
    const std::vector<TileTransfer> all = claims(state, tile);
    for (const TileTransfer& a : all) {
      for (const TileTransfer& b : all) {
        if (a.version == b.version && a.owner != b.owner) return "two owners by the same version";
      }
      if (a.version >= highest.version) highest = a;
    }
    if (!owner_knows(state, highest)) return "a tile's owner will never hear of it";
    truth.owner[t] = highest.owner;
    for (int a = 0; a < rank_count(); ++a) {
      for (int b = 0; b < a; ++b) {
        const OwnershipRank &x = state.ranks[static_cast<std::size_t>(a)],
                            &y = state.ranks[static_cast<std::size_t>(b)];
        if (x.frame == y.frame && x.partition.owner[t] == a && y.partition.owner[t] == b)
          return "two ranks render the same tile";
      }
    }
  }
  for (int rank = 0; rank < rank_count(); ++rank) {
    if (!is_connected(truth, rank)) return "a region has fallen apart";
  }
  const bool quiet = std::all_of(state.under_way.begin(), state.under_way.end(),
                                 [](const auto& messages) { return messages.empty(); });
  for (const OwnershipRank& r : state.ranks) {
    if (quiet && r.frame == state.repartitions && state.ranks.front().frame == state.repartitions &&
        (r.partition.owner != state.ranks.front().partition.owner))
      return "ranks that have heard everything disagree";
  }
  return std::nullopt;
}

// Delivers all messages, and sends all pending replies.
void OwnershipModel::quieten(OwnershipState& state) const {
  for (bool quiet = false; !quiet;) {
    quiet = true;
    for (int rank = 0; rank < rank_count(); ++rank) {
      OwnershipRank& r = state.ranks[static_cast<std::size_t>(rank)];
      while (r.frame < state.repartitions) receive_repartition(state, rank);
      for (int other = 0; other < rank_count(); ++other) {
        if (other == rank) continue;
        for (; !messages(state, other, rank).empty(); quiet = false) deliver(state, rank, other, 0);
        if (!rules_.acknowledges || !r.handshake.has_pending_reply(other)) continue;
        send(state, rank, other, {});
        quiet = false;
      }
    }
  }
}

bool OwnershipModel::all_can_come_to_give(OwnershipState& state) const {
  quieten(state);
  for (int giver = 0; giver < rank_count(); ++giver) {
    for (int rank = 0; rank < rank_count(); ++rank) {
      state.ranks[static_cast<std::size_t>(rank)].handshake.set_giving(rank == giver);
      if (rank != giver) send(state, rank, giver, {});
    }
    quieten(state);
    const TransferHandshake& handshake = state.ranks[static_cast<std::size_t>(giver)].handshake;
    if (!handshake.may_transfer()) return false;
    for (int rank = 0; rank < rank_count(); ++rank) {
      if (rank != giver && (!handshake.accepts(rank) || !handshake.has_confirmed_transfers(rank)))
        return false;
    }
  }
  return true;
}

}  // namespace pprt
