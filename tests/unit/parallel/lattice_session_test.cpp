// Whole sessions with samples on a lattice: what ranks tell each other, tiles that change hands, frames that
// do not depend on the order of threads.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "parallel/session.h"
#include "pipeline/lattice/lattice_node.h"
#include "unit/parallel/virtual_run.h"

namespace pprt::lattice_session_test {
namespace {

// A few thousand samples a frame and rank.
SessionSettings lattice_settings(SamplerChoice sampler) {
  SessionSettings settings{.sampler = sampler};
  settings.width = 160, settings.height = 96;
  settings.clock = ClockKind::kWork;
  settings.frames_per_second = 4;
  settings.budget_units = 1'500'000;
  settings.cast = CastChoice::kOff;
  return settings;
}

Conditions discs() {
  Conditions conditions;
  conditions.period = 1.7;
  conditions.slow_at_random = true;
  return conditions;
}

// Root mean square difference to the run's scene, whose discs are hard to tell from the outside: to a picture
// of many samples.
double error_of(const Image& image, const Image& reference) {
  double sum = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const Color d = image.pixels[i] - reference.pixels[i];
    sum += d.dot(d);
  }
  return std::sqrt(sum / (3.0 * static_cast<double>(image.pixels.size())));
}

Image reference_of(const SessionSettings& settings, const Conditions& conditions) {
  SessionSettings fine = settings;
  fine.frames_per_second = 0, fine.budget_units = 0;
  fine.stop = {.samples = 12 * 160 * 96};
  fine.sampler = SamplerChoice::kGrid;
  return run_session(1, fine, still_or_pan(fine, 1), conditions).frames.at(0).image;
}

using Point = std::tuple<int, double, double>;  // frame, x, y

// The ranks whose closed area a node's sample is needed in, by looking at every pixel about it.
std::set<int> ranks_that_need(const Traced& sample, const TileGrid& grid,
                              const std::vector<std::int32_t>& owners) {
  const LatticeNode node = node_at({sample.x, sample.y});
  double reach = 0;
  if ((node.x | node.y) % kBaseSide != 0 && level_of(node).kind == LatticeKind::kCenter)
    reach = 0.5 * level_of(node).side / kPixelSide;
  std::set<int> ranks;
  for (int y = 0; y < grid.height; ++y) {
    if (y > sample.y + reach || y + 1 < sample.y - reach) continue;
    for (int x = 0; x < grid.width; ++x) {
      if (x > sample.x + reach || x + 1 < sample.x - reach) continue;
      ranks.insert(owners[static_cast<std::size_t>(grid.tile_at(x + 0.5, y + 0.5))]);
    }
  }
  return ranks;
}

}  // namespace

TEST_CASE("lattice session: frames are the same each time, whatever the order of threads") {
  for (const SamplerChoice sampler : {SamplerChoice::kAuto, SamplerChoice::kGrid}) {
    SessionSettings settings = lattice_settings(sampler);
    const Image reference = reference_of(settings, discs());
    for (const int ranks : {1, 2, 5, 8}) {
      INFO(ranks << " ranks, sampler " << static_cast<int>(sampler));
      const VirtualRun first = run_session(ranks, settings, still_or_pan(settings, 3, 2), discs());
      const VirtualRun again = run_session(ranks, settings, still_or_pan(settings, 3, 2), discs());
      REQUIRE(first.error.empty());
      REQUIRE(first.frames.size() == 3);
      CHECK(same_pictures(first, again));
      const double moved = error_of(first.frames[2].image, reference);  // the control: another camera
      CHECK(error_of(first.frames[0].image, reference) < 0.6 * moved);
    }
  }
}

