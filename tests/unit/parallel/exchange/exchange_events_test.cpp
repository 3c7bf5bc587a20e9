// The update rule while everything changes: tiles, cuts and frames, in random order, with messages under way.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <string>

#include "unit/parallel/exchange/exchange_ranks.h"

namespace pprt::exchange_events_test {
namespace {

// Runs the same with many more seeds, found for the asking: PPRT_EXCHANGE_SEEDS=1000 test_parallel
// "[exchange]". Each failure names its seed.
unsigned seeds_to_try() {
  const char* given = std::getenv("PPRT_EXCHANGE_SEEDS");
  return given != nullptr ? static_cast<unsigned>(std::stoul(given)) : 12;
}

struct Events {
  bool transfers = false;
  bool cuts = false;
  bool frames = false;
  bool late_seeds = false;
};

Partition random_partition(const TileGrid& grid, int ranks, unsigned seed) {
  return seed % 2 == 0 ? random_rectangles(grid, ranks, seed) : random_growths(grid, ranks, seed);
}

void happen(ExchangingRanks& run, const Events& events, const Partition& first, std::mt19937& random) {
  const auto another = [&] { return random_partition(first.grid, first.ranks, random()); };
  switch (random() % 8) {
    case 0:
    case 1:
      if (events.transfers) run.give_somewhere();
      break;
    case 2:
      if (events.cuts) run.repartition(another());
      break;
    case 3:
      if (events.frames) {
        const auto step = [&] { return static_cast<double>(random() % 1000) / 50 - 10; };
        const Vec2d shift(step(), step());
        const bool late = events.late_seeds && random() % 2 == 0;
        if (events.cuts && random() % 2 == 0) {
          const Partition next = another();
          run.begin_frame(shift, &next, late);
        } else {
          run.begin_frame(shift, nullptr, late);
        }
      }
      break;
    default:
      run.refine(8);
  }
  if (random() % 3 != 0) run.deliver_some();
}

void check_exact(ExchangingRanks& run) {
  run.quieten();
  CHECK(agree_on_owners(run));
  CHECK(lost_samples(run) == 0);
  const Findings findings = compare_with_serial(run);
  CHECK(findings.expected > 100);
  CHECK(findings.unknown == 0);
  CHECK(findings.wrong == 0);
}

void check_events(const Events& events) {
  int transfers = 0;
  for (unsigned seed = 1; seed <= seeds_to_try(); ++seed) {
    std::mt19937 random(seed);
    const int ranks = 2 + static_cast<int>(random() % 8);
    const Partition first = random_partition(TileGrid(96, 80, 8), ranks, seed);
    INFO(ranks << " ranks, seed " << seed);
    ExchangingRanks run(first, seed);
    run.seed();
    for (int phase = 0; phase < 4; ++phase) {
      for (int event = 0; event < 15; ++event) happen(run, events, first, random);
      check_exact(run);
    }
    transfers += run.transfers();
  }
  CHECK((transfers > 0) == events.transfers);
}

}  // namespace

TEST_CASE("exchange: both sides know the triangles at borders while tiles are transferred", "[exchange]") {
  check_events({.transfers = true});
}

TEST_CASE("exchange: both sides know the triangles at borders when the image is repartitioned",
          "[exchange]") {
  check_events({.cuts = true});
}

TEST_CASE("exchange: both sides know the triangles at borders in frame after frame", "[exchange]") {
  check_events({.frames = true});
}

TEST_CASE("exchange: both sides know the triangles at borders with transfers, repartitions and frames",
          "[exchange]") {
  check_events({.transfers = true, .cuts = true, .frames = true});
}

TEST_CASE("exchange: both sides know the triangles at borders when seeds come late", "[exchange]") {
  check_events({.transfers = true, .cuts = true, .frames = true, .late_seeds = true});
}

}  // namespace pprt::exchange_events_test
