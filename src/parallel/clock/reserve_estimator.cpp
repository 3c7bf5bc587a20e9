#include "parallel/clock/reserve_estimator.h"

#include <algorithm>

namespace pprt {

double ReserveEstimator::after_sampling_s(double arrived_s, double sampling_ended_s,
                                          double reconstruction_ms) const {
  const double reconstruction_s = 1e-3 * reconstruction_ms * ranks_per_core_;
  return std::max(0.0, arrived_s - sampling_ended_s - reconstruction_s);
}

void ReserveEstimator::learn(double after_sampling_s) {
  constexpr std::size_t kRemembered = 12;
  after_sampling_s_.push_back(after_sampling_s);
  if (after_sampling_s_.size() > kRemembered) after_sampling_s_.pop_front();
}

double ReserveEstimator::reserve_s() const {
  constexpr double kFirstGuess = 0.2, kMost = 0.7;  // of the period
  if (period_s_ == 0) return 0;
  if (after_sampling_s_.empty()) return kFirstGuess * period_s_;
  const double worst = *std::max_element(after_sampling_s_.begin(), after_sampling_s_.end());
  const double careful = ranks_per_core_ > 1 ? 1.7 * worst + 0.001 : 1.25 * worst + 0.0005;
  return std::clamp(careful, 0.0, kMost * period_s_);
}

}  // namespace pprt
