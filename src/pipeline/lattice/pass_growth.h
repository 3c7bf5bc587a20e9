// Learns how many samples a pass takes, for each that its candidates promise when it begins.
#pragma once

#include <algorithm>
#include <cstddef>

namespace pprt {

class PassGrowth {
 public:
  // A pass begins with so many samples. `promised`: those that its candidates are expected to lead to; 0 for
  // a pass that takes all nodes, from which nothing is learned.
  void begin_pass(std::size_t samples, double promised) { begun_with_ = samples, promised_ = promised; }

  // The pass is over, with so many samples.
  void end_pass(std::size_t samples) {
    constexpr double kEnough = 200, kLeast = 0.3, kMost = 4, kShareOfNew = 0.5;
    const double made = static_cast<double>(samples) - static_cast<double>(begun_with_);
    if (promised_ == 0 || made < kEnough) return;
    growth_ += kShareOfNew * (std::clamp(made / promised_, kLeast, kMost) - growth_);
  }

  double get() const { return growth_; }

 private:
  double growth_ = 3;  // pessimistic: nothing is learned yet
  std::size_t begun_with_ = 0;
  double promised_ = 0;
};

}  // namespace pprt
