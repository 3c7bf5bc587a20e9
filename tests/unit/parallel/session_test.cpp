#include "parallel/session.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "parallel/exchange/samplers.h"
#include "parallel/settings/work_units.h"
#include "unit/each_sampler.h"
#include "unit/parallel/virtual_run.h"

namespace pprt::session_test {
namespace {

// 4 frames a second of counted work, a megaunit and a half a rank: about a thousand samples each.
SessionSettings work_settings(SamplerChoice sampler) {
  SessionSettings settings{.sampler = sampler};
  settings.width = 96, settings.height = 64;
  settings.clock = ClockKind::kWork;
  settings.frames_per_second = 4;
  settings.budget_units = 1'500'000;
  settings.cast = CastChoice::kOff;
  return settings;
}

// No rate: a stop rule ends each frame.
SessionSettings free_settings(SamplerChoice sampler, ClockKind clock, const StopRules& stop) {
  SessionSettings settings = work_settings(sampler);
  settings.clock = clock;
  settings.frames_per_second = 0, settings.budget_units = 0;
  settings.stop = stop;
  return settings;
}

std::uint64_t total(const FinishedFrame& frame, std::uint64_t RankReport::*figure) {
  std::uint64_t sum = 0;
  for (const RankReport& r : frame.ranks) sum += r.*figure;
  return sum;
}

// The disc and what lies around it, apart from the edge between.
void check_shows_disc(const Image& image) {
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double r = std::hypot(x + 0.5 - 0.5 * image.width, y + 0.5 - 0.5 * image.height) / image.height;
      if (std::abs(r - 0.3) < 0.06) continue;
      const Color wanted = r < 0.3 ? Color(0.9f, 0.7f, 0.2f) : Color(0.1f, 0.1f, 0.3f);
      const Color got = image.at(x, y);
      INFO("pixel " << x << ", " << y);
      REQUIRE(std::abs(got.x - wanted.x) + std::abs(got.y - wanted.y) + std::abs(got.z - wanted.z) < 1e-5);
    }
  }
}

// Samples that a rank traces beside another one that counts them: other regions' seeds that its own needs.
std::uint64_t traced_twice(const FinishedFrame& frame, const SessionSettings& settings, int ranks) {
  const Partition partition{tile_grid(settings, ranks), ranks, frame.owners, {}};
  std::uint64_t count = 0;
  for (int rank = 0; rank < ranks; ++rank) {
    const SamplerWithExchange made = make_sampler(settings, partition, rank, {});
    for (const SeedPoint& seed : made.sampler->seeds()) count += !seed.own;
  }
  return count;
}

// The first points of a picture, as one rank chooses them.
std::vector<Vec2d> first_points(const SessionSettings& settings) {
  const TileGrid grid = tile_grid(settings, 1);
  const auto tiles = static_cast<std::size_t>(grid.tile_count());
  const Partition partition{grid, 1, std::vector<std::int32_t>(tiles, 0), std::vector<std::uint64_t>(tiles)};
  const SamplerWithExchange made = make_sampler(settings, partition, 0, {});
  made.sampler->clear(false);
  std::vector<Vec2d> points;
  for (const SeedPoint& seed : made.sampler->seeds()) points.push_back(seed.at);
  for (int i = 0; i < 100; ++i) {
    if (const std::optional<Vec2d> point = made.sampler->next_point()) points.push_back(*point);
  }
  return points;
}

}  // namespace

EACH_SAMPLER_TEST_CASE("session: frames of counted work are whole, on time, and the same each time") {
  const SessionSettings settings = work_settings(sampler);
  for (const int ranks : {1, 2, 3, 5, 8}) {
    INFO(ranks << " ranks");
    const VirtualRun first = run_session(ranks, settings, still_or_pan(settings, 4, 2));
    const VirtualRun again =
        run_session(ranks, settings, still_or_pan(settings, 4, 2), {.slow_at_random = true});
    CHECK(first.error.empty());
    REQUIRE(first.frames.size() == 4);
    CHECK(same_pictures(first, again));
    for (std::size_t i = 0; i < 4; ++i) {
      const FinishedFrame& frame = first.frames[i];
      CHECK(frame.order.number == static_cast<int>(i) + 1);
      CHECK(frame.late_ms <= 0);
      CHECK(frame.finished_s == again.frames[i].finished_s);
      CHECK(total(frame, &RankReport::samples_new) > 300u * static_cast<unsigned>(ranks));
    }
    check_shows_disc(first.frames[0].image);
  }
}

