// What each effect costs in time, and what its absence costs in error; special kernels against the general
// one.
#pragma once

#include <string>
#include <vector>

#include "study/accuracy/methods.h"
#include "study/report/table.h"

namespace pprt {

// A scene without one of its effects, or with none, or with the general kernel.
struct EffectCost {
  std::string scene;
  std::string variant;
  double time_ratio = 1;    // one sample a pixel over that of the whole scene, median over repeats
  double rays_per_eye = 0;  // of all kinds
  double rmse = 0;          // against the picture with all effects, which itself has the first row's
};

struct SceneEffects {
  std::string scene;
  std::string census;
  std::vector<EffectCost> costs;  // the whole scene first
};

// `camera` is of the scene compiled with all effects.
SceneEffects measure_effects(const std::string& name, const SceneDescription& scene, const Camera& camera,
                             const Image& reference, int repeats, const SecondsClock& clock);

Table effects_table(const std::vector<SceneEffects>& scenes);

}  // namespace pprt