TEST_CASE("lattice session: every sample is sent to the ranks that need it") {
  SessionSettings settings = lattice_settings(SamplerChoice::kAuto);
  settings.balance = BalanceMode::kNone;
  constexpr int kRanks = 6;
  const VirtualRun run = run_session(kRanks, settings, still_or_pan(settings, 2, 2), discs());
  REQUIRE(run.error.empty());
  const TileGrid grid = tile_grid(settings, kRanks);
  const std::vector<std::int32_t>& owners = run.frames[0].owners;
  std::map<int, std::set<Point>> known;  // per rank: what it has traced or been sent
  std::map<int, int> first_index;
  for (int rank = 0; rank < kRanks; ++rank) {
    for (const Traced& t : run.traced[static_cast<std::size_t>(rank)])
      known[rank].insert({t.frame, t.x, t.y});
  }
  for (const SentBundle& sent : run.bundles) {
    for (const Sample& s : sent.bundle.samples)
      known[sent.to].insert({sent.bundle.frame_index + 1, s.x, s.y});
  }
  std::size_t at_borders = 0;
  for (int rank = 0; rank < kRanks; ++rank) {
    for (const Traced& t : run.traced[static_cast<std::size_t>(rank)]) {
      if (t.x > settings.width || t.y > settings.height) continue;
      for (const int other : ranks_that_need(t, grid, owners)) {
        INFO("frame " << t.frame << ", point " << t.x << ", " << t.y << " of rank " << rank << " for "
                      << other);
        REQUIRE(known[other].count({t.frame, t.x, t.y}) == 1);
        at_borders += other != rank ? 1 : 0;
      }
    }
  }
  CHECK(at_borders > 200);

  // Not all is sent to all.
  const auto sent = std::count_if(run.bundles.begin(), run.bundles.end(),
                                  [](const SentBundle& b) { return b.bundle.samples.size() > 200; });
  CHECK(sent == 0);
}

TEST_CASE("lattice session: samples at borders improve the picture there") {
  SessionSettings settings = lattice_settings(SamplerChoice::kAuto);
  settings.balance = BalanceMode::kNone;
  const Image reference = reference_of(settings, discs());
  Conditions deaf = discs();
  deaf.drop_samples = true;
  const VirtualRun told = run_session(8, settings, still_or_pan(settings, 1), discs());
  const VirtualRun untold = run_session(8, settings, still_or_pan(settings, 1), deaf);
  CHECK(error_of(told.frames[0].image, reference) < error_of(untold.frames[0].image, reference));
}

TEST_CASE("lattice session: tiles change hands, and the picture stays whole") {
  // Discs take four times the rays: regions that hold more of them fall behind.
  for (const BalanceMode balance : {BalanceMode::kLocal, BalanceMode::kGlobal, BalanceMode::kCombined}) {
    INFO("balance " << static_cast<int>(balance));
    SessionSettings settings = lattice_settings(SamplerChoice::kAuto);
    settings.balance = balance;
    Conditions one_disc;
    one_disc.more_rays = 8;
    one_disc.slow_at_random = true;
    const VirtualRun run = run_session(6, settings, still_or_pan(settings, 6, 3), one_disc);
    const VirtualRun again = run_session(6, settings, still_or_pan(settings, 6, 3), one_disc);
    REQUIRE(run.error.empty());
    CHECK(same_pictures(run, again));
    CHECK(run.frames.back().owners != run.frames.front().owners);
    for (const FinishedFrame& frame : run.frames) {
      std::uint64_t reported = 0;
      for (const RankReport& r : frame.ranks) reported += r.samples_in_region;
      CHECK(reported > 1000);
      // Nothing is black: the darkest colour of the scene has a blue of .3.
      CHECK(std::all_of(frame.image.pixels.begin(), frame.image.pixels.end(),
                        [](const Color& c) { return c.x > 0.05F; }));
    }
  }
}

TEST_CASE("lattice session: a resting picture gets finer from frame to frame, and is kept at a repartition") {
  SessionSettings settings = lattice_settings(SamplerChoice::kAuto);
  settings.cast = CastChoice::kAuto;
  settings.balance = BalanceMode::kGlobal;
  settings.budget_units = 500'000;
  const Image reference = reference_of(settings, discs());
  const VirtualRun run = run_session(4, settings, still_or_pan(settings, 6), discs());
  REQUIRE(run.error.empty());
  const double first = error_of(run.frames.front().image, reference);
  CHECK(error_of(run.frames.back().image, reference) < 0.6 * first);
  std::uint64_t carried = 0;
  for (const RankReport& r : run.frames.back().ranks) carried += r.samples_cast;
  CHECK(carried > 1000);
}