EACH_SAMPLER_TEST_CASE(
    "session: another seed gives another pattern where there is chance, more budget a finer one") {
  SessionSettings settings = work_settings(sampler);
  const VirtualRun one = run_session(2, settings, still_or_pan(settings, 1));
  const std::vector<Vec2d> points = first_points(settings);
  settings.seed = 2;
  // A lattice is where it is.
  CHECK(same_pictures(one, run_session(2, settings, still_or_pan(settings, 1))) ==
        (first_points(settings) == points));
  settings.budget_units *= 2;
  const VirtualRun finer = run_session(2, settings, still_or_pan(settings, 1));
  CHECK(finer.frames.at(0).ranks[1].mean_weight < one.frames.at(0).ranks[1].mean_weight);
}

EACH_SAMPLER_TEST_CASE("session: samples accumulate while the camera rests, unless casting is off") {
  SessionSettings settings = work_settings(sampler);
  settings.cast = CastChoice::kAuto;
  const VirtualRun rest = run_session(3, settings, still_or_pan(settings, 4));
  REQUIRE(rest.frames.size() == 4);
  for (std::size_t i = 1; i < 4; ++i) {
    const FinishedFrame &before = rest.frames[i - 1], &frame = rest.frames[i];
    CHECK(frame.order.carry == Carry::kAccumulate);
    CHECK(total(frame, &RankReport::samples_cast) == total(before, &RankReport::samples_in_region));
    CHECK(total(frame, &RankReport::samples_in_region) > total(before, &RankReport::samples_in_region) + 500);
    CHECK(frame.late_ms <= 0);
  }
  settings.cast = CastChoice::kOff;
  const VirtualRun off = run_session(3, settings, still_or_pan(settings, 2));
  REQUIRE(off.frames.size() == 2);
  CHECK(off.frames[1].order.carry == Carry::kNothing);
  CHECK(total(off.frames[1], &RankReport::samples_cast) == 0);
}

EACH_SAMPLER_TEST_CASE("session: nothing is carried across a camera cut") {
  SessionSettings settings = work_settings(sampler);
  settings.cast = CastChoice::kPaper;
  const auto source = [&](int index) -> std::optional<FrameRequest> {
    if (index == 3) return std::nullopt;
    return FrameRequest{index + 1, camera_before_disc(settings.width, settings.height), index == 2};
  };
  const VirtualRun run = run_session(2, settings, source);
  REQUIRE(run.frames.size() == 3);
  CHECK(run.frames[1].order.carry == Carry::kAccumulate);
  CHECK(run.frames[2].order.carry == Carry::kNothing);
}

EACH_SAMPLER_TEST_CASE("session: a stop rule on samples counts those of the whole image") {
  for (const int ranks : {1, 3, 5}) {
    const SessionSettings settings = free_settings(sampler, ClockKind::kWork, {.samples = 2000});
    const VirtualRun run = run_session(ranks, settings, still_or_pan(settings, 1));
    CHECK(run.error.empty());
    REQUIRE(run.frames.size() == 1);
    const std::uint64_t samples = total(run.frames[0], &RankReport::samples_in_region);
    CHECK(samples >= 2000);
    CHECK(samples <= 2000u + static_cast<unsigned>(ranks));
  }
}

EACH_SAMPLER_TEST_CASE("session: a stop rule on weight holds in every region") {
  const SamplerTraits traits = traits_of(sampler);
  const double rule = traits.weights_are_roots ? 0.001 : 0.1;
  for (const int ranks : {1, 3, 5}) {
    const SessionSettings settings = free_settings(sampler, ClockKind::kWork, {.weight = rule});
    const VirtualRun run = run_session(ranks, settings, still_or_pan(settings, 1));
    REQUIRE(run.frames.size() == 1);
    for (const RankReport& r : run.frames[0].ranks) {
      CHECK(r.mean_weight > 0);
      const double reached = traits.weights_are_roots ? r.mean_weight * r.mean_weight : r.mean_weight;
      CHECK(reached <= 1.05 * rule);  // what neighbours send after a rank is done may disturb it a little
    }
  }
}

