// What a surface is taken to show at a square's corners: for every set of corners that lie on it.
#include "pipeline/lattice/surface_colors.h"

#include <array>
#include <bit>
#include <catch2/catch.hpp>
#include <random>

#include "unit/pipeline/lattice/disc_before_wall.h"

namespace pprt::surface_colors_test {
namespace {

constexpr int kSize = 64;
constexpr std::uint32_t kWall = 1, kDisc = 2;
constexpr std::array kLearned = {Basis::kSome, Basis::kOne, Basis::kNearSample};

}  // namespace

TEST_CASE(
    "surface colours: a corner elsewhere takes on those beside it, else that across, else a sample near by") {
  VisibilityBuffer visibility(kSize, kSize, test::disc_before_wall(28, 28, 3));
  REQUIRE(visibility.is_known());
  LocalErrors errors(kSize * kPixelSide, kSize * kPixelSide);
  SurfaceTextures textures({}, visibility);
  SurfaceLights lights({}, visibility);
  SurfaceShare share;
  for (int level = 0; level < kErrorLevels; ++level)
    for (const Basis basis : kLearned)
      share.learn(basis, level, basis == Basis::kSome ? 700 : basis == Basis::kOne ? 400 : 200, 1000);
  share.update();
  std::mt19937 random(11);
  const auto any = [&] { return std::uniform_real_distribution<float>(0, 1)(random); };
  const LatticeNode corner{3 * kBaseSide, 3 * kBaseSide};
  const Vec2d middle(28, 28);
  const int level = errors.near(node_at(middle)).level;
  for (unsigned on_it = 0; on_it < 16; ++on_it) {
    for (const bool has_near : {false, true}) {
      SurfaceSamples samples(kSize * kPixelSide, kSize * kPixelSide);
      const float near = any();
      if (has_near) samples.add(node_at(middle), NodeValue(float4{near}, kDisc));
      SquareCorners corners;
      std::array<float, 4> shown;
      for (std::size_t i = 0; i < 4; ++i) {
        shown[i] = any();
        corners[i] = NodeValue(float4{shown[i]}, (on_it >> i & 1U) != 0 ? kDisc : kWall);
      }
      const auto is_on = [&](std::size_t i) { return (on_it >> i & 1U) != 0; };
      std::array<float, 4> expected = shown;
      const int count = std::popcount(on_it);
      const Basis basis = count == 0 ? Basis::kNearSample : count == 1 ? Basis::kOne : Basis::kSome;
      for (std::size_t i = 0; i < 4; ++i) {
        if (is_on(i) || (count == 0 && !has_near)) continue;
        float sum = 0, beside = 0;
        for (const std::size_t k : {i ^ 1U, i ^ 2U})
          if (is_on(k)) sum += shown[k], ++beside;
        const float taken = count == 0 ? near : beside > 0 ? sum / beside : shown[i ^ 3U];
        expected[i] += (taken - shown[i]) * share.of(basis, level);
      }
      SurfaceColors colors(samples, errors, share, textures, lights);
      const Square square{corner, kBaseSide, corners};
      INFO("corners " << on_it << ", a sample near by " << has_near);
      for (std::size_t i = 0; i < 4; ++i) {
        std::array<float, 4> weights{};
        weights[i] = 1;
        CHECK(colors.in_pixel(square, {kDisc, kDisc, middle}, middle, weights)[0] == Approx(expected[i]));
      }
    }
  }
}

}  // namespace pprt::surface_colors_test
