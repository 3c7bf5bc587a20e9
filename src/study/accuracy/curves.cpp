#include "study/accuracy/curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "image/image_io.h"
#include "image/metrics.h"
#include "study/accuracy/statistics.h"

namespace pprt {
namespace {

CurvePoint judged(const std::string& method, int repeat, Rendering&& rendering, const Image& reference) {
  constexpr double kThreshold = 1;  // the share of pixels beyond it is not used
  replace_non_finite(rendering.image);
  const Image shown = clamped_to_display(rendering.image);
  CurvePoint point{.method = method,
                   .repeat = repeat,
                   .samples = rendering.samples,
                   .seconds = rendering.seconds,
                   .rmse = rmse_of(shown, reference),
                   .exhausted = rendering.exhausted};
  if (repeat == 0 && (method == kProgressive || method == kUniform)) {
    const ImageDifference d = difference(shown, reference, kThreshold);
    point.ssim = d.ssim, point.flip = mean_flip(shown, reference);
    point.error_p999 = d.error_p999, point.signed_mean = d.signed_mean;
  }
  return point;
}

double one_sample_seconds(const Method& uniform, const Subject& subject) {
  constexpr std::array kOne = {1.0};
  double seconds = 0;
  uniform.run({subject, kOne, 0, 1, [&](Rendering&& rendering) { seconds = rendering.seconds; }});
  return seconds;
}

// Sets the repeat's shares; returns the time of one sample a pixel in it.
double set_shares(std::span<CurvePoint> points) {
  const auto one = std::find_if(points.begin(), points.end(),
                                [](const CurvePoint& p) { return p.method == kUniform && p.samples == 1; });
  if (one == points.end()) throw std::logic_error("the uniform method gave no picture of one sample a pixel");
  const double seconds = one->seconds;
  for (CurvePoint& p : points) p.share = p.seconds / seconds;
  return seconds;
}

}  // namespace

SceneCurves measure_curves(const std::string& scene, const Subject& subject, const Reference& reference,
                           std::span<const Method> methods, int repeats, std::uint64_t seed) {
  constexpr double kGreatestShare = 4.05;  // of the time of one sample per pixel: there curves end
  const auto uniform =
      std::find_if(methods.begin(), methods.end(), [](const Method& m) { return m.name == kUniform; });
  if (uniform == methods.end()) throw std::invalid_argument("there is no uniform method to compare with");
  SceneCurves curves{scene, 0, reference.own_rmse, reference.samples};
  const std::vector<double> densities = curve_densities();
  one_sample_seconds(*uniform, subject);  // warms caches
  const double limit_s = kGreatestShare * one_sample_seconds(*uniform, subject);
  std::vector<double> one_sample;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const std::size_t begin = curves.points.size();
    for (std::size_t i = 0; i < methods.size(); ++i) {
      const Method& method = methods[(i + static_cast<std::size_t>(repeat)) % methods.size()];
      const auto add = [&](Rendering&& rendering) {
        curves.points.push_back(judged(method.name, repeat, std::move(rendering), reference.image));
      };
      method.run({subject, densities, limit_s, seed + static_cast<std::uint64_t>(repeat), add});
    }
    one_sample.push_back(set_shares(std::span(curves.points).subspan(begin)));
  }
  curves.one_sample_s = spread_of(one_sample).median;
  return curves;
}

Table points_table(const std::vector<SceneCurves>& scenes) {
  using P = CurvePoint;
  return table_of_parts<SceneCurves, P>(
      scenes, &SceneCurves::points, {{"scene", &SceneCurves::scene}},
      {{"method", &P::method},
       {"repeat", [](const P& p) { return p.repeat + 1; }},
       {"samples a pixel", &P::samples},
       {"cpu s", &P::seconds},
       {"share of one sample a pixel", &P::share},
       {"rmse", &P::rmse},
       {"ssim", &P::ssim},
       {"flip", &P::flip},
       {"error of 99.9 %", &P::error_p999},
       {"signed mean", &P::signed_mean},
       {"exhausted", [](const P& p) { return p.exhausted ? "yes" : "no"; }}});
}

}  // namespace pprt
