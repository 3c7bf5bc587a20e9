#include "study/accuracy/equal_time.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "image/image_io.h"
#include "study/accuracy/statistics.h"

namespace pprt {
namespace {

constexpr double kNoLimit = 1e9;  // seconds

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

}  // namespace

std::optional<Rendering> picture_with(double density, const Method& method, const Subject& subject,
                                      std::uint64_t seed) {
  const std::array densities = {density};
  std::optional<Rendering> picture;
  method.run({subject, densities, kNoLimit, seed, [&](Rendering&& r) { picture = std::move(r); }});
  if (picture) replace_non_finite(picture->image);
  return picture;
}

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

}  // namespace pprt
