// How ranks wait for each other's bundles, which differs between the two clocks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "parallel/network/inbox.h"

namespace pprt {

// A place in a rank's sequence of exchanges.
struct ExchangeRound {
  int frame_index = 0;
  int epoch = 0;  // index of the frame in which this rank's triangulation began
  int round = 0;  // kSeedRound, then one after each packet

  friend bool operator==(const ExchangeRound&, const ExchangeRound&) = default;
};

// The round of seeds and cast samples, before the first packet.
inline constexpr int kSeedRound = 0;

// One rank's policy. make_clocks.h makes it; the two kinds are
//   LockstepExchange   work clock: every rank sends one bundle a round to every other, and awaits theirs
//   FreeExchange       wall clock: a rank sends what concerns the receiver, and takes what has come
class ExchangePolicy {
 public:
  virtual ~ExchangePolicy() = default;

  // --- Sending

  // Whether a rank is sent a bundle in every round, even one that does not concern it.
  virtual bool sends_to_all() const = 0;

  // Whether progress is sent to neighbours after this round's packet, even without a sample to send.
  virtual bool is_progress_due(int round) const = 0;

  // Delivery delay, in rounds, of samples that are sent at `at`; bytes sent earlier in that round go first. 0
  // where the network itself takes its time.
  virtual int delivery_delay(const ExchangeRound& at, std::size_t bytes) = 0;

  // Whether the former owner of a tile sends its pixels too, because the new owner's may come too late.
  virtual bool sends_substitute_pixels() const = 0;

  // --- Receiving

  // How many of the bundles that this round waits for have not arrived.
  virtual std::size_t missing(const Inbox& inbox, const ExchangeRound& at) const = 0;

  // Removes the bundles due in this round and returns them, ordered by rank and then by sending.
  virtual std::vector<Inbox::Arrived> take_due(Inbox& inbox, const ExchangeRound& at) = 0;

  // For how many bundles of others' seeds a fresh triangulation still has to wait. `peers`: ranks whose seeds
  // this one needs, ascending. `frame_s`: seconds since the frame began.
  virtual std::size_t missing_seeds(const Inbox& inbox, const ExchangeRound& at, std::span<const int> peers,
                                    double frame_s) const = 0;

  // A triangulation begins: what is still under way to the one before is dropped.
  virtual void begin_triangulation() = 0;

  // Whether a rank without anything to refine rests before it looks for messages again. In lockstep the next
  // round waits anyway.
  virtual bool rests_when_idle() const = 0;
};

// Bundles of exactly this frame and round.
bool is_of_round(const Inbox::Arrived& arrived, const ExchangeRound& at);

}  // namespace pprt
