// The wall clock on a time that the test sets: nothing here depends on how busy the machine is.
#include "parallel/clock/wall_clock.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace pprt::wall_clock_test {
namespace {

constexpr double kPeriod = 0.1;
constexpr double kPixelsPerSample = 8;  // that take as long to reconstruct

// A rank's clock and the time that it tells.
struct Timed {
  explicit Timed(double ranks_per_core = 1, bool refreshes_in_parts = false, double period_s = kPeriod)
      : clock(sequence, period_s, ranks_per_core, refreshes_in_parts, [this] { return run; }) {
    sequence.begin(0);
  }

  // Begins a frame now. Its deadline and reserve are seconds; `change` makes it special.
  void begin(double deadline_s, double reserve_s = 0, Carry carry = Carry::kNothing, double periods = 1,
             double effort = 1) {
    FrameOrder order;
    order.index = 1;
    order.deadline_s = deadline_s, order.reserve_s = reserve_s, order.carry = carry;
    order.periods = periods, order.effort = effort;
    clock.begin_frame(order);
    clock.unshown_found(0);
  }

  // A frame of this many samples whose reconstruction has taken so many milliseconds.
  void reconstruct(std::uint64_t samples, double ms, double share = 1) {
    clock.begin_packet(samples);
    clock.end_frame(ms, share);
  }

  // Returns what a packet of 100 samples leaves before a deadline at 1 s, with so many pixels of several
  // surfaces.
  double left_with_mixed(std::size_t pixels) {
    clock.mixed_pixels_found(pixels);
    clock.begin_packet(100);
    return 1 - clock.sampling_end_seconds();
  }

  double now = 0;
  RunTimes run;
  SequenceClock sequence{[this] { return now; }};
  WallClock clock;
};

// Counts the samples of a packet that has begun, until it is over; at most so many.
int samples_of_packet(WallClock& clock, int most = 1000) {
  int samples = 0;
  while (samples < most && !clock.packet_over()) ++samples;
  return samples;
}

}  // namespace

TEST_CASE(
    "set wall clock: a frame may begin when its order says so, on shared cores a period before its end") {
  FrameOrder order;
  order.deadline_s = 1, order.not_before_s = 0.85, order.periods = 1;
  const auto begins_at = [&](double ranks_per_core) {
    Timed timed(ranks_per_core);
    for (int ms = 0; ms < 2000; ++ms) {
      timed.now = 1e-3 * ms + 1e-9;
      if (timed.clock.may_begin(order)) return ms;
    }
    return -1;
  };
  CHECK(begins_at(1) == 850);
  CHECK(begins_at(2) == 900);
  order.periods = 3;
  CHECK(begins_at(2) == 850);  // its time has begun at .7
  order.not_before_s = 0;
  CHECK(begins_at(2) == 700);
  CHECK(begins_at(1) == 0);
}

TEST_CASE(
    "set wall clock: a frame is past from its deadline on, but not the first, nor one that is awaited") {
  Timed timed;
  FrameOrder order;
  order.deadline_s = 1, order.index = 1;
  timed.now = 0.999;
  CHECK_FALSE(timed.clock.is_past(order));
  timed.now = 1;
  CHECK(timed.clock.is_past(order));
  order.is_awaited = true;
  CHECK_FALSE(timed.clock.is_past(order));
  order.is_awaited = false, order.index = 0;
  CHECK_FALSE(timed.clock.is_past(order));
  order.index = 1, order.deadline_s = 0;
  CHECK_FALSE(timed.clock.is_past(order));
}

