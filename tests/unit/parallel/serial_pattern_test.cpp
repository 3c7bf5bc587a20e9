// The distance of a sample pattern to the serial one: the formula, and what it says of real frames.
#include "parallel/serial_pattern.h"

#include <catch2/catch.hpp>
#include <utility>

#include "parallel/virtual_ranks.h"
#include "unit/each_sampler.h"
#include "unit/parallel/virtual_run.h"

namespace pprt::serial_pattern_test {
namespace {

std::vector<Sample> at(std::initializer_list<std::pair<double, double>> points) {
  std::vector<Sample> samples;
  for (const auto& [x, y] : points) {
    samples.emplace_back();
    samples.back().x = x;
    samples.back().y = y;
  }
  return samples;
}

// A bright half of the image beside a dark one, along a diagonal: most samples belong there.
Probe diagonal() {
  return {[](const Camera&) {},
          [](double x, double y) {
            RaySample sample;
            sample.color = Color(static_cast<float>(x > y), 0.5f, 0.5f);
            sample.primitive = x > y ? 1 : 2;
            return sample;
          },
          [](const Vec3f&, bool) { return true; }, [] { return RayCounts(); }};
}

SessionSettings settings(SamplerChoice sampler) {
  SessionSettings s{.sampler = sampler};
  s.width = 96, s.height = 96;
  s.clock = ClockKind::kWork;
  s.frames_per_second = 4;
  s.budget_units = 2'000'000;
  s.report_samples = true;
  return s;
}

FinishedFrame third_frame(int ranks, SessionSettings s) {
  s.cast = CastChoice::kOff;
  FinishedFrame last;
  run_virtual_ranks(
      ranks, s, [](int) { return diagonal(); }, still_or_pan(s, 3),
      [&](FinishedFrame&& frame) { last = std::move(frame); });
  return last;
}

}  // namespace

TEST_CASE("serial pattern: the distance of two patterns is the share of samples in other buckets") {
  const std::vector<Sample> a = at({{1, 1}, {9.99, 9.99}, {15, 5}, {5, 25}});
  CHECK(bucket_distance(a, a) == 0);
  CHECK(bucket_distance(a, at({{5, 5}, {3, 3}, {11, 1}, {1, 29}})) == 0);
  CHECK(bucket_distance(a, at({{5, 5}, {3, 3}, {11, 1}, {1, 31}})) == 0.25);  // one of four has moved
  CHECK(bucket_distance(a, at({{55, 5}, {53, 3}})) == 1);
  CHECK(bucket_distance(a, at({{1, 1}})) == 0.6);  // |2-1| + 1 + 1 of five
  CHECK(bucket_distance({}, {}) == 0);
  CHECK(bucket_distance(a, {}) == 1);
}

TEST_CASE("serial pattern: samples near borders are those from which a step leads to another region") {
  // Two columns of tiles, 8 pixels wide, and two owners.
  const TileGrid grid(16, 16, 8);
  const std::vector<std::int32_t> owners = {0, 1, 0, 1};
  CHECK(samples_near_borders(at({{5, 5}, {6.5, 1}, {8, 16}, {9.5, 8}, {11, 3}}), grid, owners, 2) == 3);
  CHECK(samples_near_borders(at({{0, 0}, {16, 16}, {16, 0}}), grid, owners, 2) == 0);
  CHECK(samples_near_borders(at({{7, 7}}), grid, std::vector<std::int32_t>(4, 3), 2) == 0);
}

EACH_SAMPLER_TEST_CASE(
    "serial pattern: the serial sampler makes as many samples as asked for, where the picture calls for "
    "them") {
  const SessionSettings s = settings(sampler);
  const std::vector<Sample> samples = serial_samples(s, camera_before_disc(96, 96), 0, 1500, diagonal());
  CHECK(samples.size() == 1500);
  std::size_t near_edge = 0;
  for (const Sample& sample : samples) near_edge += std::abs(sample.x - sample.y) < 10;
  // A fifth of the area lies near the edge. More than a third of the samples on a lattice are a grid over all
  // of it.
  CHECK(near_edge > (sampler == SamplerChoice::kDelaunay ? 750 : 500));
}

EACH_SAMPLER_TEST_CASE("serial pattern: one rank has it, many without balancing have not") {
  SessionSettings s = settings(sampler);
  if (sampler == SamplerChoice::kDelaunay) {
    s.learned_weights = GENERATE(true, false);
    s.pixel_rule = GENERATE(PixelRule::kEdges, PixelRule::kArea);
  }
  // A lattice is refined by how many samples it will have: with a larger budget it learns that on the way.
  s.budget_units = 400'000;
  CHECK(distance_to_serial(third_frame(1, s), s, diagonal()) == 0);
  s.balance = BalanceMode::kNone;
  const double nine = distance_to_serial(third_frame(9, s), s, diagonal());
  CHECK(nine > 0.05);
  CHECK(nine < 0.6);
}

}  // namespace pprt::serial_pattern_test
