// What a bundle says of the agreement on tile transfers (balance/transfer_handshake.h).
#pragma once

#include <cstdint>

namespace pprt {

// Travels in every bundle.
struct HandshakeState {
  std::uint32_t phase = 0;  // the sender's: even while it accepts tiles, odd while it gives; each change
                            // adds 1
  std::uint32_t acknowledged = 0;        // the receiver's phase as the sender knows it
  std::uint32_t transfers_received = 0;  // transfers by the receiver that the sender has taken in

  friend bool operator==(const HandshakeState&, const HandshakeState&) = default;
};

}  // namespace pprt