TEST_CASE("lattice session: samples of the frame before save shadow rays, and change no picture") {
  SessionSettings settings = lattice_settings(SamplerChoice::kGrid);
  settings.frames_per_second = 0, settings.budget_units = 0;
  settings.stop = {.samples = 6000};
  Conditions lit = discs();
  lit.more_rays = 3;
  const auto rays_of = [](const FinishedFrame& frame) {
    std::uint64_t shadow = 0, samples = 0, carried = 0;
    for (const RankReport& r : frame.ranks)
      shadow += r.rays.shadow, samples += r.samples_in_region, carried += r.samples_cast;
    return std::array{static_cast<double>(shadow) / static_cast<double>(samples),
                      static_cast<double>(carried) / static_cast<double>(samples)};
  };
  for (const int ranks : {1, 4}) {
    settings.cast = CastChoice::kOff;
    const VirtualRun anew = run_session(ranks, settings, still_or_pan(settings, 3, 0.3), lit);
    settings.cast = CastChoice::kAuto;
    const VirtualRun cast = run_session(ranks, settings, still_or_pan(settings, 3, 0.3), lit);
    REQUIRE((anew.error.empty() && cast.error.empty()));
    CHECK(same_pictures(anew, cast));
    CHECK(rays_of(anew.frames[2])[1] == 0);
    CHECK(rays_of(cast.frames[2])[1] > 0.1);
    CHECK(rays_of(cast.frames[2])[0] < 0.9 * rays_of(anew.frames[2])[0]);
    CHECK(rays_of(cast.frames[0])[0] == rays_of(anew.frames[0])[0]);  // there was none before
  }

  // Where samples send no shadow rays nothing is cast.
  const VirtualRun dark = run_session(2, settings, still_or_pan(settings, 3, 0.3));
  CHECK(rays_of(dark.frames[2])[1] == 0);
}

TEST_CASE("lattice session: a number of samples ends a frame") {
  SessionSettings settings = lattice_settings(SamplerChoice::kAuto);
  settings.frames_per_second = 0, settings.budget_units = 0;
  settings.stop = {.samples = 4000};
  for (const int ranks : {1, 3}) {
    const VirtualRun run = run_session(ranks, settings, still_or_pan(settings, 1), discs());
    REQUIRE(run.error.empty());
    std::uint64_t samples = 0;
    for (const RankReport& r : run.frames[0].ranks) samples += r.samples_in_region;
    CHECK(samples >= 4000);
    CHECK(samples < 4100);
  }
}

TEST_CASE("lattice session: balancing does not make a still of several ranks more work") {
  SessionSettings settings = lattice_settings(SamplerChoice::kAuto);
  settings.frames_per_second = 0, settings.budget_units = 0;
  settings.is_still = true;
  settings.stop = {.weight = 2.8e-5};  // a default still's
  const auto samples_with = [&](BalanceMode balance) {
    settings.balance = balance;
    const VirtualRun run = run_session(4, settings, still_or_pan(settings, 1));
    REQUIRE(run.error.empty());
    std::uint64_t samples = 0;
    for (const RankReport& r : run.frames.at(0).ranks) samples += r.samples_new;
    return static_cast<double>(samples);
  };
  CHECK(samples_with(BalanceMode::kCombined) < 1.1 * samples_with(BalanceMode::kNone));
}

TEST_CASE(
    "lattice sessions: a sample is filtered over the area that its node stands for, at most a pixel's") {
  SessionSettings settings = lattice_settings(SamplerChoice::kGrid);
  settings.frames_per_second = 0, settings.budget_units = 0;
  settings.stop = {.samples = 6 * 160 * 96};
  const VirtualRun run = run_session(2, settings, still_or_pan(settings, 1), discs());
  std::map<double, std::size_t> of_footprint;
  for (const std::vector<Traced>& traced : run.traced) {
    for (const Traced& at : traced) {
      const LatticeNode node = node_at({at.x, at.y});
      const bool is_fine = !is_base(node) && level_of(node).side <= kPixelSide;
      REQUIRE(at.footprint == (is_fine ? std::sqrt(level_of(node).area()) : 1));
      ++of_footprint[at.footprint];
    }
  }
  // One sample a pixel, another in the middle of each, two more on the sides, and the first half of the next
  // four.
  CHECK(of_footprint.size() == 4);
  CHECK(of_footprint[std::sqrt(0.5F)] > 150 * 90);
  CHECK(of_footprint[0.5] > 2 * 150 * 90);
}

}  // namespace pprt::lattice_session_test
