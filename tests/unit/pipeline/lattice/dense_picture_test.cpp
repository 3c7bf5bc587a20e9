// Pictures with more in a pixel than its samples can tell: the crown of a tree from afar.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <iterator>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "pipeline/lattice/lattice_refiner.h"
#include "unit/pipeline/rectangles.h"

namespace pprt::dense_picture_test {
namespace {

constexpr int kSize = 32, kFirst = 12, kEnd = 20;  // pixels: of the picture, and of a crown in its middle

constexpr std::uint32_t kBranches = 4;

// Twigs, three dozen in a pixel, each a part of one of some branches.
std::vector<test::Rectangle> crown() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(0, 1);
  constexpr int kCrown = kEnd - kFirst;
  std::vector<test::Rectangle> twigs;
  for (int i = 0; i < 36 * kCrown * kCrown; ++i) {
    const double x = kFirst + kCrown * any(random), y = kFirst + kCrown * any(random);
    const double length = 0.3 + 0.3 * any(random), width = 0.02 + 0.02 * any(random);
    const bool lies = any(random) < 0.5;
    twigs.push_back({x, y, x + (lies ? length : width), y + (lies ? width : length), 1 + any(random)});
  }
  return twigs;
}

std::uint32_t branch_of(std::uint32_t twig) {
  return twig == 0 ? 0 : 1 + twig % kBranches;
}

Color color_of(std::uint32_t twig) {
  const float branch = 0.1F * static_cast<float>(branch_of(twig));
  return twig == 0 ? Color(0.2F, 0.4F, 0.8F) : Color(branch, branch, 0.1F);
}

// The crown's pixels, each the mean of many points.
std::vector<Color> truth_of(const std::vector<test::Rectangle>& twigs) {
  constexpr int kSide = 40;
  std::vector<Color> truth;
  for (int y = kFirst; y < kEnd; ++y) {
    for (int x = kFirst; x < kEnd; ++x) {
      Color sum(0, 0, 0);
      for (int i = 0; i < kSide * kSide; ++i)
        sum += color_of(test::seen_at(twigs, x + (i % kSide + 0.5) / kSide, y + (i / kSide + 0.5) / kSide));
      truth.push_back(sum * (1.0F / (kSide * kSide)));
    }
  }
  return truth;
}

double error_of(const PixelBlock& pixels, const std::vector<Color>& truth) {
  double sum = 0;
  auto expected = truth.begin();
  for (int y = kFirst; y < kEnd; ++y) {
    for (int x = kFirst; x < kEnd; ++x) {
      const Color d = pixels.at(x, y) - *expected++;
      sum += d.dot(d) / 3;
    }
  }
  return std::sqrt(sum / static_cast<double>(truth.size()));
}

// Returns the picture of so many samples. Nobody tells how many they will be, so all is seen.
PixelBlock picture_of(const std::vector<test::Rectangle>& twigs, int samples) {
  std::vector<std::uint32_t> branches;
  for (std::uint32_t twig = 0; twig <= twigs.size(); ++twig) branches.push_back(branch_of(twig));
  PrimitiveShapes shapes = test::shapes_of(twigs);
  shapes.surfaces = branches;
  LatticeRefiner refiner(Region::whole({kSize, kSize, kSize}), std::move(shapes));
  for (int i = 0; i < samples; ++i) {
    const std::optional<Vec2d> at = refiner.next_point();
    REQUIRE(at);
    RaySample sample;
    sample.primitive = test::seen_at(twigs, at->x, at->y);
    sample.color = color_of(sample.primitive);
    refiner.insert(*at, sample);
  }
  PixelBlock pixels;
  refiner.paint({0, 0, kSize, kSize}, pixels);
  return pixels;
}

}  // namespace

TEST_CASE("dense picture: more samples bring it nearer to the truth, be there few or many") {
  const std::vector<test::Rectangle> twigs = crown();
  const std::vector<Color> truth = truth_of(twigs);
  constexpr int kPixels = kSize * kSize;
  std::vector<double> errors;
  for (const int samples : {kPixels / 16, kPixels / 4, kPixels, 4 * kPixels, 8 * kPixels})
    errors.push_back(error_of(picture_of(twigs, samples), truth));
  CAPTURE(errors[0], errors[1], errors[2], errors[3], errors[4]);
  CHECK(errors.front() < 0.02);
  CHECK(std::is_sorted(errors.rbegin(), errors.rend()));
  CHECK(errors.back() < 0.01);
}

TEST_CASE("dense picture, control: one that lacks twigs is seen to be wrong") {
  const std::vector<test::Rectangle> twigs = crown();
  const std::vector<test::Rectangle> half(twigs.begin(), twigs.begin() + std::ssize(twigs) / 2);
  CHECK(error_of(picture_of(half, kSize * kSize), truth_of(twigs)) > 0.05);
}

}  // namespace pprt::dense_picture_test
