#include "pipeline/mesh/reconstruction.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "unit/pipeline/synthetic_image.h"

namespace pprt::reconstruction_test {
namespace {

const TileGrid kGrid{100, 60, 16};

PixelBlock rebuild(const SampleMesh& mesh, PixelRule rule = PixelRule::kArea) {
  PixelBlock pixels;
  ReconstructionBuffers buffers;
  reconstruct(mesh, mesh.region().bounds(), pixels, buffers, rule);
  return pixels;
}

// Of a picture that depends on x alone and is linear between the given samples: its mean over [left, right].
double mean_between(const std::vector<std::pair<double, double>>& samples, double left, double right) {
  double sum = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const auto& [x0, v0] = samples[i - 1];
    const auto& [x1, v1] = samples[i];
    const double from = std::max(left, x0), to = std::min(right, x1);
    if (from < to) sum += (to - from) * (v0 + (v1 - v0) * (0.5 * (from + to) - x0) / (x1 - x0));
  }
  return sum / (right - left);
}

// Seeds only: nowhere two in a pixel, so nothing is averaged.
const Picture kLinear = [](double x, double y) {
  return Color(static_cast<float>(0.003 * x + 0.002 * y), static_cast<float>(0.9 - 0.004 * x), 0.25f);
};

}  // namespace

TEST_CASE("reconstruction: a linear picture is exact to rounding, a constant to the bit") {
  const PixelBlock pixels = rebuild(refine(Region::whole(kGrid), kLinear, 0));
  for (int y = 0; y < kGrid.height; ++y) {
    for (int x = 0; x < kGrid.width; ++x) {
      const Color expected = kLinear(x + 0.5, y + 0.5);
      CHECK(std::abs(pixels.at(x, y).x - expected.x) < 3e-7f);
      CHECK(std::abs(pixels.at(x, y).y - expected.y) < 3e-7f);
      CHECK(pixels.at(x, y).z == 0.25f);
    }
  }
}

TEST_CASE("reconstruction: every pixel is covered, with slivers and with samples on pixel centres") {
  // Samples on the centres and corners of pixels: the worst case for edges through centres.
  SampleMesh mesh(Region::whole(kGrid));
  const Picture one = [](double, double) { return Color(1, 1, 1); };
  for (const Vec2d& p : seed_points(kGrid.width, kGrid.height, 3)) {
    mesh.insert(sample_of(one, std::round(2 * p.x) / 2, std::round(2 * p.y) / 2));
  }
  for (int x = 0; x < 100; ++x) mesh.insert(sample_of(one, x + 0.5, 30.5));
  const PixelBlock pixels = rebuild(mesh);
  for (const Color& c : pixels.colors) CHECK(c == Color(1, 1, 1));
}

TEST_CASE(
    "reconstruction: a constant picture stays constant to the bit by every rule, in crowded pixels too") {
  const Picture odd = [](double, double) { return Color(0.1f, 0.7f, 1.3f); };
  SampleMesh mesh = refine(Region::whole(kGrid), odd, 300);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> x(0, kGrid.width), y(0, kGrid.height);
  for (int i = 0; i < 20000; ++i) mesh.insert(sample_of(odd, x(random), y(random)));
  for (const PixelRule rule : {PixelRule::kCenter, PixelRule::kMean, PixelRule::kArea}) {
    for (const Color& c : rebuild(mesh, rule).colors) CHECK(c == odd(0, 0));
  }
}

TEST_CASE("reconstruction: a linear picture is exact to rounding by area as well") {
  SampleMesh mesh = refine(Region::whole(kGrid), kLinear, 20000);
  REQUIRE(mesh.samples().size() > mesh.region().pixel_count());
  const PixelBlock pixels = rebuild(mesh);
  for (int y = 0; y < kGrid.height; ++y) {
    for (int x = 0; x < kGrid.width; ++x) {
      const Color expected = kLinear(x + 0.5, y + 0.5);
      CHECK(std::abs(pixels.at(x, y).x - expected.x) < 5e-7f);
      CHECK(std::abs(pixels.at(x, y).y - expected.y) < 5e-7f);
    }
  }
}