EACH_SAMPLER_TEST_CASE("session: a stop rule on time counts work") {
  const SessionSettings settings = free_settings(sampler, ClockKind::kWork, {.seconds = 0.03});
  const VirtualRun run = run_session(2, settings, still_or_pan(settings, 1));
  REQUIRE(run.frames.size() == 1);
  const double pixels = 96 * 64 * static_cast<double>(price(Work::kPixel)) / kWorkUnitsPerSecond;
  for (const RankReport& r : run.frames[0].ranks) {
    CHECK(r.finished_s >= 0.03);
    CHECK(r.finished_s < 0.04 + pixels);
  }
}

EACH_SAMPLER_TEST_CASE("session: the first stop rule reached ends the frame") {
  const SessionSettings settings = free_settings(sampler, ClockKind::kWork, {.samples = 600, .weight = 1e-9});
  const VirtualRun run = run_session(2, settings, still_or_pan(settings, 1));
  REQUIRE(run.frames.size() == 1);
  CHECK(total(run.frames[0], &RankReport::samples_in_region) < 610);
}

EACH_SAMPLER_TEST_CASE("session: colours that are not finite are counted and never shown") {
  const SessionSettings settings = work_settings(sampler);
  const VirtualRun run = run_session(3, settings, still_or_pan(settings, 2), {.no_number_every = 40});
  REQUIRE(run.frames.size() == 2);
  std::uint64_t counted = 0, asked = 0;
  for (const FinishedFrame& frame : run.frames) {
    counted += total(frame, &RankReport::non_finite);
    for (const Color& c : frame.image.pixels) {
      REQUIRE((std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z)));
    }
  }
  for (const auto& of_rank : run.traced) asked += of_rank.size() / 40;
  CHECK(asked > 0);
  CHECK(counted == asked);
}

EACH_SAMPLER_TEST_CASE("session: more ranks than tiles still make a whole picture") {
  SessionSettings settings = work_settings(sampler);
  settings.width = 9, settings.height = 7;  // six tiles
  for (const ClockKind clock : {ClockKind::kWork, ClockKind::kWall}) {
    settings.clock = clock;
    settings.frames_per_second = 20;
    const VirtualRun run = run_session(9, settings, still_or_pan(settings, 2));
    CHECK(run.error.empty());
    REQUIRE(run.frames.size() == 2);
    for (const Color& c : run.frames[1].image.pixels) CHECK(c.z > 0.15f);
  }
  for (const StopRules& stop :
       {StopRules{.samples = 50}, StopRules{.weight = 0.5}, StopRules{.seconds = 0.02}}) {
    const SessionSettings free = free_settings(sampler, ClockKind::kWork, stop);
    SessionSettings small = free;
    small.width = 9, small.height = 7;
    CHECK(run_session(9, small, still_or_pan(small, 1)).frames.size() == 1);
  }
}

EACH_SAMPLER_TEST_CASE(
    "session: a budget too small for anything still gives a whole picture, and says it is late") {
  SessionSettings settings = work_settings(sampler);
  settings.budget_units = 1;
  const VirtualRun run = run_session(3, settings, still_or_pan(settings, 2));
  REQUIRE(run.frames.size() == 2);
  for (const FinishedFrame& frame : run.frames) {
    CHECK(frame.late_ms > 0);
    for (const Color& c : frame.image.pixels) REQUIRE(c.z > 0.15f);  // no pixel is left black
  }
}

EACH_SAMPLER_TEST_CASE("session: the ranks' reports add up to the rays that were traced") {
  SessionSettings settings = work_settings(sampler);
  settings.balance = BalanceMode::kNone;  // owners are those of the frame's beginning
  const VirtualRun run = run_session(3, settings, still_or_pan(settings, 3, 1));
  REQUIRE(run.frames.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    std::uint64_t asked = 0, reported = 0;
    std::set<std::pair<double, double>> points;
    for (const auto& of_rank : run.traced) {
      for (const Traced& t : of_rank) {
        if (t.frame != static_cast<int>(i) + 1) continue;
        ++asked;
        points.emplace(t.x, t.y);
      }
    }
    for (const RankReport& r : run.frames[i].ranks) reported += r.rays.primary;
    CHECK(reported == asked);
    CHECK(total(run.frames[i], &RankReport::samples_new) == points.size());
    CHECK(points.size() + traced_twice(run.frames[i], settings, 3) == asked);
  }
}

