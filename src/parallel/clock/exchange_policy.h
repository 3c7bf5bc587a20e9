// How ranks wait for each other's bundles, which differs between the two clocks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "parallel/protocol/inbox.h"

namespace pprt {

// A place in a rank's sequence of exchanges.
struct ExchangeRound {
  int frame_index = 0;
  int begun_in = 0;  // index of the frame in which this rank's triangulation began
  int round = 0;     // kSeedRound, then one after each packet

  friend bool operator==(const ExchangeRound&, const ExchangeRound&) = default;
};

// The round of seeds and cast samples, before the first packet.
inline constexpr int kSeedRound = 0;

// More than any number of messages.
inline constexpr std::size_t kUnknownNumber = std::numeric_limits<std::size_t>::max();

// One rank's policy. make_clocks.h makes it; the two kinds are
//   LockstepExchange   work clock: a rank awaits all bundles that are sent to it in a round
//   FreeExchange       wall clock: it takes what has come
class ExchangePolicy {
 public:
  virtual ~ExchangePolicy() = default;

  // --- Sending

  // Whether the master counts each round's bundles, so that every rank knows how many to wait for.
  virtual bool counts_bundles() const = 0;

  // Whether a rank must be sent a bundle in this round, even one that does not concern it: samples that a
  // slow network has kept arrive with it.
  virtual bool owes_bundle(int rank, const ExchangeRound& at) = 0;

  // Whether progress is sent to neighbours after this round's packet, even without a sample to send.
  virtual bool is_progress_due(int round) const = 0;

  // Delivery delay, in rounds, of samples that are sent to a rank at `at`; bytes sent earlier in that round
  // go first. 0 where the network itself takes its time.
  virtual int delivery_delay(int rank, const ExchangeRound& at, std::size_t bytes) = 0;

  // Whether the former owner of a tile sends its pixels too, because the new owner's may come too late.
  virtual bool sends_substitute_pixels() const = 0;

  // --- Receiving

  // How many of the bundles that this round waits for have not arrived; kUnknownNumber before that is known.
  virtual std::size_t missing(const Inbox& inbox, const ExchangeRound& at) const = 0;

  // Removes the bundles due in this round and returns them, ordered by rank and then by sending.
  virtual std::vector<Inbox::Arrived> take_due(Inbox& inbox, const ExchangeRound& at) = 0;

  // For how many bundles of others' seeds a fresh triangulation still has to wait. `peers`: ranks whose seeds
  // this one needs, ascending. `frame_s`: seconds since the frame began.
  virtual std::size_t missing_seeds(const Inbox& inbox, const ExchangeRound& at, std::span<const int> peers,
                                    double frame_s) const = 0;

  // A triangulation begins: what is still under way to the one before is dropped.
  virtual void begin_picture() = 0;

  // Whether a rank without anything to refine rests before it looks for messages again. In lockstep the next
  // round waits anyway.
  virtual bool rests_when_idle() const = 0;
};

// Bundles of exactly this frame and round.
bool is_of_round(const Inbox::Arrived& arrived, const ExchangeRound& at);

}  // namespace pprt
