// Silhouettes of what samples have found: by themselves, and in pictures for which there is no time to see.
#include "pipeline/silhouettes/sampled_silhouettes.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/lattice/lattice_refiner.h"
#include "unit/pipeline/lattice/disc_before_wall.h"
#include "unit/pipeline/lattice/refined_picture.h"

namespace pprt::sampled_silhouettes_test {
namespace {

constexpr double kX = 30.3, kY = 28.6, kRadius = 9.2;
constexpr std::uint32_t kNothing = 0, kWall = 1, kDisc = 2;

bool is_on_disc(double x, double y) {
  return std::hypot(x - kX, y - kY) < kRadius;
}

SampledSilhouettes silhouettes_of(std::span<const std::uint32_t> surfaces = {}) {
  SampledSilhouettes silhouettes(test::disc_before_wall(kX, kY, kRadius).project, 2, surfaces);
  silhouettes.show(true);
  return silhouettes;
}

}  // namespace

TEST_CASE("sampled silhouettes: the nearest surface of those named is seen, the background behind all") {
  SampledSilhouettes silhouettes = silhouettes_of();
  for (double y = 15.5; y < 45; y += 1.7) {
    for (double x = 15.5; x < 45; x += 1.3) {
      const bool on_disc = is_on_disc(x, y);
      CHECK(silhouettes.nearest({x, y}, std::array{kWall, kDisc, kWall}) == (on_disc ? kDisc : kWall));
      CHECK(silhouettes.nearest({x, y}, std::array{kNothing, kDisc}) == (on_disc ? kDisc : kNothing));
      CHECK(silhouettes.nearest({x, y}, std::array{kDisc}) ==
            (on_disc ? std::optional(kDisc) : std::nullopt));
    }
  }
}

TEST_CASE("sampled silhouettes: shares of a square are those of its area, as near as eight points tell") {
  SampledSilhouettes silhouettes = silhouettes_of();
  constexpr int kPoints = 32;
  double error = 0;
  int partly = 0;
  for (int y = 18; y < 40; ++y) {
    for (int x = 20; x < 42; ++x) {
      int covered = 0;
      for (int i = 0; i < kPoints * kPoints; ++i)
        covered += is_on_disc(x + (i % kPoints + 0.5) / kPoints, y + (i / kPoints + 0.5) / kPoints) ? 1 : 0;
      const double disc = static_cast<double>(covered) / (kPoints * kPoints);
      const std::array<float, 4> before_wall =
          silhouettes.shares(Vec2d(x, y), 1, std::array{kWall, kDisc, kDisc, kWall}).value();
      CHECK(before_wall[1] == Approx(disc).margin(0.2));
      if (disc > 0 && disc < 1) error += std::abs(before_wall[1] - disc), ++partly;
      CHECK(before_wall[0] == Approx(1 - before_wall[1]).margin(1e-6));
      CHECK((before_wall[2] == 0 && before_wall[3] == 0));
      const std::array<float, 4> alone =
          silhouettes.shares(Vec2d(x, y), 1, std::array{kDisc, kNothing, kDisc, kNothing}).value();
      CHECK(alone[0] == before_wall[1]);
      CHECK(alone[1] == Approx(1 - alone[0]).margin(1e-6));
    }
  }
  REQUIRE(partly > 50);
  CHECK(error < 0.06 * partly);
}

TEST_CASE(
    "sampled silhouettes: nothing is said of surfaces of several primitives, nor of those without a shape") {
  const std::vector<std::uint32_t> joined = {0, 1, 2, 2};
  SampledSilhouettes silhouettes = silhouettes_of(joined);
  CHECK_FALSE(silhouettes.nearest({kX, kY}, std::array{kWall, kDisc}));
  CHECK_FALSE(silhouettes.shares({kX, kY}, 1, std::array{kWall, kDisc, kWall, kWall}));
  CHECK(silhouettes.nearest({kX, kY}, std::array{kWall}) == kWall);

  SampledSilhouettes without(
      [](std::uint32_t, ImageShape& shape) { shape.kind = ImageShape::Kind::kUnknown; }, 2, {});
  without.show(true);
  CHECK_FALSE(without.nearest({kX, kY}, std::array{kWall, kDisc}));
  SampledSilhouettes of_nothing({}, 0, {}),
      of_too_many(test::disc_before_wall(0, 0, 1).project, 1U << 24, {});
  for (SampledSilhouettes* hidden : {&of_nothing, &of_too_many}) {
    hidden->show(true);
    CHECK_FALSE(hidden->are_shown());
  }
}

TEST_CASE("sampled silhouettes: shapes are projected anew when the eye has moved") {
  double x = kX;
  SampledSilhouettes silhouettes(
      [&x](std::uint32_t p, ImageShape& to) { test::disc_before_wall(x, kY, kRadius).project(p, to); }, 2,
      {});
  silhouettes.show(true);
  const std::array around = {kWall, kDisc};
  REQUIRE(silhouettes.nearest({kX, kY}, around) == kDisc);
  x = kX + 2 * kRadius;
  CHECK(silhouettes.nearest({kX, kY}, around) == kDisc);
  silhouettes.forget();
  CHECK(silhouettes.nearest({kX, kY}, around) == kWall);
  CHECK(silhouettes.nearest({x, kY}, around) == kDisc);
}

namespace {

// Colours of each surface, or such of which a sample says nothing about the next.
enum class Colors : std::uint8_t { kEven, kNoise };

// Shows a bright disc before a dark wall, 64 x 64 pixels, by 81 + 60 samples a frame. A frame is told how
// many samples take as long as to paint a pixel of both.
class Picture {
 public:
  explicit Picture(Colors colors, bool has_shapes = true)
      : colors_(colors),
        refiner_(Region::whole({kSize, kSize, 32}), has_shapes ? shapes() : PrimitiveShapes{}) {}

