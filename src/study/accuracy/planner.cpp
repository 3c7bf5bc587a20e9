#include "study/accuracy/planner.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "study/accuracy/statistics.h"

namespace pprt {
namespace {

// Returns y at x, both members of a point, on the first segment between neighbouring points that holds x.
double interpolated(const std::vector<RatePoint>& points, double RatePoint::*x, double RatePoint::*y,
                    double at) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    const RatePoint &a = points[i - 1], &b = points[i];
    if (at < std::min(a.*x, b.*x) || at > std::max(a.*x, b.*x)) continue;
    return a.*x == b.*x ? a.*y : log_linear(at, a.*x, a.*y, b.*x, b.*y);
  }
  return points.front().*y;
}

}  // namespace

std::string error_at_rate(const std::vector<RatePoint>& points, double fps) {
  if (points.empty()) throw std::invalid_argument("no rate was measured");
  const RatePoint &slowest = points.front(), &fastest = points.back();
  if (fps < slowest.fps) {
    return fmt::format("{}: below {:g} frames/s the RMSE will be {:.4f} or less.", slowest.scene, slowest.fps,
                       slowest.rmse);
  }
  if (fps > fastest.fps) {
    return fmt::format("{}: above {:g} frames/s the RMSE will be {:.4f} or more.", slowest.scene, fastest.fps,
                       fastest.rmse);
  }
  return fmt::format("{}: at {:g} frames/s the RMSE will be about {:.4f}.", slowest.scene, fps,
                     interpolated(points, &RatePoint::fps, &RatePoint::rmse, fps));
}

std::string rate_with_error(std::vector<RatePoint> points, double rmse) {
  if (points.empty()) throw std::invalid_argument("no rate was measured");
  const RatePoint slowest = points.front(), fastest = points.back();
  if (rmse >= fastest.rmse) {
    return fmt::format("{}: an RMSE of {:g} is kept at {:g} frames/s and more.", slowest.scene, rmse,
                       fastest.fps);
  }
  if (rmse < slowest.rmse) {
    return fmt::format("{}: an RMSE of {:g} needs less than {:g} frames/s, at which it is {:.4f}.",
                       slowest.scene, rmse, slowest.fps, slowest.rmse);
  }
  std::reverse(points.begin(), points.end());  // the fastest rate that still has it comes first
  return fmt::format("{}: an RMSE of {:g} can be had at about {:.3g} frames/s.", slowest.scene, rmse,
                     interpolated(points, &RatePoint::rmse, &RatePoint::fps, rmse));
}

std::string seen_at_rates(const std::string& scene, std::span<const RateResult> results) {
  if (results.empty()) throw std::invalid_argument("no rate was measured");
  std::vector<std::string> others;
  for (const RateResult& r : results.subspan(1))
    others.push_back(fmt::format("{:.4f} and {:.4f} at {:g}", r.held.rmse, r.held.flip, r.fps));
  const RateResult& asked = results.front();
  return fmt::format(
      "{}: a viewer sees each frame until the next is delivered; over time the RMSE is then {:.4f} and the "
      "FLIP {:.4f} at {:g} frames/s{}{}.",
      scene, asked.held.rmse, asked.held.flip, asked.fps, others.empty() ? "" : "; ",
      fmt::join(others, ", "));
}

std::string real_time_summary(std::span<const RealTimeTurn> turns) {
  if (turns.empty()) throw std::invalid_argument("no turn was measured");
  const RealTimePoint& first = turns.front().with;
  int frames = 0;
  double on_time = 0, late_max_ms = first.late_max_ms, fewest = first.fewest_samples;
  std::vector<double> rmse, flip, over_without, over_uniform, flip_over_uniform;
  for (const auto& [with, without, uniform] : turns) {
    frames += with.frames, on_time += with.on_time * with.frames;
    late_max_ms = std::max(late_max_ms, with.late_max_ms), fewest = std::min(fewest, with.fewest_samples);
    rmse.push_back(with.errors.rmse), flip.push_back(with.errors.flip);
    over_without.push_back(with.errors.rmse / without.errors.rmse);
    over_uniform.push_back(with.errors.rmse / uniform.rmse);
    flip_over_uniform.push_back(with.errors.flip / uniform.flip);
  }
  const Spread ratio = spread_of(over_without);
  return fmt::format(
      "{}: in real time {:.0f} of {} frames were on time on {}, the latest {:.1f} ms {}; no frame after the "
      "fifth had fewer than {:.0f} samples. RMSE {:.4f}: {:.2f} ({:.2f} to {:.2f} by turns) of that without "
      "casting and {:.2f} of that of uniform sampling in all of their time. FLIP {:.4f}: {:.2f} of uniform "
      "sampling's.",
      first.scene, on_time, frames, first.ranks == 1 ? "one rank" : fmt::format("{} ranks", first.ranks),
      std::abs(late_max_ms), late_max_ms > 0 ? "late" : "early", fewest, spread_of(rmse).median, ratio.median,
      ratio.low, ratio.high, spread_of(over_uniform).median, spread_of(flip).median,
      spread_of(flip_over_uniform).median);
}

}  // namespace pprt