TEST_CASE("set wall clock: sampling ends by the reserve before the deadline, within bounds") {
  Timed timed;
  const auto end_with = [&](double reserve_s, Carry carry, double periods, double of_periods = 1) {
    timed.now = 1 - of_periods * periods * kPeriod;
    timed.begin(1, reserve_s, carry, periods);
    return std::max(timed.clock.sampling_end_seconds(), timed.now);
  };
  CHECK(end_with(0.02, Carry::kNothing, 1) == Approx(0.98));
  CHECK(end_with(0, Carry::kNothing, 1) == Approx(1 - 0.04 * kPeriod));
  CHECK(end_with(0.5, Carry::kNothing, 1) == Approx(1 - 0.7 * kPeriod));
  CHECK(end_with(0.5, Carry::kAccumulate, 1) == Approx(1 - kPeriod));
  CHECK(end_with(0, Carry::kNothing, 2) == Approx(1 - 0.08 * kPeriod));
  CHECK(end_with(0.5, Carry::kNothing, 2) == Approx(1 - 1.4 * kPeriod));
  // A frame may begin when the one before is done, or later than it should.
  CHECK(end_with(0.5, Carry::kNothing, 1, 1.5) == Approx(1 - 0.7 * 1.5 * kPeriod));
  CHECK(end_with(0.5, Carry::kNothing, 1, 3) == Approx(1 - 0.7 * 2 * kPeriod));
  CHECK(end_with(0.5, Carry::kNothing, 1, 0.9) == Approx(1 - 0.7 * kPeriod));
  CHECK(end_with(0.5, Carry::kAccumulate, 1, 1.5) == Approx(1 - kPeriod));
}

TEST_CASE("set wall clock: with less effort sampling takes that share of its time") {
  Timed timed;
  timed.now = 0.5;
  timed.begin(1, 0.1, Carry::kAccumulate, 1, 0.25);
  CHECK(timed.clock.sampling_end_seconds() == Approx(0.5 + 0.25 * 0.4));
  CHECK(timed.clock.frame_seconds() == Approx(0).margin(1e-12));
  timed.now = 0.55;
  CHECK(timed.clock.frame_seconds() == Approx(0.05));
  timed.now = 0.95;  // late: no time is left
  timed.begin(1, 0.1, Carry::kAccumulate, 1, 0.25);
  CHECK(timed.clock.sampling_end_seconds() == Approx(0.95));
  timed.begin(1, 0.1, Carry::kAccumulate, 1, 1);
  timed.clock.begin_packet(0);
  CHECK(timed.clock.sampling_over());
}

TEST_CASE("set wall clock: a packet has its samples, and ends early when sampling is over") {
  for (const double ranks_per_core : {1.0, 2.0}) {
    Timed timed(ranks_per_core);
    timed.begin(1);
    const int whole = ranks_per_core > 1 ? 48 : 128;
    for (int packet = 0; packet < 2; ++packet) {
      timed.clock.begin_packet(0);
      CHECK(samples_of_packet(timed.clock) == whole);
    }
    timed.clock.begin_packet(0);
    timed.now = 2;
    CHECK(samples_of_packet(timed.clock) < 8);  // the time is looked at so often
    timed.clock.begin_packet(0);                // a new picture gets some all the same
    CHECK(samples_of_packet(timed.clock) < 8);
    CHECK(timed.clock.sampling_over());
  }
  Timed without_rate(1, false, 0);
  without_rate.begin(0);
  without_rate.now = 1e6;
  without_rate.clock.begin_packet(0);
  CHECK(samples_of_packet(without_rate.clock) == 128);
}

TEST_CASE("set wall clock: a share of the sampling time has passed, counted from its first packet") {
  Timed timed;
  timed.begin(1, 0.1, Carry::kAccumulate);
  timed.now = 0.4;
  timed.clock.begin_packet(100);  // until then it was cast
  CHECK(timed.clock.sampling_share() == Approx(0.01));
  timed.now = 0.525;
  timed.clock.begin_packet(200);
  CHECK(timed.clock.sampling_share() == Approx(0.25));
  CHECK(*timed.clock.expected_growth(100, 200) == Approx(1 + 0.5 * 3));
  CHECK(*timed.clock.expected_growth(150, 200) == Approx(1 + 0.25 * 3));
  CHECK(*timed.clock.expected_growth(200, 200) == Approx(1));
  CHECK_FALSE(timed.clock.expected_growth(0, 0));
  timed.now = 3;
  CHECK(timed.clock.sampling_share() == 1);
  // The next frame counts anew.
  timed.begin(4, 0.1, Carry::kAccumulate);
  timed.now = 3.45;
  CHECK(timed.clock.sampling_share() == Approx(0.5));
}

