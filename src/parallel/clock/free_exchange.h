// Exchange without rounds: the wall clock's, on which no rank waits for another while it samples.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "parallel/clock/exchange_policy.h"

namespace pprt {

class FreeExchange final : public ExchangePolicy {
 public:
  // `period_s`: seconds from frame to frame; 0 without a rate, when seeds are awaited without end.
  explicit FreeExchange(double period_s)
      : patience_s_(period_s > 0 ? kSeedPatience * period_s : std::numeric_limits<double>::infinity()) {}

  bool counts_bundles() const override { return false; }
  bool owes_bundle(int, const ExchangeRound&) override { return false; }
  bool is_progress_due(int round) const override { return round % kRoundsPerProgress == 0; }
  int delivery_delay(int, const ExchangeRound&, std::size_t) override { return 0; }
  bool sends_substitute_pixels() const override { return true; }

  std::size_t missing(const Inbox&, const ExchangeRound&) const override { return 0; }
  std::vector<Inbox::Arrived> take_due(Inbox& inbox, const ExchangeRound& at) override;
  std::size_t missing_seeds(const Inbox& inbox, const ExchangeRound& at, std::span<const int> peers,
                            double frame_s) const override;
  void begin_picture() override {}
  bool rests_when_idle() const override { return true; }

 private:
  // Packets after which a rank sends its progress to its neighbours, if there is no sample to send before.
  static constexpr int kRoundsPerProgress = 4;

  // Share of a frame's period that a rank waits for its peers' seeds.
  static constexpr double kSeedPatience = 0.1;

  double patience_s_;
};

}  // namespace pprt
