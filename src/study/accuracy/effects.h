// What each effect costs in time, and what its absence costs in error.
#pragma once

#include <string>
#include <vector>

#include "study/reference.h"
#include "study/report/table.h"

namespace pprt {

// A scene without one of its effects, or without all.
struct EffectCost {
  std::string scene;
  std::string variant;
  double time_ratio = 1;    // CPU time of one sample per pixel / the whole scene's; median of the repeats
  double rays_per_eye = 0;  // of all kinds
  double rmse = 0;          // of few samples against the converged whole scene
};

// Returns the whole scene, then its variants. `reference` is the converged picture of the whole scene from
// `camera`.
std::vector<EffectCost> measure_effects(const std::string& name, const SceneDescription& scene,
                                        const Camera& camera, const Image& reference, int repeats);

Table effects_table(const std::vector<EffectCost>& costs);

}  // namespace pprt
