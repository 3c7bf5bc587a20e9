// What the settings make of a rank's sampler.
#include "parallel/exchange/samplers.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "parallel/settings/work_units.h"
#include "pipeline/lattice/lattice_refiner.h"

namespace pprt::samplers_test {
namespace {

constexpr int kSide = 64, kTile = 16;

SessionSettings settings_of(SamplerChoice sampler) {
  SessionSettings settings{.sampler = sampler};
  settings.width = settings.height = kSide;
  return settings;
}

// The left half of the picture is rank 0's, the rest rank 1's.
Partition halves(int ranks) {
  const TileGrid grid{kSide, kSide, kTile};
  Partition partition{grid, ranks, {}, std::vector<std::uint64_t>(16, 0)};
  for (int tile = 0; tile < 16; ++tile) partition.owner.push_back(ranks > 1 && tile % 4 > 1 ? 1 : 0);
  return partition;
}

const Probe kNoShapes;

// A picture that has detail everywhere.
Sample seen_at(const Vec2d& point) {
  Sample sample;
  sample.x = point.x, sample.y = point.y;
  const double wave = std::sin(0.9 * point.x) * std::cos(1.3 * point.y);
  sample.ray.color = Color(static_cast<float>(0.5 + 0.4 * wave), 0.5F, 0.25F);
  sample.ray.primitive = 1;
  return sample;
}

// The points of the first samples.
std::vector<Vec2d> points_of(Sampler& sampler, int count) {
  std::vector<Vec2d> points;
  for (int i = 0; i < count; ++i) {
    const auto point = sampler.next_point();
    if (!point) break;
    sampler.insert(seen_at(*point));
    points.push_back(*point);
  }
  return points;
}

}  // namespace

TEST_CASE("samplers: a lattice knows for how many samples it is asked, each region for its share") {
  constexpr int kSamples = 700;
  for (const int ranks : {1, 2}) {
    SessionSettings settings = settings_of(SamplerChoice::kAuto);
    const Partition partition = halves(ranks);
    const auto points_with = [&](std::uint64_t samples) {
      settings.stop.samples = samples;
      SamplerWithExchange made = make_sampler(settings, partition, 0, kNoShapes);
      made.sampler->clear(false);
      return points_of(*made.sampler, kSamples / ranks);
    };
    const auto points_when_told = [&](double samples) {
      LatticeRefiner refiner(region_of(partition, 0), {});
      std::vector<Vec2d> points;
      refiner.expect(samples);
      for (int i = 0; i < kSamples / ranks; ++i) {
        const auto point = refiner.next_point();
        if (!point) break;
        refiner.insert(*point, seen_at(*point).ray);
        points.push_back(*point);
      }
      return points;
    };
    INFO(ranks << " ranks");
    CHECK(points_with(4000) == points_when_told(4000.0 / ranks));
    CHECK(points_with(1000) == points_when_told(1000.0 / ranks));
    CHECK(points_with(4000) != points_with(1000));
    CHECK(points_with(4000) != points_with(0));
  }
}

TEST_CASE("samplers: a region that grows is asked for more, and a picture that begins anew for all again") {
  SessionSettings settings = settings_of(SamplerChoice::kAuto);
  settings.stop.samples = 2000;
  const Partition two = halves(2), one = halves(1);
  SamplerWithExchange grows = make_sampler(settings, two, 0, kNoShapes);
  grows.sampler->clear(false);
  points_of(*grows.sampler, 100);
  grows.exchange->transfer(one);
  const std::vector<Vec2d> after = points_of(*grows.sampler, 900);
  LatticeRefiner refiner(region_of(two, 0), {});
  refiner.expect(1000);
  for (int i = 0; i < 100; ++i) {
    const auto point = refiner.next_point();
    REQUIRE(point);
    refiner.insert(*point, seen_at(*point).ray);
  }
  refiner.set_region(region_of(one, 0));
  refiner.expect(2000 - 100);
  std::vector<Vec2d> expected;
  for (int i = 0; i < 900; ++i) {
    const auto point = refiner.next_point();
    REQUIRE(point);
    refiner.insert(*point, seen_at(*point).ray);
    expected.push_back(*point);
  }
  CHECK(after == expected);
  SamplerWithExchange fresh = make_sampler(settings, one, 0, kNoShapes);
  fresh.sampler->clear(false);
  const std::vector<Vec2d> first = points_of(*fresh.sampler, 500);
  fresh.sampler->clear(false);
  CHECK(points_of(*fresh.sampler, 500) == first);
}

TEST_CASE("samplers: samples are kept where others ask for them, a later picture or a report") {
  const auto kept = [](int ranks, bool is_still, bool reports) {
    SessionSettings settings = settings_of(SamplerChoice::kAuto);
    settings.is_still = is_still, settings.report_samples = reports;
    const SamplerWithExchange made = make_sampler(settings, halves(ranks), 0, kNoShapes);
    points_of(*made.sampler, 50);
    REQUIRE(made.sampler->size() == 50);
    return made.sampler->samples().size();
  };
  CHECK(kept(1, true, false) == 0);
  CHECK(kept(1, true, true) == 50);
  CHECK(kept(1, false, false) == 50);
  CHECK(kept(2, true, false) == 50);
}

TEST_CASE("samplers: each choice has its own order, traits and exchange") {
  const auto points = [](SamplerChoice choice) {
    const SamplerWithExchange made = make_sampler(settings_of(choice), halves(1), 0, kNoShapes);
    return points_of(*made.sampler, 300);
  };
  CHECK(points(SamplerChoice::kAuto) != points(SamplerChoice::kGrid));
  const SamplerTraits lattice = traits_of(SamplerChoice::kAuto), grid = traits_of(SamplerChoice::kGrid),
                      mesh = traits_of(SamplerChoice::kDelaunay);
  CHECK((lattice.still_weight > 0 && grid.still_weight == 0 && mesh.still_weight > lattice.still_weight));
  CHECK((lattice.tile_multiple == 8 && grid.tile_multiple == 8 && mesh.tile_multiple == 1));
  CHECK((lattice.cast_use == CastUse::kLights && mesh.cast_use == CastUse::kSamples));
  CHECK((lattice.refreshes_in_parts && grid.refreshes_in_parts && !mesh.refreshes_in_parts));
  CHECK((mesh.balances_without_rate && !lattice.balances_without_rate));
  CHECK((mesh.costs_outlast_rest && !lattice.costs_outlast_rest));
  CHECK((lattice.weights_are_roots && !mesh.weights_are_roots));
  const SampleWork node = work_of(lattice), sample = work_of(mesh);
  CHECK((node.own == Work::kOwnNode && node.received == Work::kReceivedNode && node.kept == Work::kKeptNode));
  CHECK((sample.own == Work::kOwnSample && sample.received == Work::kReceivedSample &&
         sample.kept == Work::kKeptSample));
  for (const CastChoice cast : {CastChoice::kOff, CastChoice::kAuto}) {
    SessionSettings settings = settings_of(SamplerChoice::kAuto);
    settings.cast = cast;
    const SamplerWithExchange made = make_sampler(settings, halves(2), 0, kNoShapes);
    CHECK(made.exchange->seed_peers().empty() == (cast == CastChoice::kOff));
  }
}

}  // namespace pprt::samplers_test
