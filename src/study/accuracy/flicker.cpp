#include "study/accuracy/flicker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "image/image_io.h"
#include "image/metrics.h"
#include "study/accuracy/statistics.h"
#include "study/report/plot.h"

namespace pprt {
namespace {

constexpr double kNoLimit = 1e9;  // seconds

// The method's picture with so many samples per pixel, or nothing where it cannot make so few.
std::optional<Rendering> picture_with(double density, const Method& method, const Subject& subject,
                                      std::uint64_t seed) {
  const std::array densities = {density};
  std::optional<Rendering> picture;
  method.run({subject, densities, kNoLimit, seed, [&](Rendering&& r) { picture = std::move(r); }});
  if (picture) replace_non_finite(picture->image);
  return picture;
}

// The least CPU time of some pictures: a disturbance only adds to it. NaN without a picture.
double least_seconds(double density, const Method& method, const Subject& subject, std::uint64_t seed) {
  constexpr int kPictures = 3;
  double least = kNoValue;
  for (int i = 0; i < kPictures; ++i) {
    const std::optional<Rendering> picture = picture_with(density, method, subject, seed);
    if (picture) least = std::fmin(least, picture->seconds);
  }
  return least;
}

// Samples per pixel with which the method's picture takes so long; nothing where that is too short a time.
std::optional<double> density_in(double seconds, const Method& method, const Subject& subject,
                                 std::uint64_t seed) {
  constexpr int kTrials = 5;  // each finds the density for the next
  constexpr double kMost = 16;
  double density = 0.25;
  for (int trial = 0; trial < kTrials; ++trial) {
    const double taken = least_seconds(density, method, subject, seed);
    if (std::isnan(taken)) return std::nullopt;
    density = std::min(kMost, density * seconds / taken);
  }
  return density;
}

double one_sample_seconds(const SlowOrbit& orbit, const Method& uniform, std::uint64_t seed) {
  std::vector<double> seconds;
  for (const Subject& frame : orbit.frames) seconds.push_back(picture_with(1, uniform, frame, seed)->seconds);
  return spread_of(std::move(seconds)).median;
}

FlickerPoint measure(const SlowOrbit& orbit, const Method& method, double budget, double one_sample_s,
                     std::uint64_t seed) {
  FlickerPoint point{orbit.scene, method.name, budget, kNoValue, kNoValue, kNoValue, kNoValue};
  const std::optional<double> density = density_in(budget * one_sample_s, method, orbit.frames.front(), seed);
  if (!density) return point;
  std::vector<Image> pictures;
  std::vector<double> samples, shares;
  for (const Subject& frame : orbit.frames) {
    const std::optional<Rendering> picture = picture_with(*density, method, frame, seed);
    if (!picture) return point;
    pictures.push_back(clamped_to_display(picture->image));
    samples.push_back(picture->samples);
    shares.push_back(picture->seconds / one_sample_s);
  }
  point.samples = mean_of(samples), point.share = mean_of(shares);
  point.flicker = flicker_of(pictures, orbit.references);
  return point;
}

}  // namespace

double flicker_of(std::span<const Image> pictures, std::span<const Image> references) {
  if (pictures.size() != references.size() || pictures.size() < 2) {
    throw std::invalid_argument("flicker needs two frames or more, and a reference for each");
  }
  std::vector<double> changes;
  for (std::size_t i = 1; i < pictures.size(); ++i) {
    changes.push_back(flicker(pictures[i - 1], pictures[i], references[i - 1], references[i]));
  }
  return mean_of(changes);
}

std::vector<FlickerPoint> measure_flicker(const SlowOrbit& orbit, std::span<const Method> methods,
                                          std::uint64_t seed) {
  const auto uniform =
      std::find_if(methods.begin(), methods.end(), [](const Method& m) { return m.name == kUniform; });
  if (uniform == methods.end()) throw std::invalid_argument("there is no uniform method to compare with");
  const double one_sample_s = one_sample_seconds(orbit, *uniform, seed);
  std::vector<FlickerPoint> points;
  for (const double budget : kFlickerBudgets) {
    const std::size_t begin = points.size();
    for (const Method& method : methods) {
      points.push_back(measure(orbit, method, budget, one_sample_s, seed));
    }
    const std::span<FlickerPoint> at_budget = std::span(points).subspan(begin);
    const double of_uniform = at_budget[static_cast<std::size_t>(uniform - methods.begin())].flicker;
    for (FlickerPoint& point : at_budget) point.ratio = point.flicker / of_uniform;
  }
  return points;
}

Table flicker_table(const std::vector<FlickerPoint>& points) {
  using P = FlickerPoint;
  return table_of<P>(points, {{"scene", &P::scene},
                              {"method", &P::method},
                              {"budget, share of one sample a pixel", &P::budget},
                              {"share taken", &P::share},
                              {"samples a pixel", &P::samples},
                              {"flicker", &P::flicker},
                              {"flicker / uniform", &P::ratio}});
}

}  // namespace pprt
