// What each effect costs in time, what its absence costs in error, and the special kernels against the
// general one.
#pragma once

#include <string>
#include <vector>

#include "study/reference.h"
#include "study/report/table.h"

namespace pprt {

// A scene without one of its effects, without all, or with the general kernel.
struct EffectCost {
  std::string scene;
  std::string variant;
  double time_ratio =
      1;  // CPU time of one sample per pixel / that of the whole scene, median over the repeats
  double rays_per_eye = 0;  // of all kinds
  double rmse = 0;          // of few samples against the converged whole scene
};

struct SceneEffects {
  std::string census;             // effects that the scene calls for, and why
  std::vector<EffectCost> costs;  // the whole scene first
};

// `reference` is the converged picture of the whole scene from `camera`.
SceneEffects measure_effects(const std::string& name, const SceneDescription& scene, const Camera& camera,
                             const Image& reference, int repeats);

Table effects_table(const std::vector<SceneEffects>& scenes);

}  // namespace pprt