TEST_CASE("set wall clock: the pace is that of sampling without rest, and follows what is new by a quarter") {
  Timed timed;
  const auto sample = [&](double prepare_s, double took_s, double rested_s, double units) {
    timed.begin(timed.now + 1);
    timed.now += prepare_s;
    timed.clock.rested(prepare_s);  // before sampling: does not count
    timed.clock.begin_packet(0);
    timed.now += 0.5 * took_s;
    CHECK(timed.clock.rested(rested_s) == Approx(1e3 * rested_s));
    timed.clock.begin_packet(0);
    timed.now += 0.5 * took_s;
    timed.clock.end_sampling(units);
    return timed.clock.pace();
  };
  CHECK(timed.clock.pace() == 1);
  CHECK(sample(0.1, 0.003, 0.001, 1.9e5) == 1);  // too little work to learn from
  CHECK(sample(0.1, 0.003, 0.001, 1e6) == Approx(2));
  CHECK(sample(0.1, 0.007, 0.001, 1e6) == Approx(2 + 0.25 * 4));
  CHECK(sample(0.1, 0.001, 0, 1e6) == Approx(3 - 0.25 * 2));
  CHECK(sample(0.1, 1, 0, 1.9e5) == Approx(2.5));
}

TEST_CASE("set wall clock: work is affordable by its price, the frame's time and the ranks of a core") {
  for (const double periods : {1.0, 2.0}) {
    for (const double ranks_per_core : {1.0, 4.0}) {
      Timed timed(ranks_per_core);
      timed.begin(1, 0, Carry::kNothing, periods);
      const double rays = 0.25 * periods * kPeriod * 1e9 / static_cast<double>(price(Work::kRay));
      CHECK(timed.clock.affordable(Work::kRay, 0.25) ==
            static_cast<std::size_t>(std::floor(rays / ranks_per_core)));
    }
  }
}

TEST_CASE("set wall clock: reconstruction is expected by samples and pixels, by the slowest of eight") {
  Timed timed(2);
  timed.clock.region_changed(static_cast<std::size_t>(kPixelsPerSample * 100));
  timed.begin(1, 0.01);
  timed.reconstruct(300, 4, 0.5);  // half the region: all of it would have taken eight
  const double each_s = 0.008 / 400;
  const auto left_with = [&](std::uint64_t samples) {
    timed.clock.begin_packet(samples);
    return 1 - timed.clock.sampling_end_seconds();
  };
  CHECK(left_with(300) == Approx(0.01 + 1.25 * 2 * each_s * 400));
  CHECK(left_with(900) == Approx(0.01 + 1.25 * 2 * each_s * 1000));
  timed.reconstruct(300, 100, 0);  // of nothing: nothing is learned
  CHECK(left_with(300) == Approx(0.01 + 1.25 * 2 * each_s * 400));
  for (int frame = 0; frame < 7; ++frame) timed.reconstruct(300, 1, 1);
  CHECK(left_with(300) == Approx(0.01 + 1.25 * 2 * each_s * 400));
  timed.reconstruct(300, 1, 1);
  CHECK(left_with(300) == Approx(0.01 + 1.25 * 2 * 0.001));
}

TEST_CASE("set wall clock: a pixel of several surfaces counts as eight samples, in its own frame alone") {
  Timed timed;
  timed.begin(1, 0.01);
  timed.clock.mixed_pixels_found(50);
  timed.reconstruct(100, 5);
  const double each_s = 0.005 / 500;
  CHECK(timed.left_with_mixed(50) == Approx(0.01 + 1.25 * each_s * 500));
  CHECK(timed.left_with_mixed(1) == Approx(0.01 + 1.25 * each_s * 108));
  CHECK(timed.left_with_mixed(100) == Approx(0.01 + 1.25 * each_s * 900));
}

TEST_CASE("set wall clock: what pictures take whose surfaces are seen tells nothing of others") {
  Timed timed;
  timed.begin(1, 0.01);
  timed.reconstruct(100, 1);
  timed.clock.mixed_pixels_found(50);
  timed.reconstruct(100, 15);
  CHECK(timed.left_with_mixed(0) == Approx(0.01 + 1.25 * 0.001));
  CHECK(timed.left_with_mixed(50) == Approx(0.01 + 1.25 * 0.015));
}

