// A picture that is a linear function of position must pass through the pipeline unchanged.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "numeric/report.h"
#include "pipeline/mesh/reconstruction.h"
#include "unit/pipeline/synthetic_image.h"

namespace pprt::linear_picture_test {
namespace {

constexpr int kSamples = 100'000;
const TileGrid kGrid{320, 240, 32};

// Returns values in [0, 1], with another slope in each channel.
std::array<double, 3> ramp(double x, double y) {
  const double u = x / kGrid.width, v = y / kGrid.height;
  return {0.7 * u + 0.3 * v, 0.5 + 0.25 * (u - v), 1 - 0.9 * v};
}

Color ramp_color(double x, double y) {
  const auto [r, g, b] = ramp(x, y);
  return Color(static_cast<float>(r), static_cast<float>(g), static_cast<float>(b));
}

double distance(const Color& color, const std::array<double, 3>& wanted) {
  return std::max(
      {std::abs(color.x - wanted[0]), std::abs(color.y - wanted[1]), std::abs(color.z - wanted[2])});
}

// The mean of a pixel's samples, which the average rule must give.
struct PixelMean {
  std::array<double, 3> sum{};
  int samples = 0;
};

std::vector<PixelMean> means_of(const SampleMesh& mesh) {
  std::vector<PixelMean> means(static_cast<std::size_t>(kGrid.width) *
                               static_cast<std::size_t>(kGrid.height));
  for (const Sample& s : mesh.samples()) {
    const int x = std::min(static_cast<int>(s.x), kGrid.width - 1);
    const int y = std::min(static_cast<int>(s.y), kGrid.height - 1);
    PixelMean& mean = means[static_cast<std::size_t>(y) * static_cast<std::size_t>(kGrid.width) +
                            static_cast<std::size_t>(x)];
    const auto color = ramp(s.x, s.y);
    for (std::size_t i = 0; i < 3; ++i) mean.sum[i] += color[i];
    ++mean.samples;
  }
  return means;
}

}  // namespace

// Bounds, with u = 2^-24 times a value of at most 1:
//   a sample's colour is rounded once                             u / 2
//   c0 + a (c1 - c0) + b (c2 - c0), weights rounded to float      2 u / 2
//   its two differences, two products and two sums                6 u / 2
//   together, between samples                                     4.5 u, measured 1.4 u
// Going along a span takes a difference, a product and a sum more (3 u / 2). A sum of n colours in float, and
// their mean, errs by n / 2 u of itself. The mean over a pixel's area adds the rest of differences below 1 /
// 100 to a sample's colour: one sum more (u / 2).
TEST_CASE("a linear picture is reconstructed to rounding from 100,000 samples by every rule") {
  constexpr double kUnit = 0x1p-24;
  const SampleMesh mesh = refine(Region::whole(kGrid), ramp_color, kSamples);
  REQUIRE(mesh.samples().size() > kSamples);
  PixelBlock mean_of_samples, mean_of_area;
  ReconstructionBuffers buffers;
  reconstruct(mesh, mesh.region().bounds(), mean_of_samples, buffers, PixelRule::kMean);
  reconstruct(mesh, mesh.region().bounds(), mean_of_area, buffers, PixelRule::kArea);

  const std::vector<PixelMean> means = means_of(mesh);
  double interpolated = 0, averaged = 0, by_area = 0;  // largest errors
  int crowded = 0, most_samples = 0;
  for (int y = 0; y < kGrid.height; ++y) {
    for (int x = 0; x < kGrid.width; ++x) {
      const PixelMean& mean = means[static_cast<std::size_t>(y) * static_cast<std::size_t>(kGrid.width) +
                                    static_cast<std::size_t>(x)];
      const std::array<double, 3> at_center = ramp(x + 0.5, y + 0.5);
      by_area = std::max(by_area, distance(mean_of_area.at(x, y), at_center));
      if (mean.samples < 2) {
        interpolated = std::max(interpolated, distance(mean_of_samples.at(x, y), at_center));
        continue;
      }
      std::array<double, 3> wanted = mean.sum;
      for (double& channel : wanted) channel /= mean.samples;
      averaged = std::max(averaged, distance(mean_of_samples.at(x, y), wanted));
      most_samples = std::max(most_samples, mean.samples);
      ++crowded;
    }
  }
  CAPTURE(interpolated / kUnit, averaged / kUnit, by_area / kUnit, crowded, most_samples);
  CHECK(crowded > 1000);
  CHECK(crowded < kGrid.width * kGrid.height / 2);
  CHECK(interpolated <= 4.5 * kUnit);
  CHECK(averaged <= (1 + 0.5 * most_samples) * kUnit);
  CHECK(by_area <= 5 * kUnit);
  test::report("a linear picture from 100,000 samples, u = 2^-24",
               "4.5 u between samples; (1 + n / 2) u where n samples share a pixel; 5 u by area",
               "roundings to float counted beside the test",
               fmt::format("{:.1f} u; {:.1f} u for up to {}; {:.1f} u", interpolated / kUnit,
                           averaged / kUnit, most_samples, by_area / kUnit));
}

}  // namespace pprt::linear_picture_test
