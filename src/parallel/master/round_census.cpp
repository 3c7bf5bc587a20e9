#include "parallel/master/round_census.h"

#include <algorithm>
#include <cstddef>

#include "parallel/protocol/messages.h"

namespace pprt {

void RoundCensus::receive(const Message& message) {
  const RoundSent sent = decode_round_sent(message.payload);
  for (const std::int32_t rank : sent.receivers) {
    if (rank < 0 || rank >= network_.size()) throw ProtocolError("a bundle was sent to nobody");
    ++bundles_[static_cast<std::size_t>(rank)];
  }
  if (++heard_ < network_.size()) return;
  for (int rank = 0; rank < network_.size(); ++rank) {
    network_.send(rank, Tag::kRoundDue,
                  encode(RoundDue{sent.frame_index, sent.round, bundles_[static_cast<std::size_t>(rank)]}));
  }
  std::fill(bundles_.begin(), bundles_.end(), 0);
  heard_ = 0;
}

}  // namespace pprt
