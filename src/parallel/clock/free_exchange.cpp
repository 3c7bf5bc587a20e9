#include "parallel/clock/free_exchange.h"

#include <algorithm>

namespace pprt {

// Bundles of a later triangulation wait for it. Those of an earlier one are of no more use, but are taken
// too: their transfers and handshakes still count.
std::vector<Inbox::Arrived> FreeExchange::take_due(Inbox& inbox, const ExchangeRound& at) {
  return inbox.take_bundles([&](const Inbox::Arrived& a) {
    return a.bundle.begun_in <= at.begun_in && a.bundle.frame_index <= at.frame_index;
  });
}

std::size_t FreeExchange::missing_seeds(const Inbox& inbox, const ExchangeRound& at,
                                        std::span<const int> peers, double frame_s) const {
  if (frame_s > patience_s_) return 0;
  const auto from_peer = [&](const Inbox::Arrived& a) {
    return is_of_round(a, at) && std::binary_search(peers.begin(), peers.end(), a.from);
  };
  return peers.size() - std::min(peers.size(), inbox.count_bundles(from_peer));
}

}  // namespace pprt
