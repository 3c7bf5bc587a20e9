#include "pipeline/lattice/error_estimates.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pprt {
namespace {

// What to expect before anything is learned. Errors are larger where larger ones were found, and where few
// samples lie on the surface.
float expected(NodeClass c) {
  constexpr float kOctaves = 0.3F, kMiddle = 2.5F;
  const std::size_t error_level = c % kErrorLevels, basis = c / kErrorLevels / kVarianceLevels;
  constexpr float kWithoutSample = 12;
  const auto steps =
      static_cast<float>(error_level / 2) +
      (basis == static_cast<NodeClass>(Basis::kNothing) ? kWithoutSample : static_cast<float>(basis));
  return std::exp2(kOctaves * (steps - kMiddle));
}

}  // namespace

const std::array<float, 512> kDetails = [] {
  std::array<float, 512> details{};
  for (std::size_t i = 0; i < details.size(); ++i) {
    const float least = least_of_step<kDetailFine>(static_cast<std::int32_t>(i)), middle = 1.1F * least;
    details[i] = std::sqrt(std::log(1.03F + 500 * middle));
  }
  return details;
}();

void ErrorEstimates::clear() {
  constexpr float kDetail = 100, kError = 2;  // of all classes together, until there is more
  sums_ = {};
  all_ = {kError, kDetail, 0};
  update();
}

void ErrorEstimates::learn(NodeClass c, float detail, float error) {
  sums_[c].error += error, sums_[c].detail += detail, sums_[c].samples += 1;
  all_.error += error, all_.detail += detail;
}

// The error over the detail in each class, against that of all. It counts by its power of 3/4, for what is
// learned is uncertain and refinement changes it.
void ErrorEstimates::update() {
  constexpr float kDoubt = 5, kMost = 32;  // samples that the expectation counts as
  const float of_all = all_.error / all_.detail;
  for (NodeClass c = 0; c < kNodeClasses; ++c) {
    const Sums& sums = sums_[c];
    const float doubt = kDoubt * (sums.samples > 0 ? sums.detail / sums.samples : 1);
    const float ratio = (sums.error / of_all + doubt * expected(c)) / (sums.detail + doubt);
    const float root = std::sqrt(ratio);
    factors_[c] = std::clamp(root * std::sqrt(root), 1 / kMost, kMost);
  }
}

}  // namespace pprt
