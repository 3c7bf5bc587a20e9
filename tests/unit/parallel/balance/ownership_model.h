// How tiles change hands, without pictures: ranks with the real Partition and TransferHandshake, the messages
// between them, and everything that can happen next. A test goes through the states one by one or at random.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "parallel/balance/partition.h"
#include "parallel/balance/transfer_handshake.h"
#include "parallel/protocol/tile_cost.h"

namespace pprt {

// The rules that the protocol stands on; a test breaks one to see that the model finds out.
struct OwnershipRules {
  bool waits_for_acknowledgement = true;  // who has changed to giving, before the first transfer
  bool transfers_raise_version = true;
  bool only_owners_give = true;
  bool repartitions_raise_version = true;
  bool messages_keep_order = true;      // from one rank to another
  bool messages_wait_for_frame = true;  // the receiver learns of a repartition before what was sent after it
  bool keeps_regions_whole = true;      // the giver its own
  bool acknowledges = true;             // a pending reply is sent
};

// How often something may still happen, on all ranks together.
struct OwnershipLimits {
  int decisions = 0;  // changes of handshake
  int unasked = 0;    // messages that nobody waits for
  int transfers = 0;

  friend bool operator==(const OwnershipLimits&, const OwnershipLimits&) = default;
};

struct OwnershipMessage {
  int frame = 0;  // number of repartitions that the sender had received
  HandshakeState handshake;
  std::vector<TileTransfer> transfers;
};

struct OwnershipRank {
  Partition partition;  // as it sees it
  TransferHandshake handshake;
  int frame = 0;  // number of repartitions that it has received
};

struct OwnershipState {
  std::vector<OwnershipRank> ranks;
  std::vector<std::vector<OwnershipMessage>> under_way;  // [from * ranks + to], the oldest first
  int repartitions = 0;                                  // ordered by the master
  OwnershipLimits left;

  friend bool operator==(const OwnershipState& a, const OwnershipState& b);
};

struct OwnershipStateHash {
  std::size_t operator()(const OwnershipState& state) const;
};

// One thing that can happen.
struct OwnershipStep {
  enum class Kind { kChangeSide, kSend, kTransfer, kDeliver, kOrderRepartition, kReceiveRepartition };
  Kind kind{};
  int rank = 0;                 // who does it, or gets the message
  int other = 0;                // to whom, or from whom
  std::vector<int> tiles = {};  // given
  std::size_t position = 0;     // of the message
};

class OwnershipModel {
 public:
  // `repartitions` are the partitions that the master orders, one after the other, if the run comes to it.
  // Regions must be connected.
  OwnershipModel(const Partition& first, std::vector<Partition> repartitions, const OwnershipLimits& limits,
                 const OwnershipRules& rules = {});

  OwnershipState start() const;

  // Everything that can happen next. Each transfer is of a single tile.
  std::vector<OwnershipStep> steps(const OwnershipState& state) const;

  // The tiles that the rank would give to the other by the grades of parallel/local_balance.
  std::vector<int> graded_tiles(const OwnershipState& state, int giver, int taker) const;

  // Whether the rules let it give to the other now.
  bool may_give(const OwnershipState& state, int giver, int taker) const;

  // Makes it happen. Tells what is wrong with it, if anything.
  std::optional<std::string> take(OwnershipState& state, const OwnershipStep& step) const;

  // What is wrong with a state.
  std::optional<std::string> fault(const OwnershipState& state) const;

  // Whether from here each rank in turn can come to give to all others. Changes the state.
  bool all_can_come_to_give(OwnershipState& state) const;

 private:
  int rank_count() const { return first_.ranks; }
  std::vector<OwnershipMessage>& messages(OwnershipState& state, int from, int to) const;
  const std::vector<OwnershipMessage>& messages(const OwnershipState& state, int from, int to) const;
  bool can_deliver(const OwnershipState& state, int to, const OwnershipMessage& message) const;
  bool can_spare(const OwnershipState& state, int giver, int taker, int tile) const;
  void send(OwnershipState& state, int from, int to, const std::vector<TileTransfer>& transfers) const;
  std::optional<std::string> give(OwnershipState& state, const OwnershipStep& step) const;
  void deliver(OwnershipState& state, int to, int from, std::size_t position) const;
  void receive_repartition(OwnershipState& state, int rank) const;
  void quieten(OwnershipState& state) const;
  std::vector<TileTransfer> claims(const OwnershipState& state, int tile) const;
  bool owner_knows(const OwnershipState& state, const TileTransfer& truth) const;

  Partition first_;
  std::vector<Partition> repartitions_;
  OwnershipLimits limits_;
  OwnershipRules rules_;
};

}  // namespace pprt
