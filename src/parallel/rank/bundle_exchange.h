// One rank's bundles to and from the others: when they are sent and awaited, and the bytes they take.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <span>
#include <vector>

#include "parallel/balance/transfer_handshake.h"
#include "parallel/clock/exchange_policy.h"
#include "parallel/clock/frame_clock.h"
#include "parallel/clock/stage_timer.h"
#include "parallel/network/communicator.h"
#include "parallel/protocol/inbox.h"

namespace pprt {

// Bytes sent in one frame by kind (paper Fig. 9b).
struct BundleBytes {
  std::uint64_t samples = 0;
  std::uint64_t tiles = 0;     // who owns them
  std::uint64_t progress = 0;  // all else
};

// Every bundle carries the transfer handshake: it is attached on sending and read on receipt, here alone.
class BundleExchange {
 public:
  // What the caller puts into a bundle.
  struct Content {
    bool done = false;           // the sender has reached its goal
    RankProgress progress = {};  // of the sender
    TileNews tiles = {};
    std::vector<Sample> samples = {};
    std::optional<double> squared_error = {};  // found in the sender's region
  };

  // The references must outlive the exchange.
  BundleExchange(Communicator& network, Inbox& inbox, std::unique_ptr<ExchangePolicy> policy,
                 FrameClock& clock, StageTimer& timer);

  void begin_frame(int index);
  void begin_picture(int begun_in);
  void begin_round(int round) { at_.round = round; }

  // Where this rank stands in the sequence.
  const ExchangeRound& at() const { return at_; }
  const ExchangePolicy& policy() const { return *policy_; }
  TransferHandshake& handshake() { return handshake_; }
  const BundleBytes& bytes() const { return bytes_; }

  // Neither sends anything to this rank any more, nor expects anything of it.
  void give_up(int rank);

  // Sends a bundle of this round to the rank. `concerns`: whether the content matters to it; if not, a bundle
  // goes only where the policy asks for one.
  void send(int rank, bool concerns, Content content);

  // All bundles of this round are sent. Returns those due in it, by rank and then by sending; waits for them
  // if the policy says so.
  std::vector<Inbox::Arrived> receive();

  // All bundles of this round are sent. Waits for the seeds of `peers` (ascending), as long as the policy
  // says.
  void await_seeds(std::span<const int> peers);

  // Returns the bundles of frames before this one, or exactly those of this round.
  std::vector<Inbox::Arrived> take_earlier();
  std::vector<Inbox::Arrived> take_of_round();

  // What bundles of frames before this one that have not been taken say of tiles.
  TileNews earlier_news() const;

  // Takes in messages until the condition holds. The waiting counts as idle.
  void await(const std::function<bool()>& condition);

  // The rank has nothing to refine: one short wait for messages, if the policy says so.
  void rest();

  // Counts work, in rays, and looks for messages after every 1024 of them, some .4 ms. On rank 0 the frame
  // before may become whole meanwhile, or due.
  void poll(std::uint64_t rays);

  // Whether the master has said that frames without a rate need not get better.
  bool has_enough() const { return inbox_.has_enough(); }

  // Looks for messages now.
  void look() { inbox_.pump(); }

 private:
  void close_round();
  void await_bundles(const std::function<std::size_t()>& count_missing);
  std::vector<Inbox::Arrived> read_handshakes(std::vector<Inbox::Arrived> bundles);
  void count(const Bundle& bundle, std::size_t encoded_size);

  Communicator& network_;
  Inbox& inbox_;
  std::unique_ptr<ExchangePolicy> policy_;
  FrameClock& clock_;
  StageTimer& timer_;
  TransferHandshake handshake_;
  std::set<int> given_up_;  // ranks
  ExchangeRound at_;
  BundleBytes bytes_;
  std::vector<std::int32_t> receivers_;  // of this round's bundles
  std::uint64_t rays_ = 0;               // since the last look
};

}  // namespace pprt
