// Error against time and against samples, measured: every method on one scene, in turns, on one thread.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "study/accuracy/methods.h"
#include "study/accuracy/reference.h"
#include "study/report/plot.h"

namespace pprt {

// A picture against the reference, both on the display scale.
struct CurvePoint {
  std::string method;
  int repeat = 0;
  double samples = 0;  // a pixel
  double seconds = 0;
  double share = 0;  // of the time that the uniform method took in the same repeat for one sample a pixel
  double rmse = 0;
  // Of the progressive and the uniform method in the first repeat: telling them takes longer than rendering.
  double ssim = kNoValue;
  double flip = kNoValue;
  double error_p999 = kNoValue;
  double signed_mean = kNoValue;
  bool exhausted = false;
};

struct SceneCurves {
  std::string scene;
  double one_sample_s = 0;  // median over repeats of what one sample per pixel took
  double reference_rmse = 0;
  int reference_samples = 0;  // a pixel
  std::vector<CurvePoint> points;
};

struct CurveSettings {
  int repeats = 3;
  double greatest_share = 4.05;  // of the time of one sample a pixel: where curves end
  std::uint64_t seed = 1;        // of the first repeat; counts up
};

// `methods` must hold one that is called kUniform. Each repeat runs all of them, another one first each time.
SceneCurves measure_curves(const std::string& scene, const Subject& subject, const Reference& reference,
                           std::span<const Method> methods, const CurveSettings& settings,
                           const SecondsClock& clock);

}  // namespace pprt
