// Measures error against time and against samples: all methods on one scene, in turns, on one thread.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "study/accuracy/methods.h"
#include "study/report/plot.h"
#include "study/report/table.h"

namespace pprt {

// A picture against the reference, both on the display scale.
struct CurvePoint {
  std::string method;
  int repeat = 0;
  double samples = 0;  // per pixel
  double seconds = 0;  // CPU time
  double share = 0;    // seconds / those of the uniform method for one sample per pixel in the same repeat
  double rmse = 0;
  // Progressive and uniform method in the first repeat only: measuring these takes longer than rendering.
  double ssim = kNoValue;
  double flip = kNoValue;
  double error_p999 = kNoValue;
  double signed_mean = kNoValue;
  bool exhausted = false;  // nothing was left to refine
};

struct SceneCurves {
  std::string scene;
  double one_sample_s = 0;  // CPU time of one sample per pixel, median over the repeats
  double reference_rmse = 0;
  int reference_samples = 0;  // per pixel
  std::vector<CurvePoint> points = {};
};

// `methods` must hold one named kUniform. Each repeat runs all methods, starting with another one, and has
// another seed: the first `seed`.
SceneCurves measure_curves(const std::string& scene, const Subject& subject, const Reference& reference,
                           std::span<const Method> methods, int repeats, std::uint64_t seed);

// Returns one row per picture.
Table points_table(const std::vector<SceneCurves>& scenes);

}  // namespace pprt