EACH_SAMPLER_TEST_CASE("session: a sequence in real time delivers every frame", "[realtime]") {
  SessionSettings settings = work_settings(sampler);
  settings.clock = ClockKind::kWall;
  settings.frames_per_second = 10;
  const VirtualRun run = run_session(3, settings, still_or_pan(settings, 4, 1), {.arrive_at_random = true});
  CHECK(run.error.empty());
  REQUIRE(run.frames.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(run.frames[i].order.deadline_s == Approx(0.1 * static_cast<double>(i + 1)));
    CHECK(run.frames[i].finished_s > 0);
  }
}

EACH_SAMPLER_TEST_CASE("session: each rank rehearses a sequence in real time, and no other", "[realtime]") {
  const auto frames_seen = [&](ClockKind clock, double frames_per_second) {
    SessionSettings settings = work_settings(sampler);
    settings.clock = clock;
    settings.frames_per_second = frames_per_second;
    settings.stop.samples = 500;
    const VirtualRun run = run_session(2, settings, still_or_pan(settings, 3, 1));
    REQUIRE(run.frames.size() == 3);
    for (const std::vector<Traced>& by_rank : run.traced) CHECK(by_rank.back().frame == 3);
    return std::pair(run.traced[0].front().frame, run.traced[1].front().frame);
  };
  CHECK(frames_seen(ClockKind::kWall, 2) == std::pair(1 - kRehearsals, 1 - kRehearsals));
  CHECK(frames_seen(ClockKind::kWall, 0) == std::pair(1, 1));
  CHECK(frames_seen(ClockKind::kWork, 2) == std::pair(1, 1));
}

EACH_SAMPLER_TEST_CASE(
    "session: balancing takes CPU time in real time, none without balancing, and has no price in work "
    "units",
    "[realtime]") {
  const auto balancing_ms = [&](ClockKind clock, BalanceMode mode) {
    SessionSettings settings = work_settings(sampler);
    settings.clock = clock;
    settings.frames_per_second = 10;
    settings.balance = mode;
    const VirtualRun run = run_session(4, settings, still_or_pan(settings, 3, 1));
    REQUIRE(run.frames.size() == 3);
    double sum = 0;
    for (const FinishedFrame& frame : run.frames) {
      for (const RankReport& r : frame.ranks) sum += r.cpu_ms.balancing;
    }
    return sum;
  };
  CHECK(balancing_ms(ClockKind::kWall, BalanceMode::kLocal) > 0);
  CHECK(balancing_ms(ClockKind::kWall, BalanceMode::kNone) == 0);
  CHECK(balancing_ms(ClockKind::kWork, BalanceMode::kLocal) == 0);
}

EACH_SAMPLER_TEST_CASE("session: a rank that stands still is reported late, and delays no frame",
                       "[realtime]") {
  SessionSettings settings = work_settings(sampler);
  settings.clock = ClockKind::kWall;
  settings.frames_per_second = 10;
  settings.cast = CastChoice::kPaper;
  for (const int sleeper : {0, 2}) {
    for (const double shift : {0.0, 1.0}) {
      const VirtualRun run = run_session(3, settings, still_or_pan(settings, 10, shift),
                                         {.bundle_delay_s = 0.02, .sleeper = sleeper, .sleeps_s = 0.35});
      CHECK(run.error.empty());
      REQUIRE(run.frames.size() == 10);
      int without_sleeper = 0;
      for (std::size_t i = 0; i < 10; ++i) {
        const FinishedFrame& frame = run.frames[i];
        CHECK(frame.order.index == static_cast<int>(i));
        CHECK(std::count(frame.owners.begin(), frame.owners.end(), -1) == 0);
        without_sleeper += std::count(frame.late_ranks.begin(), frame.late_ranks.end(), sleeper) != 0;
      }
      CHECK(without_sleeper >= 1);
      for (const Color& c : run.frames[9].image.pixels) REQUIRE(c.z > 0.15f);  // no pixel is left black
    }
  }
}

