#include "parallel/master/frame_effort.h"

#include <algorithm>
#include <cmath>

namespace pprt {
namespace {

// The squared error falls as this power of the samples; measured (docs/decisions/0035-quality.md).
constexpr double kSteepness = 1.3;

}  // namespace

void FrameEffort::Recent::add(double squared, double variance) {
  constexpr std::size_t kMost = 24;
  last_.push_back({squared, variance, 0});
  if (last_.size() > kMost) last_.pop_front();
}

double FrameEffort::Recent::upper() const {
  MeanErrorEstimate all;
  for (const ErrorEstimate& e : last_) all.add(e);
  const ErrorEstimate mean = all.mean();
  return std::max(0.0, mean.squared) + std::sqrt(mean.variance);
}

double FrameEffort::for_frame(bool cut, bool rests) const {
  constexpr std::size_t kFewestMoving = 4, kFewestResting = 2;
  constexpr double kLeast = 0.02;
  if (squared_ <= 0 || cut) return 1;
  if (rests) return resting_.count() >= kFewestResting && resting_.upper() <= squared_ ? 0 : 1;
  if (moving_.count() < kFewestMoving) return 1;
  return std::clamp(std::pow(moving_.upper() / squared_, 1 / kSteepness), kLeast, 1.0);
}

void FrameEffort::learn(const FrameOrder& order, const FrameError& error) {
  if (squared_ <= 0) return;
  if (order.carry == Carry::kAccumulate) return resting_.add(error.own.squared, error.own.variance);
  resting_.forget();
  if (order.cut) moving_.forget();
  const double at_full = std::pow(order.effort, kSteepness);
  moving_.add(error.own.squared * at_full, error.own.variance * at_full * at_full);
}

}  // namespace pprt
