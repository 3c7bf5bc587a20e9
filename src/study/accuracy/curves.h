// Measures error against time and against samples: all methods on one scene, in turns, on one thread.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/words.h"
#include "study/accuracy/methods.h"
#include "study/report/table.h"

namespace pprt {

// What a picture is judged by. Each is an error: 0 for the reference, less is better.
enum class Measure : std::uint8_t { kRmse, kFlip, kSsim };

template <>
inline constexpr std::array<Word<Measure>, 3> kWords<Measure>{
    {{Measure::kRmse, "RMSE", "root mean square error on the display scale"},
     {Measure::kFlip, "FLIP", "mean FLIP at 67 pixels per degree"},
     {Measure::kSsim, "1 - SSIM", "what the structural similarity lacks of 1"}}};

// A picture against the reference, both on the display scale.
struct CurvePoint {
  std::string method;
  int repeat = 0;
  double samples = 0;  // per pixel
  double seconds = 0;  // CPU time
  double share = 0;    // seconds / those of the uniform method for one sample per pixel in the same repeat
  double rmse = 0;
  double ssim = 1;
  double flip = 0;  // mean over the pixels
  double error_p999 = 0;
  double signed_mean = 0;
  bool exhausted = false;  // nothing was left to refine
};

// Returns the point's error by the measure.
double error_of(const CurvePoint& point, Measure measure);

struct SceneCurves {
  std::string scene;
  double one_sample_s = 0;  // CPU time of one sample per pixel, median over the repeats
  double reference_rmse = 0;
  int reference_samples = 0;  // per pixel
  std::vector<CurvePoint> points = {};
};

// Each repeat runs all methods, starting with another one, and has another seed: the first `seed`.
struct CurveRun {
  std::span<const Method> methods;  // one is named kUniform
  int repeats = 1;
  std::uint64_t seed = 1;
  int busy_threads = 0;  // render the same scene while a method makes its pictures
};

// Pictures of one method's curve are kept until its last, and then judged on all cores, so that judging does
// not disturb the times. Throws std::invalid_argument without a uniform method.
SceneCurves measure_curves(const std::string& scene, const Subject& subject, const Reference& reference,
                           const CurveRun& run);

// Returns one row per picture.
Table points_table(const std::vector<SceneCurves>& scenes);

}  // namespace pprt
