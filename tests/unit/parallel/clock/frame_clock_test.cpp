#include "parallel/clock/make_clocks.h"
#include "parallel/clock/work_clock.h"
#include "parallel/exchange/samplers.h"

#include <catch2/catch.hpp>
#include <chrono>
#include <deque>
#include <thread>

namespace pprt::frame_clock_test {
namespace {

constexpr double kPeriod = 0.1;
constexpr std::size_t kPixels = 8 * 1000;        // as long to reconstruct as 1000 samples
constexpr double kFirstSecondsPerSize = 1.3e-7;  // of a sample, before reconstruction was measured

// A sequence that begins now. It lives as long as the tests.
const SequenceClock& sequence_of_now() {
  static std::deque<SequenceClock> sequences;
  sequences.emplace_back().begin(monotonic_seconds());
  return sequences.back();
}

// A clock of a sequence that began now, in its frame 0, whose deadline is a second away.
std::unique_ptr<FrameClock> clock_in_a_frame(double reserve_s, Carry carry = Carry::kNothing,
                                             double ranks_per_core = 1) {
  SessionSettings settings{.sampler = SamplerChoice::kDelaunay};
  settings.clock = ClockKind::kWall;
  settings.frames_per_second = 1 / kPeriod;
  std::unique_ptr<FrameClock> clock =
      make_frame_clock(settings, 0, sequence_of_now(), kPixels, ranks_per_core,
                       traits_of(settings.sampler).refreshes_in_parts);
  clock->region_changed(kPixels);
  FrameOrder order;
  order.deadline_s = 1;
  order.carry = carry;
  order.reserve_s = reserve_s;
  clock->begin_frame(order);
  return clock;
}

// How long before the deadline sampling ends with so many samples.
double left_with(FrameClock& clock, std::uint64_t samples) {
  clock.begin_packet(samples);
  return 1 - clock.sampling_end_seconds();
}

TEST_CASE("wall clock: sampling leaves time for the reconstruction of as many samples as there are",
          "[realtime]") {
  const auto clock = clock_in_a_frame(0.01);
  CHECK(left_with(*clock, 500) ==
        Approx(0.01 + 1.25 * kFirstSecondsPerSize * 1500));  // nothing is known of it yet
  left_with(*clock, 3000);
  clock->end_frame(8, 1);  // milliseconds, for 3000 samples and the pixels
  const double per_sample = 0.008 / (3000 + 1000);
  CHECK(left_with(*clock, 0) == Approx(0.01 + 1.25 * per_sample * 1000));
  CHECK(left_with(*clock, 9000) == Approx(0.01 + 1.25 * per_sample * 10000));
}

TEST_CASE("wall clock: ranks that share a core leave time for each other's reconstruction", "[realtime]") {
  const auto clock = clock_in_a_frame(0, Carry::kNothing, 16);
  left_with(*clock, 3000);
  clock->end_frame(1, 1);
  CHECK(left_with(*clock, 3000) == Approx(1.25 * 16 * 0.001));
}

TEST_CASE("wall clock: a frame whose deadline has gone by is past, but for the first one") {
  const auto clock = clock_in_a_frame(0.01);
  FrameOrder order;
  order.deadline_s = 1e-9;
  CHECK_FALSE(clock->is_past(order));  // which waits for all ranks
  order.index = 1;
  CHECK(clock->is_past(order));
  order.deadline_s = 1000;
  CHECK_FALSE(clock->is_past(order));
  order.deadline_s = 0;  // no rate
  CHECK_FALSE(clock->is_past(order));
}

TEST_CASE("wall clock: a frame whose time is over grows no further") {
  const auto clock = clock_in_a_frame(1.5);
  FrameOrder order;
  order.deadline_s = 0.001;
  clock->begin_frame(order);
  clock->begin_packet(100);
  CHECK(clock->sampling_share() == 1);
  CHECK(clock->expected_growth(100, 200) == 1.0);
}

TEST_CASE("without a rate no frame is ever nearer to its end: half of it counts as passed") {
  for (const ClockKind kind : {ClockKind::kWall, ClockKind::kWork}) {
    SessionSettings settings{.sampler = SamplerChoice::kAuto};
    settings.clock = kind, settings.frames_per_second = 0;
    const auto clock = make_frame_clock(settings, 0, sequence_of_now(), kPixels, 1, true);
    clock->begin_frame({});
    for (int packet = 0; packet < 3; ++packet) {
      clock->begin_packet(1000);
      CHECK(clock->sampling_share() == 0.5);
      CHECK_FALSE(clock->expected_growth(100, 200));
      CHECK_FALSE(clock->sampling_over());
    }
  }
}

TEST_CASE("wall clock: ranks that share a core afford their share of its work") {
  for (const double ranks_per_core : {1.0, 16.0}) {
    const auto clock = clock_in_a_frame(0, Carry::kNothing, ranks_per_core);
    const double pixel_s = 1e-9 * static_cast<double>(price(Work::kPixel)) * ranks_per_core;
    CHECK(static_cast<double>(clock->affordable(Work::kPixel, 0.5)) ==
          Approx(0.5 * kPeriod / pixel_s).margin(1));
  }
}

TEST_CASE(
    "wall clock: a resting picture whose reconstruction fills the frame gets no further samples, a new one "
    "some",
    "[realtime]") {
  for (const bool rests : {true, false}) {
    const auto clock = clock_in_a_frame(0, rests ? Carry::kAccumulate : Carry::kNothing);
    left_with(*clock, 9000);
    clock->end_frame(50, 1);
    CHECK(left_with(*clock, 10000) == Approx(1.25 * 0.055));
    CHECK_FALSE(clock->is_fine_enough());
    for (const std::uint64_t samples : {25000, 1000000}) {
      CHECK(left_with(*clock, samples) == Approx(rests ? kPeriod : 0.7 * 2 * kPeriod));
      CHECK(clock->is_fine_enough() == rests);
    }
  }
}

TEST_CASE("wall clock: a resting picture without parts is reconstructed in every so many frames",
          "[realtime]") {
  const auto clock = clock_in_a_frame(0.01, Carry::kAccumulate);
  left_with(*clock, 9000);
  clock->end_frame(60, 1);  // with a quarter more .75 of the period: .35 are saved in each frame
  FrameOrder order;
  order.carry = Carry::kAccumulate;
  order.deadline_s = 1;
  order.reserve_s = 0.01;
  std::vector<bool> turns;
  for (int frame = 0; frame < 6; ++frame) {
    clock->begin_frame(order);
    const bool is_turn = !clock->reconstruction_over();
    turns.push_back(is_turn);
    CHECK(left_with(*clock, 9000) == Approx(0.01 + (is_turn ? 0.075 : 0)));
  }
  CHECK(turns == std::vector{false, false, true, false, false, true});
  clock->begin_frame(order);
  REQUIRE(clock->reconstruction_over());
  CHECK_FALSE(clock->is_fine_enough());
  CHECK(left_with(*clock, 13000) == Approx(0.01));
  CHECK(clock->is_fine_enough());
  order.carry = Carry::kNothing;
  clock->begin_frame(order);
  CHECK_FALSE(clock->reconstruction_over());
  CHECK(left_with(*clock, 13000) == Approx(0.01 + 1.4 * 0.075));
}

TEST_CASE("wall clock: how little a resting picture takes for each sample says nothing of the next new one",
          "[realtime]") {
  const auto clock = clock_in_a_frame(0.01);
  left_with(*clock, 1000);
  clock->end_frame(8, 1);  // 2000 samples with the region's pixels: 4 us for each
  FrameOrder order;
  order.deadline_s = 1, order.reserve_s = 0.01;
  order.carry = Carry::kAccumulate;
  for (int frame = 0; frame < 10; ++frame) {
    clock->begin_frame(order);
    left_with(*clock, 9000);
    clock->end_frame(10, 1);  // 1 us for each
  }
  clock->begin_frame(order);
  CHECK(left_with(*clock, 1000) < 0.01 + 1.25 * 0.003);
  order.carry = Carry::kNothing;
  clock->begin_frame(order);
  CHECK(left_with(*clock, 1000) == Approx(0.01 + 1.25 * 0.008));
}

TEST_CASE("wall clock: a resting frame whose time is over already traces nothing", "[realtime]") {
  for (const bool rests : {true, false}) {
    const auto clock = clock_in_a_frame(1.5, rests ? Carry::kAccumulate : Carry::kNothing);
    FrameOrder order;
    order.carry = rests ? Carry::kAccumulate : Carry::kNothing;
    order.deadline_s = 0.001;
    clock->begin_frame(order);
    clock->begin_packet(100);
    CHECK(clock->packet_over() == rests);
  }
}

TEST_CASE("wall clock: a resting picture on a lattice is reconstructed in parts, up to the reserve",
          "[realtime]") {
  SessionSettings settings{.sampler = SamplerChoice::kAuto};
  settings.clock = ClockKind::kWall;
  settings.frames_per_second = 1 / kPeriod;
  for (const bool rests : {true, false}) {
    const double began_s = monotonic_seconds();
    const auto clock = make_frame_clock(settings, 0, sequence_of_now(), 0, 1,
                                        traits_of(settings.sampler).refreshes_in_parts);
    FrameOrder order;
    order.carry = rests ? Carry::kAccumulate : Carry::kNothing;
    order.deadline_s = 1;
    order.reserve_s = 0.01;
    clock->begin_frame(order);
    clock->unshown_found(0);
    left_with(*clock, 10000);
    clock->end_frame(10, 0.5);  // all of it would have taken 20
    CHECK(left_with(*clock, 10000) == Approx(0.01 + 1.25 * 0.02));
    CHECK(left_with(*clock, 100000) == Approx(rests ? 0.01 + 0.35 * kPeriod : 0.7 * 2 * kPeriod));
    clock->end_frame(0, 0);  // nothing was reconstructed: nothing is learned
    CHECK(left_with(*clock, 10000) == Approx(0.01 + 1.25 * 0.02));
    CHECK_FALSE(clock->reconstruction_over());
    // A part as long as this one would reach into the reserve.
    order.deadline_s = monotonic_seconds() - began_s + 0.01 + 0.05;
    clock->begin_frame(order);
    clock->end_sampling(0);
    CHECK_FALSE(clock->reconstruction_over());
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    CHECK(clock->reconstruction_over() == rests);
  }
}

TEST_CASE("wall clock: the pace is the time of sampling, without rest, by the work that it took",
          "[realtime]") {
  constexpr double kUnits = 1e6;
  const auto clock = clock_in_a_frame(0);
  CHECK(clock->pace() == 1);
  clock->rested(5);  // before sampling: does not count
  const double before_s = monotonic_seconds();
  clock->begin_packet(1000);
  const double began_s = monotonic_seconds();
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  clock->rested(0.01);
  const double least_s = monotonic_seconds() - began_s - 0.01;
  clock->end_sampling(kUnits);
  const double most_s = monotonic_seconds() - before_s - 0.01;
  const double pace = clock->pace();
  CHECK((pace >= 1e9 * least_s / kUnits && pace <= 1e9 * most_s / kUnits));
  clock->end_sampling(1000);  // too little work to learn from
  CHECK(clock->pace() == pace);
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  clock->end_sampling(kUnits);  // the new time counts a quarter
  CHECK(
      (clock->pace() > pace && clock->pace() < pace + 0.5 * 1e9 * (monotonic_seconds() - before_s) / kUnits));
}

TEST_CASE("wall clock: a new picture that began late ends in time all the same", "[realtime]") {
  SessionSettings settings{.sampler = SamplerChoice::kDelaunay};
  settings.clock = ClockKind::kWall;
  settings.frames_per_second = 1 / kPeriod;
  for (const double ranks_per_core : {1.0, 2.0}) {
    const auto clock = make_frame_clock(settings, 0, sequence_of_now(), 0, ranks_per_core,
                                        traits_of(settings.sampler).refreshes_in_parts);
    FrameOrder order;
    order.reserve_s = 0.5 * kPeriod;
    for (const double stops_in_s : {100.0, -0.001}) {
      order.deadline_s = 0.5 * kPeriod + 1.25 * 0.004 * ranks_per_core + stops_in_s;
      clock->begin_frame(order);
      clock->begin_packet(3000);
      CHECK(clock->sampling_over() == (stops_in_s < 0));
      clock->end_frame(4, 1);
    }
  }
}

// A tiny picture on many ranks leaves some of them without a tile.
TEST_CASE("wall clock: a rank without pixels and samples ends its frames as the others do", "[realtime]") {
  const auto clock = clock_in_a_frame(0.01);
  clock->region_changed(0);
  CHECK(left_with(*clock, 0) == Approx(0.01));
  CHECK_FALSE(clock->expected_growth(0, 0));
  clock->end_frame(0, 1);
  CHECK(left_with(*clock, 0) == Approx(0.01));
  clock->region_changed(kPixels);
  CHECK(left_with(*clock, 0) == Approx(0.01 + 1.25 * kFirstSecondsPerSize * 1000));  // nothing was learned
}

TEST_CASE("wall clock: the slowest of the last eight reconstructions counts", "[realtime]") {
  const auto clock = clock_in_a_frame(0);
  const auto left_after = [&](double reconstruction_ms) {
    left_with(*clock, 9000);
    clock->end_frame(reconstruction_ms, 1);
    return left_with(*clock, 9000);
  };
  CHECK(left_after(40) == Approx(1.25 * 0.04));
  for (int frame = 0; frame < 7; ++frame) CHECK(left_after(10) == Approx(1.25 * 0.04));
  CHECK(left_after(10) == Approx(1.25 * 0.01));
}

TEST_CASE("work clock: rounds share what a frame leaves beside its reconstruction and the last exchange") {
  constexpr std::size_t kFew = 1000;
  constexpr auto kBudget = static_cast<WorkUnits>(24 * 1'000'000);
  WorkClock clock(kBudget, kFew, 2);
  const WorkUnits reconstruction = 2 * kFew * price(Work::kPixel);
  const WorkUnits sampling = kBudget - kBudget / 24 - reconstruction;
  clock.begin_frame({});
  CHECK(clock.sampling_share() == Approx(1.0 / 24));
  std::uint64_t rays = 0;
  for (int round = 1; round <= kRoundsPerFrame; ++round) {
    CHECK_FALSE(clock.sampling_over());
    clock.begin_packet(0);
    CHECK(clock.sampling_share() == Approx(round / 24.0));
    for (; !clock.packet_over(); ++rays) clock.spend(Work::kRay, 1);
    const WorkUnits end = sampling * static_cast<WorkUnits>(round) / 24, ray = 2 * price(Work::kRay);
    CHECK(rays * ray >= end);
    CHECK(rays * ray < end + ray);
  }
  CHECK(clock.sampling_over());
  CHECK(clock.frame_seconds() == Approx(static_cast<double>(2 * rays * price(Work::kRay)) / 5e7));
  CHECK(clock.affordable(Work::kRay, 0.25) == kBudget / 4 / (2 * price(Work::kRay)));
  clock.end_frame(0, 1);
  CHECK(clock.frame_seconds() == 0);
  CHECK(clock.used_ns() == static_cast<std::int64_t>(2 * rays * price(Work::kRay)));
  FrameOrder order;
  for (const double periods : {3.0, 1.0}) {  // a frame that has several periods, and the next
    order.periods = periods;
    clock.begin_frame(order);
    CHECK(clock.affordable(Work::kRay, 1) == Approx(periods * kBudget / (2 * price(Work::kRay))).margin(1));
  }
}

TEST_CASE("work clock: without a rate a round has its fixed units, and sampling has no end") {
  WorkClock clock(0, 1000);
  clock.begin_frame({});
  for (int round = 1; round <= 2 * kRoundsPerFrame; ++round) {
    clock.begin_packet(0);
    CHECK_FALSE(clock.packet_over());
    clock.spend(Work::kRay, kUnitsPerFreeRound / price(Work::kRay) + 1);
    CHECK(clock.packet_over());
    CHECK_FALSE(clock.sampling_over());
  }
}

TEST_CASE("work clock: a cast sample is priced with its visibility ray, a fresh one without its rays") {
  const CastPrices prices = cast_prices();
  CHECK(prices.cast == 20 + 110 + 805);
  CHECK(prices.fresh == 705);
  CHECK(prices.ray == 110);
}

}  // namespace
}  // namespace pprt::frame_clock_test
