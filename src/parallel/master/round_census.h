// Rank 0's count of the bundles of a round on the work clock. Nobody goes on before all that is sent to it is
// there, and nobody sends a message only to say that there is none.
#pragma once

#include <cstdint>
#include <vector>

#include "parallel/network/communicator.h"

namespace pprt {

// Two messages a rank and round, where empty bundles would be one for every pair of ranks.
class RoundCensus {
 public:
  explicit RoundCensus(Communicator& network)
      : network_(network), bundles_(static_cast<std::size_t>(network.size()), 0) {}

  // Takes in a rank's RoundSent; the last rank's answers all of them. A rank sends its next one after that
  // answer, so one round is counted at a time. Throws ProtocolError for what cannot be.
  void receive(const Message& message);

 private:
  Communicator& network_;
  std::vector<std::uint32_t> bundles_;  // per receiver, of the round that is being counted
  int heard_ = 0;                       // ranks, in that round
};

}  // namespace pprt