TEST_CASE(
    "set wall clock: seeing and painting a pixel of several surfaces take twice the quickest painting") {
  Timed timed;
  CHECK(timed.clock.mixed_pixel_units() == 0);
  timed.begin(1, 0.01);
  timed.clock.mixed_pixels_found(50);
  timed.reconstruct(100, 5);
  timed.reconstruct(100, 10);
  CHECK(timed.clock.mixed_pixel_units() == Approx(2 * 8 * 1e4));
  timed.begin(timed.now + 1);
  timed.clock.begin_packet(0);
  timed.now += 0.002;
  timed.clock.end_sampling(1e6);
  REQUIRE(timed.clock.pace() == Approx(2));
  CHECK(timed.clock.mixed_pixel_units() == Approx(8 * 1e4));
}

TEST_CASE("set wall clock: what is found to be seen while it is reconstructed counts in what that took") {
  Timed timed;
  timed.begin(1, 0.01);
  timed.clock.begin_packet(100);
  timed.clock.mixed_pixels_found(50);
  timed.clock.end_frame(5, 1);
  timed.clock.begin_packet(100);
  CHECK(1 - timed.clock.sampling_end_seconds() == Approx(0.01 + 1.25 * 0.005));
}

TEST_CASE("set wall clock: sampling has not ended earlier because surfaces were found to be seen") {
  Timed timed;
  timed.begin(1, 0.01);
  timed.reconstruct(1000, 50);
  timed.now = 0.93;
  timed.clock.begin_packet(100);
  REQUIRE(timed.clock.sampling_end_seconds() > 0.93);
  timed.clock.mixed_pixels_found(1'000'000);
  timed.clock.begin_packet(100);
  CHECK(timed.clock.sampling_over());
  CHECK(timed.clock.sampling_end_seconds() == 0.93);
}

TEST_CASE("set wall clock: a forecast tells how many samples fit, and how many a mixed pixel is worth") {
  for (const double ranks_per_core : {1.0, 2.0}) {
    Timed timed(ranks_per_core);
    timed.begin(1, 0.01);
    timed.now = 0.95;
    timed.clock.region_changed(static_cast<std::size_t>(kPixelsPerSample * 400));
    constexpr double kFirst = 1.3e-7, kEach = 1e-5;
    const auto painting = [&](double each_s) { return 1.25 * each_s * ranks_per_core; };
    const TimeForecast first = timed.clock.forecast(100, kEach).value();
    CHECK(first.samples ==
          Approx(100 + (0.045 - painting(kFirst) * 500) / (kEach * ranks_per_core + painting(kFirst))));
    CHECK(first.mixed_pixel == Approx(8 * kFirst / kEach));
    // Half of the reserve counts as left. A mixed pixel takes what it took in the quickest picture seen.
    timed.clock.mixed_pixels_found(100);
    for (const double ms : {26.0, 13.0, 39.0}) timed.reconstruct(100, ms);
    const TimeForecast seen = timed.clock.forecast(100, kEach).value();
    CHECK(seen.samples == Approx(first.samples));
    CHECK(seen.mixed_pixel == Approx(8 * 1e-5 / kEach));
    timed.now = 2;
    CHECK(timed.clock.forecast(100, kEach).value().samples == 100);
    CHECK_FALSE(timed.clock.forecast(0, kEach));
  }
  Timed without_rate(1, false, 0);
  without_rate.begin(0);
  CHECK_FALSE(without_rate.clock.forecast(100, 1e-6));
}

TEST_CASE("set wall clock: beside others that want its core a rank's samples take longer") {
  const auto samples_at = [](double ranks_per_core, std::int64_t waited_ns, double reserve_s) {
    Timed timed(ranks_per_core);
    timed.run = {.ran_ns = 50, .waited_ns = 1000};  // before the first frame
    timed.begin(1);
    timed.run.ran_ns += 100, timed.run.waited_ns += waited_ns;
    timed.now = 0.9;
    timed.begin(1, reserve_s);
    return timed.clock.forecast(100, 1e-4).value().samples - 100;
  };
  constexpr double kReserve = 0.03, kTwice = 2 * kReserve;  // of an undisturbed frame half is left
  const double beside = samples_at(1, 50, kReserve);
  CHECK(beside == Approx(samples_at(1.5, 0, kTwice)).epsilon(0.01));
  CHECK(samples_at(1, 0, kTwice) == Approx(1.5 * beside).epsilon(0.01));
  CHECK(samples_at(1.5, 50, kReserve) == Approx(beside).epsilon(0.01));  // the ranks that share it, maybe
}

