#include "layers/measures.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "unit/layers/hand_made.h"

namespace pprt::measures_test {

using namespace pprt::test;

namespace {

// The pixel in column x of row y.
float at(const std::vector<float>& values, int x, int y) {
  return values[static_cast<std::size_t>(4 * y + x)];
}

}  // namespace

TEST_CASE("layers: the triangulation holds all samples, and their order does not matter") {
  std::vector<Sample> samples = corners_and_middle();
  const Triangulation frame = triangulate_frame(samples, kFourByFour);
  CHECK(frame.samples.size() == 5);
  CHECK(frame.triangles.size() == 4);
  std::reverse(samples.begin(), samples.end());
  const Triangulation reversed = triangulate_frame(samples, kFourByFour);
  CHECK(reversed.triangles == frame.triangles);
  CHECK(reversed.triangle_at == frame.triangle_at);
}

TEST_CASE("layers: samples on the border count in the last pixel, all others where they lie") {
  std::vector<Sample> samples = corners_and_middle();
  samples.push_back(sample(2.5, 2.5));
  const std::vector<float> counts = sample_counts(triangulate_frame(samples, kFourByFour));
  CHECK(at(counts, 0, 0) == 1);
  CHECK(at(counts, 3, 3) == 1);
  CHECK(at(counts, 2, 2) == 2);
  CHECK(at(counts, 1, 1) == 0);
}

TEST_CASE("layers: age and cost are linear between samples") {
  const Triangulation frame = triangulate_frame(corners_and_middle(), kFourByFour);
  // The middle was traced in frame 3, the corners in frame 1. Pixel (1, 1)'s centre lies three quarters of
  // the way from the corner to the middle, that of (0, 1) has 1/4 of the middle and 3/4 of the left side.
  CHECK(at(ages(frame, 5), 1, 1) == Approx(0.25 * 4 + 0.75 * 2));
  CHECK(at(ages(frame, 5), 0, 1) == Approx(0.75 * 4 + 0.25 * 2));
  CHECK(at(costs(frame), 1, 1) == Approx(0.25 * 1 + 0.75 * 11));
  CHECK(at(costs(frame), 3, 1) == Approx(0.75 * 3 + 0.25 * 11));
}

TEST_CASE("layers: density is the reciprocal of a sample's share of the image") {
  const Triangulation frame = triangulate_frame(corners_and_middle(), kFourByFour);
  // A third of each triangle: the middle has 4 of them, 16/3 square pixels; a corner 2, 8/3.
  const double middle = 3.0 / 16, corner = 3.0 / 8;
  CHECK(at(densities(frame), 1, 1) == Approx(0.25 * corner + 0.75 * middle));
  CHECK(at(densities(frame), 0, 1) == Approx(0.75 * corner + 0.25 * middle));
}

TEST_CASE("layers: confidence is the weight of the triangle that holds the pixel's centre") {
  const Triangulation frame = triangulate_frame(corners_and_middle(), kFourByFour);
  // Right-angled, with the hypotenuse of 4 as diameter. Red varies by 1 at one of three corners: variance
  // 2/9, a third of it over the three channels.
  const double expected = 4 * std::log(1.01 + 500 * (2.0 / 9) / 3);
  for (const float weight : weights(frame)) CHECK(weight == Approx(expected));
}

TEST_CASE("layers: without a triangle measures are 0, and the weight is infinite") {
  // What a rank that is missing leaves behind.
  const Triangulation torn =
      triangulate_frame({sample(0, 0, 1, 7), sample(4, 0, 1, 7), sample(0, 4, 1, 7)}, kFourByFour);
  CHECK(at(costs(torn), 0, 0) == 7);
  CHECK(at(costs(torn), 3, 3) == 0);
  CHECK(std::isinf(at(weights(torn), 3, 3)));  // not the surest of all
  const Triangulation nothing = triangulate_frame({}, kFourByFour);
  CHECK(densities(nothing) == std::vector<float>(16, 0));
}

}  // namespace pprt::measures_test
