// Agreement between ranks on who gives tiles and who accepts them, without a question and an answer before
// each transfer.
//
// Example: rank 0 accepts tiles at first and gives tiles later. Time runs downwards, an arrow is a bundle:
//
//   rank 0                                        rank 1
//   phase 0 (accepts), sends {0, 0, 0}        ->  accepts(0): it may send tiles to rank 0
//   set_giving(true): phase 1. may_transfer()     sends a tile, counts it: transfer_sent(0)
//   is false, for rank 1 may still send tiles
//   sends {1, 0, 0}                           ->  accepts(0) is false; has_pending_reply(0)
//   transfer_received(1)                      <-  the tile arrives first: messages keep their order
//   receives; may_transfer() is true now      <-  sends {0, 1, 0}: acknowledges phase 1
//   sends {1, 0, 1}                           ->  has_confirmed_transfers(0)
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "parallel/protocol/handshake_state.h"

namespace pprt {

// One rank's side. A rank that accepts tiles must not give any: the tile that joins what it is about to
// receive with its region might go. Two rules ensure it:
//   - Give only to ranks whose last bundle says that they accept.
//   - After a change to giving, give nothing until every rank that may think this one accepts has
//     acknowledged the change. Messages of one rank to another arrive in order. So a rank that acknowledges
//     sends no more tiles, and those it sent before have arrived.
class TransferHandshake {
 public:
  explicit TransferHandshake(int ranks) : peers_(static_cast<std::size_t>(ranks)) {}

  // Changes to giving or to accepting. Repeating it changes nothing.
  void set_giving(bool giving) {
    if (giving != is_giving()) ++phase_;
  }

  bool is_giving() const { return phase_ % 2 == 1; }

  // Whether this rank may give tiles now: everybody concerned knows that it gives.
  bool may_transfer() const {
    if (!is_giving()) return false;
    for (const Peer& p : peers_) {
      if (p.may_think_accepting && p.acknowledged != phase_) return false;
    }
    return true;
  }

  // Whether the rank has said that it accepts tiles, and nothing since.
  bool accepts(int rank) const { return peer(rank).has_sent && peer(rank).phase % 2 == 0; }

  // Whether a rank waits for a message: that this one gives now, or that its own change is known.
  bool has_pending_reply(int rank) const {
    const Peer& p = peer(rank);
    return (is_giving() && p.may_think_accepting && p.sent_phase != phase_) ||
           (p.has_sent && p.phase != p.sent_acknowledged);
  }

  // Returns what to send to the rank, and counts it as sent.
  HandshakeState send(int rank) {
    Peer& p = peers_[static_cast<std::size_t>(rank)];
    p.sent_phase = phase_;
    p.sent_acknowledged = p.phase;
    p.may_think_accepting = p.may_think_accepting || !is_giving();
    return {.phase = phase_, .acknowledged = p.phase, .transfers_received = p.transfers_received};
  }

  // Takes in what the rank has sent. Call it in the order of sending.
  void receive(int rank, const HandshakeState& state) {
    Peer& p = peers_[static_cast<std::size_t>(rank)];
    p.has_sent = true;
    p.phase = state.phase;
    p.acknowledged = state.acknowledged;
    p.transfers_confirmed = state.transfers_received;
    // A rank that knows that this one gives needs no further message until this one accepts again.
    if (is_giving() && state.acknowledged == phase_) p.may_think_accepting = false;
  }

  // Counts a transfer to the rank, or one that has come from it; any number of tiles in one message.
  void transfer_sent(int rank) { ++peers_[static_cast<std::size_t>(rank)].transfers_sent; }
  void transfer_received(int rank) { ++peers_[static_cast<std::size_t>(rank)].transfers_received; }

  // Whether what the rank said last takes all transfers to it into account.
  bool has_confirmed_transfers(int rank) const {
    return peer(rank).transfers_sent == peer(rank).transfers_confirmed;
  }

  // Nothing is expected of this rank any more.
  void forget(int rank) { peers_[static_cast<std::size_t>(rank)] = {}; }

  // Equal handshakes answer every call alike from now on.
  friend bool operator==(const TransferHandshake&, const TransferHandshake&) = default;

 private:
  struct Peer {
    bool has_sent = false;
    std::uint32_t phase = 0;                // its own, as received
    std::uint32_t acknowledged = 0;         // this rank's latest phase that it has acknowledged
    std::uint32_t sent_phase = 0;           // this rank's latest phase that was sent to it
    std::uint32_t sent_acknowledged = 0;    // its latest phase that was acknowledged to it
    std::uint32_t transfers_sent = 0;       // to it
    std::uint32_t transfers_confirmed = 0;  // of those, how many it has confirmed
    std::uint32_t transfers_received = 0;   // from it
    bool may_think_accepting = false;       // it may believe that this rank accepts tiles

    friend bool operator==(const Peer&, const Peer&) = default;
  };

  const Peer& peer(int rank) const { return peers_[static_cast<std::size_t>(rank)]; }

  std::uint32_t phase_ = 0;
  std::vector<Peer> peers_;
};

}  // namespace pprt
