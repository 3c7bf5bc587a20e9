// Whether a rank takes tiles or gives them, and how neighbours come to know it without a question and an
// answer before each transfer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pprt {

// Travels in every bundle.
struct HandshakeState {
  std::uint32_t handshake = 0;  // the sender's: even while it takes, odd while it gives; counts its changes
  std::uint32_t heard = 0;      // the receiver's handshake as the sender knows it
  std::uint32_t taken = 0;      // how many transfers of the receiver's the sender has taken in

  friend bool operator==(const HandshakeState&, const HandshakeState&) = default;
};

// A rank that takes must not give: the tile that joins what it is about to receive with its region might go.
// Rules: give only to ranks last heard taking; and, having changed to giving, not before everybody who was
// told that this rank takes has acknowledged that it no longer does. Words of one rank to another arrive in
// order, so whoever acknowledges gives nothing more, and what it gave before has arrived.
class TransferHandshake {
 public:
  explicit TransferHandshake(int ranks) : peers_(static_cast<std::size_t>(ranks)) {}

  // Takes the side that is wanted; repeating it changes nothing.
  void decide(bool to_give) {
    if (to_give != is_giving()) ++handshake_;
  }

  bool is_giving() const { return handshake_ % 2 == 1; }

  // Whether transfers are in order now: everybody concerned knows that this rank gives.
  bool may_give() const {
    if (!is_giving()) return false;
    for (const Peer& p : peers_) {
      if (p.told_taking && p.acknowledged != handshake_) return false;
    }
    return true;
  }

  // Whether the rank has said that it takes, and nothing since.
  bool takes(int rank) const { return peer(rank).has_spoken && peer(rank).handshake % 2 == 0; }

  // Whether a rank waits for a word: that this one gives now, or that its own change is known.
  bool owes_word(int rank) const {
    const Peer& p = peer(rank);
    return (is_giving() && p.told_taking && p.told != handshake_) ||
           (p.has_spoken && p.handshake != p.told_heard);
  }

  // What to tell the rank; it counts as told.
  HandshakeState tell(int rank) {
    Peer& p = peers_[static_cast<std::size_t>(rank)];
    p.told = handshake_;
    p.told_heard = p.handshake;
    p.told_taking = p.told_taking || !is_giving();
    return {handshake_, p.handshake, p.taken};
  }

  // A transfer goes to the rank; one has come from it.
  void gave(int rank) { ++peers_[static_cast<std::size_t>(rank)].given; }
  void took(int rank) { ++peers_[static_cast<std::size_t>(rank)].taken; }

  // Whether what was heard from the rank takes all transfers to it into account.
  bool has_counted_gifts(int rank) const { return peer(rank).given == peer(rank).given_and_counted; }

  // Equal handshakes answer every call alike from now on.
  friend bool operator==(const TransferHandshake&, const TransferHandshake&) = default;

  void hear(int rank, const HandshakeState& word) {
    Peer& p = peers_[static_cast<std::size_t>(rank)];
    p.has_spoken = true;
    p.handshake = word.handshake;
    p.acknowledged = word.heard;
    p.given_and_counted = word.taken;
    // Who knows that this rank gives needs no further word of it, until it is told otherwise again.
    if (is_giving() && word.heard == handshake_) p.told_taking = false;
  }

 private:
  struct Peer {
    bool has_spoken = false;
    std::uint32_t handshake = 0;          // as heard
    std::uint32_t acknowledged = 0;       // of this rank's handshakes, the latest that it has confirmed
    std::uint32_t told = 0;               // of this rank's handshakes, the latest that it was told
    std::uint32_t told_heard = 0;         // of its own handshakes, the latest confirmed to it
    std::uint32_t given = 0;              // transfers to it
    std::uint32_t given_and_counted = 0;  // of those, what it has said to have taken in
    std::uint32_t taken = 0;              // transfers from it
    bool told_taking = false;             // it may believe that this rank takes

    friend bool operator==(const Peer&, const Peer&) = default;
  };

  const Peer& peer(int rank) const { return peers_[static_cast<std::size_t>(rank)]; }

  std::uint32_t handshake_ = 0;
  std::vector<Peer> peers_;
};

}  // namespace pprt