EACH_SAMPLER_TEST_CASE("session: ranks whose clocks are far apart and drift keep one sequence's deadlines",
                       "[realtime]") {
  SessionSettings settings = work_settings(sampler);
  settings.clock = ClockKind::kWall;
  settings.frames_per_second = 10;
  const VirtualRun run = run_session(3, settings, still_or_pan(settings, 25, 1), {.clocks_differ = true});
  CHECK(run.error.empty());
  REQUIRE(run.frames.size() == 25);
  // A machine under load may make a rank late. One that takes its own time for the sequence's is always late.
  const auto is_in_time = [](const FinishedFrame& frame) {
    return std::all_of(frame.ranks.begin(), frame.ranks.end(), [&](const RankReport& r) {
      return std::abs(r.sampling_ended_s - (frame.order.deadline_s - 0.05)) < 0.05;
    });
  };
  CHECK(std::count_if(run.frames.begin(), run.frames.end(), is_in_time) >= 15);
}

EACH_SAMPLER_TEST_CASE("session: a frame without a rate ends when it is said to be good enough",
                       "[realtime]") {
  // By itself it ends when every pixel has its samples.
  SessionSettings settings = free_settings(sampler, ClockKind::kWall, {.seconds = 3600});
  settings.width = 192, settings.height = 128;
  const VirtualRun run =
      run_session(3, settings, still_or_pan(settings, 1, 1), {.is_enough = [] { return true; }});
  CHECK(run.error.empty());
  REQUIRE(run.frames.size() == 1);
  CHECK(std::count(run.frames[0].owners.begin(), run.frames[0].owners.end(), -1) == 0);
  CHECK(total(run.frames[0], &RankReport::samples_in_region) < 192 * 128);
}

EACH_SAMPLER_TEST_CASE("session: frames without a rate end in real time, whenever the last messages arrive",
                       "[realtime]") {
  // Messages say when a frame may end: none may be overlooked.
  for (int repeat = 0; repeat < 5; ++repeat) {
    const SessionSettings settings = free_settings(sampler, ClockKind::kWall, {.weight = 0.5});
    const VirtualRun run =
        run_session(4, settings, still_or_pan(settings, 5, 1), {.arrive_at_random = true, .patience_s = 10});
    CHECK(run.error.empty());
    REQUIRE(run.frames.size() == 5);
  }
}

EACH_SAMPLER_TEST_CASE("session: an empty sequence ends at once") {
  const SessionSettings settings = work_settings(sampler);
  const VirtualRun run = run_session(3, settings, still_or_pan(settings, 0));
  CHECK(run.error.empty());
  CHECK(run.frames.empty());
}

EACH_SAMPLER_TEST_CASE(
    "session: a slow simulated network delays samples past the frame's end, a fast one changes nothing") {
  SessionSettings settings = work_settings(sampler);
  const auto received = [&](double latency_s) {
    settings.machine.latency_s = latency_s;
    const VirtualRun run = run_session(5, settings, still_or_pan(settings, 2, 2));
    REQUIRE(run.error.empty());
    CHECK(run.frames.back().late_ms <= 0);
    return total(run.frames.back(), &RankReport::samples_received);
  };
  const std::uint64_t at_once = received(0);
  CHECK(received(1e-6) == at_once);
  CHECK(received(0.002) != at_once);
  CHECK(received(10) < at_once / 2);  // what is under way when the frame ends is of no more use
}

EACH_SAMPLER_TEST_CASE("session: a picture of more pixels than one message holds is whole") {
  SessionSettings settings = free_settings(sampler, ClockKind::kWork, {.samples = 10'000});
  settings.width = 1040, settings.height = 1020;
  const std::size_t pixels = std::size_t{1040} * 1020;
  REQUIRE(pixels > kPixelsInMessage);
  const VirtualRun run = run_session(1, settings, still_or_pan(settings, 1, 1));
  REQUIRE(run.frames.size() == 1);
  check_shows_disc(run.frames[0].image);
  CHECK(total(run.frames[0], &RankReport::bytes_pixels) == 12 * pixels);
}

}  // namespace pprt::session_test