  double error_with(double mixed_pixel) {
    const auto sample_at = [&](double x, double y) {
      RaySample seen;
      seen.primitive = is_in(x, y) ? kDisc : kWall;
      seen.color = color_at(x, y);
      return seen;
    };
    for (const Vec2d& point : refiner_.base_points()) refiner_.insert(point, sample_at(point.x, point.y));
    refiner_.expect(kSamples);
    refiner_.expect_time({.samples = 1000, .mixed_pixel = mixed_pixel, .sample_s = 1e-5});
    const PixelBlock picture = test::picture_of(refiner_, kSize, kSamples, sample_at);
    return test::error_of(picture, 0, kSize, [&](double x, double y) { return color_at(x, y); });
  }

  void move_eye(double by) {
    moved_ += by;
    refiner_.camera_changed();
    refiner_.restart();
  }

  std::uint32_t projected() const { return projected_; }  // how often a primitive was

 private:
  static constexpr int kSize = 64, kSamples = 60;

  bool is_in(double x, double y) const { return is_on_disc(x - moved_, y); }
  Color color_at(double x, double y) const {
    const double wave = 0.5 + 0.5 * std::sin(1e3 * x + 1.7e3 * y);
    const auto value = static_cast<float>(colors_ == Colors::kNoise ? wave : is_in(x, y) ? 0.9 : 0.1);
    return Color(value, value, value);
  }
  PrimitiveShapes shapes() {
    PrimitiveShapes found;
    found.count = 2;
    found.project = [this](std::uint32_t p, ImageShape& to) {
      ++projected_;
      test::disc_before_wall(kX + moved_, kY, kRadius).project(p, to);
    };
    found.bound = [](std::uint32_t, std::span<ShapeBounds> bounds) {
      for (ShapeBounds& bounded : bounds) bounded = {{0, 0, kSize, kSize}, 1};
    };
    return found;
  }

  Colors colors_;
  double moved_ = 0;  // pixels to the right
  std::uint32_t projected_ = 0;
  LatticeRefiner refiner_;
};

}  // namespace

constexpr double kTooDear = 1e6;

TEST_CASE("sampled silhouettes: a frame that cannot be seen in time shows them where seeing would pay") {
  Picture all_known(Colors::kEven), known(Colors::kEven), blind(Colors::kEven, false);
  const double seen = all_known.error_with(0), unseen = known.error_with(kTooDear);
  CHECK(known.projected() > 0);
  CHECK(unseen < 0.3 * blind.error_with(kTooDear));
  CHECK(seen < unseen);
  Picture mirrored(Colors::kNoise);
  mirrored.error_with(kTooDear);
  CHECK(mirrored.projected() == 0);
}

TEST_CASE("sampled silhouettes: the next frame shows them where they are then") {
  Picture known(Colors::kEven), blind(Colors::kEven, false);
  for (Picture* picture : {&known, &blind}) {
    picture->error_with(kTooDear);
    picture->move_eye(3);
  }
  CHECK(known.error_with(kTooDear) < 0.5 * blind.error_with(kTooDear));
}

}  // namespace pprt::sampled_silhouettes_test
