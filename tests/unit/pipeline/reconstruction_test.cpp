#include "pipeline/reconstruction.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "synthetic_image.h"

namespace pprt {
namespace {

const TileGrid kGrid{100, 60, 16};

RegionPixels rebuild(const SampleMesh& mesh) {
  RegionPixels pixels;
  ReconstructionBuffers buffers;
  reconstruct(mesh, mesh.region().bounds(), pixels, buffers);
  return pixels;
}

// Seeds only: nowhere two in a pixel, so nothing is averaged.
const Picture kLinear = [](double x, double y) {
  return Color(static_cast<float>(0.003 * x + 0.002 * y), static_cast<float>(0.9 - 0.004 * x), 0.25f);
};

}  // namespace

TEST_CASE("a linear picture is reconstructed to rounding, a constant exactly") {
  const RegionPixels pixels = rebuild(refine(Region::whole(kGrid), kLinear, 0));
  for (int y = 0; y < kGrid.height; ++y) {
    for (int x = 0; x < kGrid.width; ++x) {
      const Color expected = kLinear(x + 0.5, y + 0.5);
      CHECK(std::abs(pixels.at(x, y).x - expected.x) < 3e-7f);
      CHECK(std::abs(pixels.at(x, y).y - expected.y) < 3e-7f);
      CHECK(pixels.at(x, y).z == 0.25f);
    }
  }
}

TEST_CASE("every pixel is covered, slivers and points on pixel centres included") {
  // Samples on the centres and corners of pixels: the worst case for edges through centres.
  SampleMesh mesh(Region::whole(kGrid));
  const Picture one = [](double, double) { return Color(1, 1, 1); };
  for (const Vec2d& p : seed_points(kGrid.width, kGrid.height, 3)) {
    mesh.insert(sample_of(one, std::round(2 * p.x) / 2, std::round(2 * p.y) / 2));
  }
  for (int x = 0; x < 100; ++x) mesh.insert(sample_of(one, x + 0.5, 30.5));
  const RegionPixels pixels = rebuild(mesh);
  for (const Color& c : pixels.colors) CHECK(c == Color(1, 1, 1));
}

TEST_CASE("a pixel with several samples shows their average") {
  SampleMesh mesh = refine(
      Region::whole(kGrid), [](double, double) { return Color(0, 0, 0); }, 0);
  const auto add = [&](double x, double y, float v) {
    mesh.insert(sample_of([v](double, double) { return Color(v, v, v); }, x, y));
  };
  add(40.25, 20.25, 1.0f);
  add(40.75, 20.25, 0.5f);
  add(40.30, 20.80, 0.0f);
  const RegionPixels pixels = rebuild(mesh);
  CHECK(pixels.at(40, 20).x == Approx(0.5f));
  CHECK(pixels.at(60, 50).x == 0.0f);
}

TEST_CASE("regions reconstruct the same pixels as the whole") {
  const SampleMesh whole = refine(Region::whole(kGrid), disc(kGrid), 800);
  const RegionPixels expected = rebuild(whole);
  std::vector<std::uint8_t> owned(static_cast<std::size_t>(kGrid.tile_count()), 0);
  for (int tile : {9, 10, 16, 17, 18}) owned[static_cast<std::size_t>(tile)] = 1;
  const Region region(kGrid, owned);
  SampleMesh part(region);
  for (const Sample& s : whole.samples()) part.insert(s);
  const RegionPixels pixels = rebuild(part);
  CHECK(pixels.bounds == region.bounds());
  for (int tile : region.tiles()) {
    const PixelRect rect = kGrid.pixels(tile);
    for (int y = rect.y0; y < rect.y1; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x) CHECK(pixels.at(x, y) == expected.at(x, y));
    }
  }
}

TEST_CASE("the picture comes nearer to the truth with more samples") {
  const auto error = [](int samples) {
    const RegionPixels pixels = rebuild(refine(Region::whole(kGrid), disc(kGrid), samples));
    double sum = 0;
    for (int y = 0; y < kGrid.height; ++y) {
      for (int x = 0; x < kGrid.width; ++x) {
        const double d = pixels.at(x, y).x - disc(kGrid)(x + 0.5, y + 0.5).x;
        sum += d * d;
      }
    }
    return std::sqrt(sum / (kGrid.width * kGrid.height));
  };
  CHECK(error(1500) < 0.5 * error(100));
}

}  // namespace pprt
