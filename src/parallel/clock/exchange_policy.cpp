#include "parallel/clock/exchange_policy.h"

namespace pprt {

bool is_of_round(const Inbox::Arrived& arrived, const ExchangeRound& at) {
  return arrived.bundle.frame_index == at.frame_index && arrived.bundle.round == at.round;
}

}  // namespace pprt