TEST_CASE("set wall clock: beside others up to two fifths of the period are reserved, whatever frames took") {
  const auto left_at = [](std::int64_t waited_ns, double reserve_s) {
    Timed timed;
    timed.begin(1);
    timed.run.ran_ns += 100, timed.run.waited_ns += waited_ns;
    timed.begin(1, reserve_s);
    return 1 - timed.clock.sampling_end_seconds();
  };
  CHECK(left_at(0, 0.01) == Approx(0.01).epsilon(0.01));
  CHECK(left_at(50, 0.01) == Approx(0.2 * kPeriod));
  CHECK(left_at(100, 0.01) == Approx(0.4 * kPeriod));
  CHECK(left_at(300, 0.01) == Approx(0.4 * kPeriod));
  CHECK(left_at(100, 0.06) == Approx(0.06));
}

TEST_CASE("set wall clock: a frame of which no one has come back is forecast by its whole reserve") {
  const auto samples_of = [](int index, double reserve_s) {
    Timed timed;
    FrameOrder order;
    order.index = index, order.deadline_s = 1, order.reserve_s = reserve_s;
    timed.now = 0.9;
    timed.clock.begin_frame(order);
    return timed.clock.forecast(100, 1e-4).value().samples;
  };
  CHECK(samples_of(0, 0.03) == Approx(samples_of(1, 0.06)));
  CHECK(samples_of(0, 0.03) < 0.9 * samples_of(1, 0.03));
}

TEST_CASE("set wall clock: beside others that want its core frames are expected to be as bad as the worst") {
  const auto forecast_at = [](std::int64_t waited_ns, double reserve_s) {
    Timed timed;
    timed.begin(1);
    timed.clock.mixed_pixels_found(100);
    for (const double ms : {26.0, 13.0, 39.0}) timed.reconstruct(100, ms);
    timed.run.ran_ns += 100, timed.run.waited_ns += waited_ns;
    timed.now = 0.9;
    timed.begin(1, reserve_s);
    return timed.clock.forecast(100, 1e-4).value();
  };
  const auto lost_to_reserve = [&](std::int64_t waited_ns) {
    const double samples = forecast_at(waited_ns, 0.04).samples - forecast_at(waited_ns, 0.06).samples;
    return samples * (1 + 0.01 * static_cast<double>(waited_ns));  // in time
  };
  CHECK(lost_to_reserve(50) == Approx(2 * lost_to_reserve(0)).epsilon(0.01));
  CHECK(lost_to_reserve(100) == Approx(2 * lost_to_reserve(0)).epsilon(0.01));
  CHECK(lost_to_reserve(25) == Approx(1.5 * lost_to_reserve(0)).epsilon(0.01));
  const double quickest = forecast_at(0, 0).mixed_pixel;
  CHECK(forecast_at(25, 0).mixed_pixel == Approx(2 * quickest));
  CHECK(forecast_at(50, 0).mixed_pixel == Approx(3 * quickest));
}

