// What a frame with a rate sees in its time, and what it tells of that.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <vector>

#include "pipeline/lattice/lattice_refiner.h"
#include "unit/pipeline/rectangles.h"

namespace pprt::visibility_time_test {
namespace {

using test::Rectangle;

constexpr int kSide = 128, kTile = 32;
constexpr double kSamples = 5000, kSample_s = 1e-5;

// As wide as the squares of the coarsest grid, so that their corners lie in each.
std::vector<Rectangle> stripes() {
  std::vector<Rectangle> stripes;
  for (double x = 0.5; x < kSide; x += 8) stripes.push_back({x, -1, x + 8, kSide + 1, 1});
  return stripes;
}

// A picture in a frame with a rate. Samples meet one surface alone, so no pixel is expected to show several,
// unless they meet two.
struct Frame {
  explicit Frame(const std::vector<Rectangle>& rectangles, bool meets_two = false)
      : sampler(Region::whole({kSide, kSide, kTile}), test::shapes_of(rectangles)), is_mixed(meets_two) {}

  // Returns how many pixels show several surfaces, as far as that is known.
  std::size_t begin(double mixed_pixel, double seeing_s = 0, double samples = kSamples) {
    for (const Vec2d& point : sampler.base_points()) {
      RaySample seen;
      seen.primitive = is_mixed && std::fmod(point.x, 48) > 20 ? 2 : 1;
      sampler.insert(point, seen);
    }
    sampler.expect(samples);
    sampler.expect_time({.samples = samples,
                         .mixed_pixel = mixed_pixel,
                         .sample_s = kSample_s,
                         .used_s = [this, seeing_s] { return used_s += seeing_s; },
                         .pause = [this] { ++pauses; }});
    sampler.next_points(1);
    return sampler.mixed_pixels();
  }

  void end() {
    sampler.camera_changed();
    sampler.restart();
  }

  // Pixels of several surfaces by tile, as balancing is told.
  std::vector<std::int64_t> told() const {
    std::vector<TileWeights> weights;
    sampler.weigh(weights);
    std::vector<std::int64_t> mixed;
    for (const TileWeights& tile : weights) mixed.push_back(tile.mixed_pixels);
    return mixed;
  }

  LatticeRefiner sampler;
  bool is_mixed;
  double used_s = 0;
  int pauses = 0;
};

}  // namespace

TEST_CASE("visibility time: what turns out to take too long to paint counts as unseen, and is remembered") {
  const auto known = static_cast<double>(Frame(stripes()).begin(0));
  REQUIRE(known >= kSide * 15);
  const double affordable = 0.2 * kSamples / known, too_much = 1.1 * kSamples / known;
  CHECK(Frame(stripes()).begin(affordable) > 0);
  CHECK(Frame(stripes()).begin(affordable, 0.9 * kSamples * kSample_s) == 0);
  Frame again(stripes());
  again.begin(affordable);
  again.end();
  CHECK(again.begin(affordable) > 0);
  Frame dear(stripes());
  CHECK(dear.begin(too_much) == 0);
  CHECK(dear.pauses > 0);  // it was seen
  dear.end();
  dear.pauses = 0;
  CHECK(dear.begin(too_much) == 0);
  CHECK(dear.pauses == 0);
}

TEST_CASE("visibility time: messages are looked for after each tile that is seen") {
  Frame frame(stripes());
  frame.begin(0);
  CHECK(frame.pauses == (kSide / kTile) * (kSide / kTile));
}

TEST_CASE(
    "visibility time: balancing is told of pixels of several surfaces, of unknown tiles by the others") {
  Frame frame({{16.5, 16.5, 60, 60, 1}, {70, 70, 90, 90, 2}});
  CHECK(frame.told() == std::vector<std::int64_t>(16, 0));
  const std::size_t mixed = frame.begin(0);
  const std::vector<std::int64_t> told = frame.told();
  CHECK(std::accumulate(told.begin(), told.end(), std::int64_t{0}) == static_cast<std::int64_t>(mixed));
  CHECK((told[0] > 0 && told[3] == 0 && told[15] == 0));
  // The next picture has no time to see them.
  frame.end();
  CHECK(frame.begin(0, 0, 300) == 0);
  CHECK(frame.told() == told);
  // A tile is another region's while this one is seen, and comes back.
  frame.end();
  const TileGrid grid{kSide, kSide, kTile};
  std::vector<std::uint8_t> owned(16, 0);
  owned[0] = owned[1] = 1;
  Frame part({{16.5, 16.5, 60, 60, 1}});
  part.sampler.set_region(Region(grid, owned));
  part.begin(0);
  owned[2] = 1;
  part.sampler.set_region(Region(grid, owned));
  const std::vector<std::int64_t> then = part.told();
  CHECK(then[2] == Approx(0.5 * static_cast<double>(then[0] + then[1])).margin(0.5));
  part.sampler.clear();
  CHECK(part.told()[0] == 0);
}

TEST_CASE("visibility time: a picture is as fine as the samples allow that are left by seeing and painting") {
  // A line that only the points of the finest buffer meet.
  std::vector<Rectangle> lines = stripes();
  for (Rectangle& stripe : lines) stripe.nearness = 0.5;
  lines.push_back({20.2, -1, 20.3, kSide + 1, 1});
  const auto sees_line = [&](double mixed_pixel, double samples) {
    Frame with(lines, true), without(stripes(), true);
    return with.begin(mixed_pixel, 0, samples) != without.begin(mixed_pixel, 0, samples);
  };
  constexpr double kMany = 10'000;
  CHECK(sees_line(0, kMany));
  CHECK_FALSE(sees_line(0, 0.3 * kMany));
  CHECK_FALSE(sees_line(1.5, kMany));
}

}  // namespace pprt::visibility_time_test
