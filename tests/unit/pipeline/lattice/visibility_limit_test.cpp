// How many shapes are rasterised in a sequence: as many as it is worth in the time of the picture before.
#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/hash.h"
#include "pipeline/lattice/lattice_refiner.h"

namespace pprt::visibility_limit_test {

namespace {

constexpr int kSide = 128, kSamples = 5000;
constexpr std::array<std::uint8_t, 2> kTextured = {0, 1};

// Shapes one behind the other, each of one facet that covers the picture. Counts how often one is asked for.
PrimitiveShapes walls(std::uint32_t count, std::uint32_t& asked) {
  const auto project = [&asked](std::uint32_t primitive, ImageShape& shape) {
    ++asked;
    shape.kind = ImageShape::Kind::kFacets;
    const LinearForm everywhere{1, 0, 0}, nearness{1.0 / primitive, 0, 0};
    shape.facets = {{{everywhere, everywhere, everywhere}, nearness, {0, 0, kSide, kSide}}};
  };
  const auto bound = [](std::uint32_t, std::span<ShapeBounds> bounds) {
    for (ShapeBounds& bounded : bounds) bounded = {{0, 0, kSide, kSide}, 1};
  };
  return {project, count, {}, bound};
}

// The same, of which the first `in_view` lie in the picture.
PrimitiveShapes walls_in_view(std::uint32_t count, const std::uint32_t& in_view, std::uint32_t& asked) {
  PrimitiveShapes shapes = walls(count, asked);
  shapes.bound = [&in_view](std::uint32_t first, std::span<ShapeBounds> bounds) {
    constexpr float kOut = 2 * kSide;
    for (std::size_t i = 0; i < bounds.size(); ++i)
      bounds[i] = first + i < in_view ? ShapeBounds{{0, 0, kSide, kSide}, 1}
                                      : ShapeBounds{{kOut, kOut, kOut, kOut}, 1};
  };
  return shapes;
}

enum class Stripes : std::uint8_t { kAlike, kEachItsOwn, kNoise, kNoisy };

// Two surfaces in stripes. In mirrors each sample finds another colour, in noisy ones partly.
RaySample striped(const Vec2d& point, Stripes stripes) {
  const auto place = [](double at) { return static_cast<std::uint64_t>(1024 * at); };
  RaySample seen;
  seen.primitive = static_cast<std::uint32_t>(point.x / 24) % 2 + 1;
  const auto noise = static_cast<float>(uniform(1, place(point.x), place(point.y)));
  const float brightness = stripes == Stripes::kNoise   ? noise
                           : stripes == Stripes::kNoisy ? (seen.primitive == 1 ? 0 : 0.7F) + 0.3F * noise
                           : stripes == Stripes::kAlike ? 0.5F
                           : seen.primitive == 1        ? 0.2F
                                                        : 0.8F;
  seen.color = Color(brightness, brightness, brightness);
  return seen;
}

void sample(LatticeRefiner& sampler, Stripes stripes = Stripes::kAlike) {
  for (int i = 0; i < kSamples; ++i) {
    const auto point = sampler.next_point();
    if (!point) break;
    sampler.insert(*point, striped(*point, stripes));
  }
}

// Returns how many shapes the second picture asks for, when the first one saw all of them.
std::uint32_t asked_in_second(std::uint32_t count, Stripes stripes = Stripes::kAlike) {
  std::uint32_t asked = 0;
  LatticeRefiner sampler(Region::whole({kSide, kSide, 32}), walls(count, asked));
  sample(sampler, stripes);
  REQUIRE(asked == count);
  sampler.camera_changed();
  sampler.restart();
  asked = 0;
  sample(sampler, stripes);
  return asked;
}

}  // namespace

TEST_CASE("visibility limit: what was seen counts as time that samples could have had") {
  constexpr std::uint32_t kAffordable = 100, kTooMany = 5000;
  CHECK(asked_in_second(kAffordable) == kAffordable);
  CHECK(asked_in_second(kTooMany) < kTooMany);
}

TEST_CASE("visibility limit: what a few large shapes took is not the price of many that come into view") {
  constexpr std::uint32_t kFew = 5, kMany = 400;
  std::uint32_t asked = 0, in_view = kFew;
  LatticeRefiner sampler(Region::whole({kSide, kSide, 32}), walls_in_view(kMany, in_view, asked));
  sample(sampler, Stripes::kEachItsOwn);
  sampler.camera_changed();
  sampler.restart();
  in_view = kMany;
  asked = 0;
  sample(sampler, Stripes::kEachItsOwn);
  CHECK(asked == kMany);
}

TEST_CASE("visibility limit: it holds for a picture of the coarsest nodes alone, if no more are expected") {
  const auto asked_with = [](bool is_told, std::uint32_t count) {
    std::uint32_t asked = 0;
    LatticeRefiner sampler(Region::whole({kSide, kSide, 32}), walls(count, asked));
    for (const Vec2d& point : sampler.base_points())
      sampler.insert(point, striped(point, Stripes::kEachItsOwn));
    if (is_told) sampler.expect(0);
    PixelBlock pixels;
    sampler.paint({0, 0, kSide, kSide}, pixels);
    return asked;
  };
  constexpr std::uint32_t kFew = 5, kTooMany = 5000;
  CHECK(asked_with(true, kFew) == kFew);
  CHECK(asked_with(false, kTooMany) == kTooMany);
  CHECK(asked_with(true, kTooMany) < kTooMany);
}

// Samples lie on two walls of these: silhouettes ask for no others.
constexpr std::uint32_t kWalls = 20;

// Whether a picture of walls in stripes is seen in a frame with a rate.
bool is_seen_with(const TimeForecast& forecast) {
  std::uint32_t asked = 0;
  LatticeRefiner sampler(Region::whole({kSide, kSide, 32}), walls(kWalls, asked));
  for (const Vec2d& point : sampler.base_points())
    sampler.insert(point, striped(point, Stripes::kEachItsOwn));
  sampler.expect(kSamples);
  sampler.expect_time(forecast);
  sampler.next_points(1);
  return asked >= kWalls;
}

// The more samples there are, the faster errors fall without it.
TEST_CASE("visibility limit: in a sequence seeing may take more of the time than in a still") {
  const auto asks = [](std::uint32_t count, bool is_second) {
    std::uint32_t asked = 0, in_view = 1;
    LatticeRefiner sampler(Region::whole({kSide, kSide, 32}), walls_in_view(count, in_view, asked));
    if (is_second) {
      sample(sampler, Stripes::kNoisy);
      sampler.camera_changed();
      sampler.restart();
    }
    asked = 0, in_view = count;
    sampler.expect(kSamples);
    sample(sampler, Stripes::kNoisy);
    return asked == count;
  };
  std::uint32_t in_still = 0, in_second = 0;
  for (std::uint32_t count = 50; count < 50'000; count += count / 4) {
    if (asks(count, false)) in_still = count;
    if (asks(count, true)) in_second = count;
  }
  REQUIRE(in_still > 50);
  CHECK(in_second > 1.2 * in_still);
}

TEST_CASE("visibility limit: with a rate seeing must fit beside the samples that there are") {
  const auto seeds = static_cast<double>(17 * 17);
  constexpr double kUsual_s = 5e-6, kQuick_s = 1e-9;
  CHECK(is_seen_with({.samples = kSamples, .mixed_pixel = 0, .sample_s = kUsual_s}));
  CHECK_FALSE(is_seen_with({.samples = seeds, .mixed_pixel = 0, .sample_s = kUsual_s}));
  CHECK_FALSE(is_seen_with({.samples = kSamples, .mixed_pixel = 0, .sample_s = kQuick_s}));
  // A sixth of the pairs of samples side by side differ, so a twelfth of the pixels are expected to be mixed.
  const double mixed_pixels = kSide * kSide / 12.0;
  const auto is_seen_if_painting_takes = [&](double samples) {
    return is_seen_with({.samples = kSamples, .mixed_pixel = samples / mixed_pixels, .sample_s = kUsual_s});
  };
  CHECK(is_seen_if_painting_takes(0.2 * kSamples));
  CHECK_FALSE(is_seen_if_painting_takes(2 * kSamples));
}

// What a ray of the price takes by the clock is another thing on another machine.
TEST_CASE("visibility limit: with a rate what seeing took in the last picture tells whether there is time") {
  static constexpr std::uint32_t kMany = 400;  // a few would say little
  constexpr double kSample_s = 2.4e-7;
  const auto is_second_seen = [](double seeing_s) {
    std::uint32_t asked = 0;
    LatticeRefiner sampler(Region::whole({kSide, kSide, 32}), walls(kMany, asked));
    double used_s = 0;
    const auto begin = [&] {
      for (const Vec2d& point : sampler.base_points())
        sampler.insert(point, striped(point, Stripes::kEachItsOwn));
      sampler.expect(kSamples);
      sampler.expect_time({.samples = kSamples, .mixed_pixel = 0, .sample_s = kSample_s, .used_s = [&] {
                             used_s += seeing_s;
                             return used_s;
                           }});
      sampler.next_points(1);
    };
    begin();
    REQUIRE(asked >= kMany);
    sampler.camera_changed();
    sampler.restart();
    asked = 0;
    begin();
    return asked >= kMany;
  };
  CHECK(is_second_seen(1e-4));
  CHECK_FALSE(is_second_seen(2 * kSamples * kSample_s));
}

TEST_CASE("visibility limit: samples that come from the last picture do not decide it, nor does a region") {
  std::uint32_t asked = 0;
  const TileGrid grid{kSide, kSide, 32};
  LatticeRefiner sampler(Region::whole(grid), walls(2, asked));
  sample(sampler, Stripes::kEachItsOwn);
  REQUIRE(asked == 2);
  asked = 0;
  sampler.camera_changed();
  std::vector<std::uint8_t> owned(16, 1);
  owned[0] = 0;
  sampler.set_region(Region(grid, owned));
  owned[0] = 1, owned[1] = 0;
  sampler.set_region(Region(grid, owned));
  CHECK(asked == 0);
  sampler.restart();
  for (const Vec2d& point : sampler.base_points())
    sampler.insert(point, striped(point, Stripes::kEachItsOwn));
  for (double x = 4; x < kSide; x += 8) sampler.insert({x, 4}, striped({x, 4}, Stripes::kEachItsOwn));
  CHECK(asked == 0);
  sample(sampler, Stripes::kEachItsOwn);
  CHECK(asked == 2);
}

TEST_CASE("visibility limit: a resting picture is asked again in the next frame") {
  // In the frame in which it begins it is not, however many samples there are.
  const bool is_same_frame = GENERATE(false, true);
  std::uint32_t asked = 0;
  constexpr int kExpected = 400;
  LatticeRefiner sampler(Region::whole({kSide, kSide, 32}), walls(kWalls, asked));
  for (const Vec2d& point : sampler.base_points())
    sampler.insert(point, striped(point, Stripes::kEachItsOwn));
  sampler.expect(kExpected - static_cast<double>(sampler.samples()));
  sampler.expect_time(
      {.samples = static_cast<double>(sampler.samples()), .mixed_pixel = 0, .sample_s = 5e-6});
  while (sampler.samples() < kExpected) {
    const Vec2d point = sampler.next_point().value();
    sampler.insert(point, striped(point, Stripes::kEachItsOwn));
    sampler.expect(1);
  }
  CHECK(asked < kWalls);
  if (!is_same_frame) sampler.carry_on();
  while (sampler.samples() < 3 * kExpected && asked < kWalls) {
    const auto point = sampler.next_point();
    if (!point) break;
    sampler.insert(*point, striped(*point, Stripes::kEachItsOwn));
    sampler.expect(1);
  }
  CHECK((asked >= kWalls) == !is_same_frame);
}

TEST_CASE("visibility limit: shapes that were too many to be seen took no time") {
  std::uint32_t asked = 0;
  LatticeRefiner sampler(Region::whole({kSide, kSide, 32}), walls(100000, asked));
  sampler.expect(kSamples);
  sample(sampler);
  const std::uint32_t in_first = asked;
  REQUIRE(in_first < 100000);
  for (int picture = 0; picture < 3; ++picture) {
    sampler.camera_changed();
    sampler.restart();
    asked = 0;
    sample(sampler);
    CHECK(asked <= in_first);
  }
}

TEST_CASE("visibility limit: what was not seen is not cheap for that") {
  std::uint32_t asked = 0;
  LatticeRefiner sampler(Region::whole({kSide, kSide, 32}), walls(100000, asked));
  for (int picture = 0; picture < 3; ++picture) {
    sampler.expect(kSamples);
    sample(sampler, Stripes::kEachItsOwn);
    CHECK(asked == 0);
    sampler.camera_changed();
    sampler.restart();
  }
}

TEST_CASE("visibility limit: the more of the error seeing takes away, the more of the time it may take") {
  constexpr std::uint32_t kTwoThirds = 2000, kNearlyAll = 20000;
  CHECK(asked_in_second(kTwoThirds, Stripes::kEachItsOwn) == kTwoThirds);
  CHECK(asked_in_second(kTwoThirds, Stripes::kNoise) < kTwoThirds);
  CHECK(asked_in_second(kNearlyAll, Stripes::kEachItsOwn) < kNearlyAll);
}

TEST_CASE(
    "visibility limit: where samples say nothing of their surface a first picture of few does without") {
  const auto asked_by = [](Stripes stripes, const PrimitiveLights& lights) {
    std::uint32_t asked = 0;
    LatticeRefiner sampler(Region::whole({kSide, kSide, 32}), walls(2, asked), LatticeOrder::kAdaptive, {},
                           lights);
    constexpr int kFew = 1000;
    for (int i = 0; i < kFew; ++i) {
      sampler.expect(kFew - i);
      const auto point = sampler.next_point();
      if (!point) break;
      sampler.insert(*point, striped(*point, stripes));
    }
    return asked;
  };
  static constexpr std::array<LitSurface, 3> kAllKnown = {
      {{}, {LitShape::kRound, true}, {LitShape::kRound, true}}};
  const PrimitiveLights lights = {kAllKnown, [](auto, auto, auto, UnshadowedLight&) {}};
  CHECK(asked_by(Stripes::kNoise, {}) == 0);
  CHECK(asked_by(Stripes::kEachItsOwn, {}) == 2);
  CHECK(asked_by(Stripes::kNoise, lights) == 2);  // what they differ by is their lights
}

// On the left all is known and nothing differs. On the right samples say nothing of their surface.
TEST_CASE("visibility limit: what is known counts by how far it differs, not by how much of it there is") {
  static constexpr std::array<LitSurface, 2> kFirstIsKnown = {{{}, {LitShape::kRound, true}}};
  const auto asked_where_known = [&](float difference) {
    std::uint32_t asked = 0;
    LatticeRefiner sampler(Region::whole({kSide, kSide, 32}), walls(2, asked), LatticeOrder::kAdaptive, {},
                           {kFirstIsKnown, [](auto, auto, auto, UnshadowedLight&) {}});
    constexpr int kFew = 1000;
    for (int i = 0; i < kFew; ++i) {
      sampler.expect(kFew - i);
      const auto point = sampler.next_point();
      if (!point) break;
      RaySample seen = striped(*point, Stripes::kNoise);
      seen.primitive = point->x < 0.5 * kSide ? 1 : 2;
      const bool is_odd = (static_cast<int>(point->x) + static_cast<int>(point->y)) / 8 % 2 == 1;
      const float known = 0.5F + (is_odd ? difference : -difference);
      if (seen.primitive == 1) seen.color = Color(known, known, known);
      sampler.insert(*point, seen);
    }
    return asked;
  };
  CHECK(asked_where_known(0) == 0);
  CHECK(asked_where_known(0.5F) == 2);
}

TEST_CASE(
    "visibility limit: what seeing would bring is learned anew when pictures change, and at once when "
    "cleared") {
  constexpr std::uint32_t kSome = 300;
  std::uint32_t asked = 0;
  LatticeRefiner sampler(Region::whole({kSide, kSide, 32}), walls(kSome, asked));
  const auto asked_in_next = [&](Stripes stripes) {
    sampler.camera_changed();
    sampler.restart();
    asked = 0;
    sample(sampler, stripes);
    return asked;
  };
  sample(sampler, Stripes::kNoise);
  REQUIRE(asked == kSome);
  CHECK(asked_in_next(Stripes::kNoise) == 0);
  CHECK(asked_in_next(Stripes::kEachItsOwn) == 0);
  for (int picture = 0; picture < 5; ++picture) asked_in_next(Stripes::kEachItsOwn);
  CHECK(asked_in_next(Stripes::kEachItsOwn) == kSome);

  for (int picture = 0; picture < 8; ++picture) asked_in_next(Stripes::kNoise);
  REQUIRE(asked == 0);
  sampler.clear();
  sampler.expect(kSamples);
  sample(sampler, Stripes::kEachItsOwn);
  CHECK(asked == kSome);
}

TEST_CASE("visibility limit: what has no shape is not known for being asked again") {
  std::uint32_t asked = 0;
  PrimitiveShapes shapes = walls(2, asked);
  shapes.project = [&asked](std::uint32_t, ImageShape& shape) {
    ++asked;
    shape.kind = ImageShape::Kind::kUnknown;
  };
  VisibilityBuffer visibility(kSide, kSide, shapes);
  for (int time = 0; time < 2; ++time) {
    visibility.limit(1000);
    REQUIRE(visibility.is_known());  // nothing has been projected yet
    visibility.tile(0, 0);
    CHECK_FALSE(visibility.is_known());
  }
  // With as many samples as may come it is asked once.
  asked = 0;
  LatticeRefiner sampler(Region::whole({kSide, kSide, 32}), shapes);
  sample(sampler, Stripes::kEachItsOwn);
  CHECK(asked == 2);
}

TEST_CASE("visibility limit: what was not to be seen in one picture may be seen in the next") {
  std::uint32_t asked = 0;
  VisibilityBuffer visibility(kSide, kSide, walls(2, asked));
  visibility.limit(0);
  CHECK_FALSE(visibility.is_known());
  visibility.forget();
  visibility.limit(1000);
  CHECK(visibility.is_known());
}

TEST_CASE("visibility limit: seeds do not decide it") {
  std::uint32_t asked = 0;
  LatticeRefiner sampler(Region::whole({kSide, kSide, 32}), walls(100000, asked), LatticeOrder::kAdaptive,
                         {kTextured, [](auto...) { return std::optional(Color(1, 1, 1)); }});
  sampler.expect(kSamples);
  RaySample seen;
  seen.primitive = 1;
  for (const Vec2d& point : sampler.base_points()) sampler.insert(point, seen);
  CHECK(asked == 0);
  sample(sampler);
  CHECK(asked < 100000);
}

}  // namespace pprt::visibility_limit_test