TEST_CASE("set wall clock: before it is measured reconstruction is expected to take 130 ns for a sample") {
  Timed timed;
  timed.begin(1, 0.01);
  timed.clock.begin_packet(100'000);
  CHECK(1 - timed.clock.sampling_end_seconds() == Approx(0.01 + 1.25 * 0.013));
}

TEST_CASE("set wall clock: a resting picture in parts leaves at most 35 % of the time for them") {
  for (const bool rests : {true, false}) {
    Timed timed(1, true);
    timed.begin(1, 0.01, rests ? Carry::kAccumulate : Carry::kNothing);
    timed.reconstruct(1000, 40);
    timed.begin(1, 0.01, rests ? Carry::kAccumulate : Carry::kNothing);
    timed.clock.begin_packet(1000);
    CHECK(1 - timed.clock.sampling_end_seconds() == Approx(0.01 + (rests ? 0.35 * kPeriod : 1.25 * 0.04)));
    CHECK_FALSE(timed.clock.is_fine_enough());
  }
}

TEST_CASE("set wall clock: tiles of which a resting picture shows nothing yet are left their time") {
  Timed timed(1, true);
  timed.begin(1, 0.01, Carry::kAccumulate);
  timed.reconstruct(1000, 48);
  const auto left_with = [&](double unshown) {
    timed.clock.unshown_found(unshown);
    timed.clock.begin_packet(1000);
    return 1 - timed.clock.sampling_end_seconds();
  };
  CHECK(left_with(0.5) == Approx(0.01 + 0.35 * kPeriod));
  CHECK(left_with(0.75) == Approx(0.01 + 0.75 * 0.06));
  CHECK(left_with(1) == Approx(0.01 + 0.06));
}

TEST_CASE(
    "set wall clock: a part is begun if it would be over in time, were it as long as the longest of late") {
  for (const double reserve_s : {0.0, 0.02}) {
    Timed timed(1, true);
    timed.begin(1, reserve_s, Carry::kAccumulate);
    timed.now = 0.9;
    timed.clock.end_sampling(0);
    timed.now = 0.93;
    CHECK_FALSE(timed.clock.reconstruction_over());  // another would end at .96
    timed.now = 0.95;
    CHECK_FALSE(timed.clock.reconstruction_over());  // at .97
    timed.now = 0.972;
    CHECK(timed.clock.reconstruction_over() ==
          (reserve_s > 0));  // at .994: .996 is the end without a reserve
  }
  Timed unlike(1, true);
  unlike.begin(1, 0, Carry::kAccumulate);
  const auto is_over_after = [&](double part_s) {
    unlike.now += part_s;
    return unlike.clock.reconstruction_over();
  };
  unlike.now = 0.8;
  unlike.clock.end_sampling(0);
  CHECK_FALSE(is_over_after(0.1));   // what came first, new tiles perhaps, was none of them
  CHECK_FALSE(is_over_after(0.04));  // another would end at .98
  CHECK_FALSE(is_over_after(0.01));  // one like the longest at .986
  CHECK_FALSE(is_over_after(0.01));  // at .9924
  CHECK(is_over_after(0.01));        // at .9992
  Timed moving(1, true);
  moving.begin(1, 0.02);
  moving.now = 5;
  CHECK_FALSE(moving.clock.reconstruction_over());  // it must be whole
  Timed without_rate(1, true, 0);
  without_rate.begin(0, 0, Carry::kAccumulate);
  without_rate.now = 5;
  CHECK_FALSE(without_rate.clock.reconstruction_over());
}

TEST_CASE("set wall clock: a resting picture as a whole waits for its turn, and saves the time for it") {
  Timed timed;
  timed.begin(1, 0.01, Carry::kAccumulate);
  timed.reconstruct(1000, 60);  // with a quarter more .75 of the period, of which each frame saves .35
  std::vector<bool> turns;
  for (int frame = 0; frame < 7; ++frame) {
    timed.begin(1, 0.01, Carry::kAccumulate);
    turns.push_back(!timed.clock.reconstruction_over());
    timed.clock.begin_packet(1000);
    CHECK(1 - timed.clock.sampling_end_seconds() == Approx(0.01 + (turns.back() ? 0.075 : 0)));
  }
  CHECK(turns == std::vector{false, false, true, false, false, true, false});
  // Frames that take longer save more.
  timed.begin(1, 0.01, Carry::kAccumulate, 2);
  CHECK_FALSE(timed.clock.reconstruction_over());
}

TEST_CASE("set wall clock: a resting picture is fine enough when its reconstruction would fill the frame") {
  const auto is_fine_enough = [](std::uint64_t samples, Carry carry, bool in_parts, double deadline_s) {
    Timed timed(1, in_parts);
    timed.begin(1, 0.02, carry);
    timed.reconstruct(1000, 40);  // 50 of 100 are expected of as many again
    timed.begin(deadline_s, 0.02, carry);
    timed.clock.begin_packet(samples);
    return timed.clock.is_fine_enough();
  };
  CHECK_FALSE(is_fine_enough(1590, Carry::kAccumulate, false, 1));
  CHECK(is_fine_enough(1610, Carry::kAccumulate, false, 1));
  CHECK_FALSE(is_fine_enough(1610, Carry::kAccumulate, true, 1));
  CHECK_FALSE(is_fine_enough(1610, Carry::kNothing, false, 1));
  CHECK_FALSE(is_fine_enough(1610, Carry::kAccumulate, false, 0));
}

}  // namespace pprt::wall_clock_test
