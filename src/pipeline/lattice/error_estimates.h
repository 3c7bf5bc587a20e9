// Learns how wrong the picture is at nodes that hold no sample yet: the expected error by class of node.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "pipeline/lattice/local_errors.h"
#include "pipeline/lattice/surface_share.h"

namespace pprt {

// A class of nodes whose errors are alike. It has three parts: what their prediction rests on, the variance
// of the colours that it is made of (two octaves each), and the level of the errors near them.
using NodeClass = std::size_t;
inline constexpr std::size_t kNodeClasses = std::size_t{kBases} * kVarianceLevels * kErrorLevels;

inline NodeClass class_of(Basis basis, float variance, int level_of_errors) {
  const int level = std::min(variance_level(variance), kVarianceLevels - 1);
  return static_cast<NodeClass>((static_cast<int>(basis) * kVarianceLevels + level) * kErrorLevels +
                                level_of_errors);
}

// detail_of() of floats in [0, 2), four an octave.
inline constexpr int kDetailFine = 2;
extern const std::array<float, 512> kDetails;

// Returns sqrt(log(1.03 + 500 variance)): the paper's refinement weight (refinement_weight.h), for a
// difference instead of its square. The variance lies in [0, 2). It counts to an eighth of an octave.
inline float detail_of(float variance) {
  return kDetails[static_cast<std::size_t>(octave_step<kDetailFine>(variance))];
}

class ErrorEstimates {
 public:
  ErrorEstimates() { clear(); }

  // Forgets all.
  void clear();

  // Returns the factor that turns detail_of() into the error to expect, up to a common factor.
  float factor(NodeClass c) const { return factors_[c]; }

  // Notes the error found at a node, where `detail` was to be expected, both times the area it stands for.
  // Factors stay as they are until update().
  void learn(NodeClass c, float detail, float error);

  void update();

 private:
  struct Sums {
    float error = 0, detail = 0, samples = 0;
  };
  std::array<Sums, kNodeClasses> sums_;
  Sums all_;
  std::array<float, kNodeClasses> factors_;
};

}  // namespace pprt
