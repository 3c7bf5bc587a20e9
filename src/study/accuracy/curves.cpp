#include "study/accuracy/curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "image/image_io.h"
#include "image/metrics.h"
#include "study/accuracy/busy_threads.h"
#include "study/accuracy/statistics.h"
#include "study/frame_series.h"

namespace pprt {
namespace {

// A picture as a display shows it, and what it took; not judged yet.
struct Shown {
  CurvePoint point;
  Image image;
};

// Runs a method. Each picture is copied, and the next one finds its storage, as the frames of a sequence do.
std::vector<Shown> pictures_of(const Method& method, const CurveTask& task, int repeat, int busy_threads) {
  std::vector<Shown> pictures;
  CurveTask kept = task;
  kept.sink = [&](Rendering&& rendering) {
    replace_non_finite(rendering.image);
    Shown& shown = pictures.emplace_back();
    shown.image = clamped_to_display(rendering.image);
    CurvePoint& point = shown.point;
    point.method = method.name, point.repeat = repeat;
    point.samples = rendering.samples, point.seconds = rendering.seconds;
    point.exhausted = rendering.exhausted;
  };
  kept.takes_coarsest = true;  // what a small budget buys
  const BusyThreads busy(task.subject, busy_threads);
  method.run(kept);
  return pictures;
}

// The reference, by which pictures are judged by all measures.
class Judge {
 public:
  explicit Judge(const Image& reference) : reference_(reference), flip_(reference) {}

  // Fills in the errors of all points, on all cores.
  void judge(std::vector<Shown>& pictures) const {
    run_concurrently(pictures.size(), [&](std::size_t i) { judge(pictures[i].image, pictures[i].point); });
  }

 private:
  void judge(const Image& image, CurvePoint& point) const {
    constexpr double kThreshold = 1;  // the share of pixels beyond it is not used
    const ImageDifference d = difference(image, reference_, kThreshold);
    point.rmse = rmse_of(image, reference_);
    point.ssim = d.ssim, point.flip = flip_.mean(image);
    point.error_p999 = d.error_p999, point.signed_mean = d.signed_mean;
  }

  const Image& reference_;
  FlipReference flip_;
};

double one_sample_seconds(const Method& uniform, const Subject& subject, int busy_threads) {
  constexpr std::array kOne = {1.0};
  double seconds = 0;
  const BusyThreads busy(subject, busy_threads);
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

double error_of(const CurvePoint& point, Measure measure) {
  switch (measure) {
    case Measure::kFlip:
      return point.flip;
    case Measure::kSsim:
      return std::max(0.0, 1 - point.ssim);  // rounding takes it beyond 1
    default:
      return point.rmse;
  }
}

SceneCurves measure_curves(const std::string& scene, const Subject& subject, const Reference& reference,
                           const CurveRun& run) {
  constexpr double kGreatestShare = 4.05;  // of the time of one sample per pixel: there curves end
  const auto uniform = std::find_if(run.methods.begin(), run.methods.end(),
                                    [](const Method& m) { return m.name == kUniform; });
  if (uniform == run.methods.end()) throw std::invalid_argument("there is no uniform method to compare with");
  SceneCurves curves{scene, 0, reference.own_rmse, reference.samples};
  const Judge judge(reference.image);
  const std::vector<double> densities = curve_densities();
  one_sample_seconds(*uniform, subject, run.busy_threads);  // warms caches
  const double limit_s = kGreatestShare * one_sample_seconds(*uniform, subject, run.busy_threads);
  std::vector<double> one_sample;
  for (int repeat = 0; repeat < run.repeats; ++repeat) {
    const std::size_t begin = curves.points.size();
    for (std::size_t i = 0; i < run.methods.size(); ++i) {
      const Method& method = run.methods[(i + static_cast<std::size_t>(repeat)) % run.methods.size()];
      const CurveTask task{subject, densities, limit_s, run.seed + static_cast<std::uint64_t>(repeat)};
      std::vector<Shown> pictures = pictures_of(method, task, repeat, run.busy_threads);
      judge.judge(pictures);
      for (const Shown& picture : pictures) curves.points.push_back(picture.point);
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
