// Exchange in rounds that all ranks share: the work clock's, whose result must not depend on arrival order.
#pragma once

#include <cstddef>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "parallel/clock/exchange_policy.h"
#include "parallel/settings/machine.h"

namespace pprt {

// Bundles go to those that they concern, as on the wall clock. Simulates the machine's network: a slow one
// delays samples by whole rounds. All else in a bundle is small and arrives in its own round.
class LockstepExchange final : public ExchangePolicy {
 public:
  // `round_units`: work units of one round.
  LockstepExchange(int ranks, const Machine& machine, double round_units)
      : ranks_(ranks), machine_(machine), round_units_(round_units) {}

  bool counts_bundles() const override { return ranks_ > 1; }
  bool owes_bundle(int rank, const ExchangeRound& at) override;
  bool is_progress_due(int round) const override { return round % 2 == 0; }
  int delivery_delay(int rank, const ExchangeRound& at, std::size_t bytes) override;
  bool sends_substitute_pixels() const override { return false; }

  std::size_t missing(const Inbox& inbox, const ExchangeRound& at) const override;
  std::vector<Inbox::Arrived> take_due(Inbox& inbox, const ExchangeRound& at) override;
  std::size_t missing_seeds(const Inbox& inbox, const ExchangeRound& at, std::span<const int>,
                            double) const override {
    return missing(inbox, at);
  }
  void begin_picture() override {
    under_way_.clear();
    owed_.clear();
  }
  bool rests_when_idle() const override { return false; }

 private:
  // Samples that a slow network keeps until a later round.
  struct UnderWay {
    int from;
    int due;  // round_number() of their delivery
    std::vector<Sample> samples;
  };

  int ranks_;
  Machine machine_;
  double round_units_;
  ExchangeRound sending_;               // of what was sent last
  double link_bytes_ = 0;               // sent in that round
  std::vector<UnderWay> under_way_;     // to this rank
  std::set<std::pair<int, int>> owed_;  // by this rank: round_number() of the delivery, receiver
};

}  // namespace pprt
