// Flicker of the methods: by how much the error of a picture changes from frame to frame of a slow orbit.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "study/accuracy/methods.h"
#include "study/report/table.h"

namespace pprt {

// Budgets of a frame: shares of the time of one sample per pixel.
inline constexpr std::array kFlickerBudgets = {0.25, 0.5, 1.0};

// Frames of a scene, each with its converged picture.
struct SlowOrbit {
  std::string scene;  // name
  std::vector<Subject> frames;
  std::vector<Image> references;
};

// A method at one budget.
struct FlickerPoint {
  std::string scene, method;
  double budget = 0;
  double samples = 0;  // per pixel, mean over the frames
  double share = 0;    // CPU time of a frame / that of one sample per pixel; mean over the frames
  double flicker = 0;  // flicker_of()
  double ratio = 1;    // flicker / the uniform method's
};

// Returns the mean over neighbouring frames of flicker() (image/metrics.h). There are at least two frames,
// and as many references.
double flicker_of(std::span<const Image> pictures, std::span<const Image> references);

// Makes the frames with each method at each budget: each frame for itself, all with `seed` and with as many
// samples as take the budget on the first frame. A method without a picture in that time has NaN. `methods`
// must hold one named kUniform.
std::vector<FlickerPoint> measure_flicker(const SlowOrbit& orbit, std::span<const Method> methods,
                                          std::uint64_t seed);

Table flicker_table(const std::vector<FlickerPoint>& points);

// Returns one row per scene: a method's ratios at each budget. With several scenes their geometric mean
// follows.
Table flicker_ratios(const std::vector<FlickerPoint>& points, const std::string& method);

}  // namespace pprt