TEST_CASE("reconstruction: a pixel with several samples shows the interpolation's mean over its area") {
  // Columns of samples, so that the picture depends on x alone; two of them lie in every pixel.
  std::vector<std::pair<double, double>> columns;
  for (int i = 0; i <= 200; ++i) columns.emplace_back(0.5 * i, (i * 7919 % 101) / 100.0);
  SampleMesh mesh(Region::whole(kGrid));
  for (const auto& [x, v] : columns) {
    const auto value = static_cast<float>(v);
    for (int y = 0; y <= kGrid.height; ++y) {
      mesh.insert(sample_of([value](double, double) { return Color(value, value, value); }, x, y));
    }
  }
  const PixelBlock area = rebuild(mesh), center = rebuild(mesh, PixelRule::kCenter);
  double nearest = 1;
  for (int x = 1; x + 1 < kGrid.width; ++x) {
    const double expected = mean_between(columns, x, x + 1);
    CHECK(area.at(x, 30).x == Approx(expected).margin(1e-6));
    nearest = std::min(nearest, std::abs(center.at(x, 30).x - expected));
  }
  CHECK(nearest < 0.2);
  CHECK(std::abs(center.at(50, 30).x - mean_between(columns, 50, 51)) > 0.01);
}

TEST_CASE("reconstruction: a pixel with one sample shows the interpolation at its centre by every rule") {
  SampleMesh mesh = refine(
      Region::whole(kGrid), [](double, double) { return Color(0, 0, 0); }, 0);
  mesh.insert(sample_of([](double, double) { return Color(1, 1, 1); }, 40.1, 20.2));
  const float center = rebuild(mesh, PixelRule::kCenter).at(40, 20).x;
  CHECK((center > 0.5F && center < 1));
  for (const PixelRule rule : {PixelRule::kMean, PixelRule::kArea})
    CHECK(rebuild(mesh, rule).at(40, 20).x == center);
}

TEST_CASE("reconstruction: a pixel with several samples shows their mean by the paper's rule") {
  SampleMesh mesh = refine(
      Region::whole(kGrid), [](double, double) { return Color(0, 0, 0); }, 0);
  const auto add = [&](double x, double y, float v) {
    mesh.insert(sample_of([v](double, double) { return Color(v, v, v); }, x, y));
  };
  add(40.25, 20.25, 1.0f);
  add(40.75, 20.25, 0.5f);
  add(40.30, 20.80, 0.0f);
  const PixelBlock pixels = rebuild(mesh, PixelRule::kMean);
  CHECK(pixels.at(40, 20).x == Approx(0.5f));
  CHECK(pixels.at(60, 50).x == 0.0f);
}

TEST_CASE("reconstruction: a region has the same pixels as the whole image") {
  const SampleMesh whole = refine(Region::whole(kGrid), disc(kGrid), 800);
  std::vector<std::uint8_t> owned(static_cast<std::size_t>(kGrid.tile_count()), 0);
  for (int tile : {9, 10, 16, 17, 18}) owned[static_cast<std::size_t>(tile)] = 1;
  const Region region(kGrid, owned);
  SampleMesh part(region);
  for (const Sample& s : whole.samples()) part.insert(s);
  const auto largest_difference = [&](PixelRule rule) {
    const PixelBlock expected = rebuild(whole, rule), pixels = rebuild(part, rule);
    CHECK(pixels.bounds == region.bounds());
    float largest = 0;
    for (int tile : region.tiles()) {
      const PixelRect rect = kGrid.pixels(tile);
      for (int y = rect.y0; y < rect.y1; ++y) {
        for (int x = rect.x0; x < rect.x1; ++x)
          largest = std::max(largest, std::abs(pixels.at(x, y).x - expected.at(x, y).x));
      }
    }
    return largest;
  };
  CHECK(largest_difference(PixelRule::kCenter) == 0);
  CHECK(largest_difference(PixelRule::kMean) == 0);
  CHECK(largest_difference(PixelRule::kArea) < 1e-6f);  // triangles add up in another order
}

TEST_CASE("reconstruction: more samples reduce the error, and the rule by area has the smallest") {
  const auto truth = [](int x, int y) {  // the mean over the pixel
    constexpr int kSide = 16;
    double sum = 0;
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) sum += disc(kGrid)(x + (i + 0.5) / kSide, y + (j + 0.5) / kSide).x;
    }
    return sum / (kSide * kSide);
  };
  const auto error = [&](int samples, PixelRule rule) {
    const PixelBlock pixels = rebuild(refine(Region::whole(kGrid), disc(kGrid), samples), rule);
    double sum = 0;
    for (int y = 0; y < kGrid.height; ++y) {
      for (int x = 0; x < kGrid.width; ++x) {
        const double d = pixels.at(x, y).x - truth(x, y);
        sum += d * d;
      }
    }
    return std::sqrt(sum / (kGrid.width * kGrid.height));
  };
  CHECK(error(1500, PixelRule::kArea) < 0.5 * error(100, PixelRule::kArea));
  CHECK(error(3500, PixelRule::kArea) < 0.7 * error(3500, PixelRule::kMean));
  CHECK(error(3500, PixelRule::kArea) < 0.7 * error(3500, PixelRule::kCenter));
}

}  // namespace pprt::reconstruction_test
