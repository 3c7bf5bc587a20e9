#include "parallel/clock/lockstep_exchange.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "parallel/settings/work_units.h"

namespace pprt {
namespace {

// Counts rounds through the whole sequence, so that samples may be under way from one frame into the next.
int round_number(const ExchangeRound& at) {
  return at.frame_index * kRoundsPerFrame + at.round;
}

}  // namespace

int LockstepExchange::delivery_delay(int rank, const ExchangeRound& at, std::size_t bytes) {
  constexpr double kMostRounds = 1e6;
  if (std::exchange(sending_, at) != at) link_bytes_ = 0;
  link_bytes_ += static_cast<double>(bytes);
  const double seconds = machine_.latency_s + link_bytes_ / machine_.bytes_per_second;
  const int rounds =
      static_cast<int>(std::min(seconds * machine_.units_per_second / round_units_, kMostRounds));
  if (rounds > 0 && bytes > 0) owed_.emplace(round_number(at) + rounds, rank);
  return rounds;
}

bool LockstepExchange::owes_bundle(int rank, const ExchangeRound& at) {
  return owed_.erase({round_number(at), rank}) > 0;
}

std::size_t LockstepExchange::missing(const Inbox& inbox, const ExchangeRound& at) const {
  if (!counts_bundles()) return 0;
  const std::optional<std::size_t> due = inbox.bundles_due(at.frame_index, at.round);
  if (!due) return kUnknownNumber;
  return *due - inbox.count_bundles([&](const Inbox::Arrived& a) { return is_of_round(a, at); });
}

// Returns the round's bundles, their samples replaced by those that arrive in this round, whenever these were
// sent.
std::vector<Inbox::Arrived> LockstepExchange::take_due(Inbox& inbox, const ExchangeRound& at) {
  std::vector<Inbox::Arrived> bundles =
      inbox.take_bundles([&](const Inbox::Arrived& a) { return is_of_round(a, at); });
  const int now = round_number(at);
  for (Inbox::Arrived& a : bundles) {
    if (a.bundle.rounds_under_way == 0 || a.bundle.samples.empty()) continue;
    under_way_.push_back(
        {.from = a.from, .due = now + a.bundle.rounds_under_way, .samples = std::move(a.bundle.samples)});
    a.bundle.samples.clear();
  }
  std::erase_if(under_way_, [&](const UnderWay& u) {
    if (u.due > now) return false;
    const auto from_same = std::find_if(bundles.begin(), bundles.end(),
                                        [&](const Inbox::Arrived& a) { return a.from == u.from; });
    if (from_same == bundles.end()) throw ProtocolError("a bundle with samples that were delayed is missing");
    std::vector<Sample>& samples = from_same->bundle.samples;
    samples.insert(samples.end(), u.samples.begin(), u.samples.end());
    return true;
  });
  return bundles;
}

}  // namespace pprt
