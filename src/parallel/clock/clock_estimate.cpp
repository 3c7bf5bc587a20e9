#include "parallel/clock/clock_estimate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pprt {
namespace {

constexpr int kExchangesPerPoint = 8;
constexpr std::size_t kMostPoints = 32;

// A clock that differs from the prediction by more than messages explain has jumped.
constexpr double kLeastJump_s = 2e-3;

}  // namespace

std::optional<double> ClockEstimate::add(const ClockExchange& exchange) {
  const Point point{.answered_s = exchange.answered_s,
                    .ahead_s = 0.5 * (exchange.sent_s + exchange.received_s) - exchange.answered_s,
                    .round_trip_s = exchange.received_s - exchange.sent_s};
  std::optional<double> jump;
  if (!points_.empty()) {
    const double ahead_of_line_s = line_.to_rank_0(point.answered_s) - point.answered_s - point.ahead_s;
    const double explained_s = 0.5 * point.round_trip_s + uncertain_s(point.answered_s) + kLeastJump_s;
    if (std::abs(ahead_of_line_s) > explained_s) jump = ahead_of_line_s;
  }
  if (jump) points_.clear();
  is_same_clock_ = is_same_clock_ && !jump && std::abs(point.ahead_s) <= 0.5 * point.round_trip_s;
  keep(point);
  fit(point.answered_s);
  if (is_same_clock_) line_ = {};
  return jump;
}

void ClockEstimate::keep(const Point& point) {
  if (points_.empty() || in_last_ == kExchangesPerPoint) {
    points_.push_back(point);
    in_last_ = 0;
    if (points_.size() > kMostPoints) points_.pop_front();
  }
  ++in_last_;
  if (point.round_trip_s < points_.back().round_trip_s) points_.back() = point;
}

// Weighted least squares: an exchange may be wrong by its round trip, a rate by 200 millionths. So a rate is
// believed only when exchanges tell it better than that.
void ClockEstimate::fit(double at) {
  constexpr double kReading_s = 2e-5, kLikelyRate = 2e-4;
  const double about = points_.front().ahead_s;  // clocks may be far apart
  const auto weight = [](const Point& p) { return std::pow(p.round_trip_s + kReading_s, -2); };
  double weights = 0, mean_time = 0, mean_ahead = 0;
  for (const Point& p : points_) {
    weights += weight(p);
    mean_time += weight(p) * (p.answered_s - at);
    mean_ahead += weight(p) * (p.ahead_s - about);
  }
  mean_time /= weights, mean_ahead /= weights;
  double spread = std::pow(kLikelyRate, -2), common = 0;
  for (const Point& p : points_) {
    const double time = p.answered_s - at - mean_time;
    spread += weight(p) * time * time;
    common += weight(p) * time * (p.ahead_s - about - mean_ahead);
  }
  const double faster = common / spread;
  line_ = {.at = at, .ahead = about + mean_ahead - faster * mean_time, .faster = faster};
  mean_time_s_ = at + mean_time, ahead_variance_ = 1 / weights, rate_variance_ = 1 / spread;
}

// Returns what the line may be wrong by. It grows with the time since the exchanges that it was put through.
double ClockEstimate::uncertain_s(double at) const {
  const double since_s = at - mean_time_s_;
  return std::sqrt(ahead_variance_ + rate_variance_ * since_s * since_s);
}

}  // namespace pprt
