#include "parallel/clock/clock_estimate.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

namespace pprt::clock_estimate_test {
namespace {

constexpr double kHour = 3600, kHostsApart = 1e5;

// A rank's clock against true time, which is rank 0's.
struct RankClock {
  double ahead_s = 0;
  double faster = 0;
  double time(double true_s) const { return true_s * (1 + faster) + ahead_s; }
};

// Exchanges over a network that takes 50 us at least, and often much longer for one of the two ways.
class Exchanges {
 public:
  ClockExchange at(double true_s, const RankClock& clock) {
    const double there_s = delay_s(), back_s = delay_s();
    return {true_s, clock.time(true_s + there_s), true_s + there_s + back_s};
  }

 private:
  double delay_s() {
    const bool is_busy = std::uniform_real_distribution<double>()(random_) < 0.3;
    return 50e-6 + std::exponential_distribution<double>(is_busy ? 1 / 8e-3 : 1 / 1e-4)(random_);
  }
  std::mt19937 random_{7};
};

double error_s(const ClockEstimate& estimate, const RankClock& clock, double true_s) {
  return std::abs(estimate.line().to_rank_0(clock.time(true_s)) - true_s);
}

TEST_CASE("clock estimate: a clock that runs fast or slow is known to a millisecond for an hour") {
  for (const double faster : {2e-4, -2e-4, 1e-6}) {
    const RankClock clock{kHostsApart, faster};
    Exchanges exchanges;
    ClockEstimate estimate;
    for (int i = 0; i < 8; ++i) CHECK_FALSE(estimate.add(exchanges.at(1e-3 * i, clock)));
    const ClockEstimate at_start = estimate;
    double worst_s = 0;
    for (int second = 1; second < kHour; ++second) {
      worst_s = std::max(worst_s, error_s(estimate, clock, second));  // a second after the last exchange
      CHECK_FALSE(estimate.add(exchanges.at(second, clock)));
    }
    INFO("runs faster by " << faster);
    CHECK(worst_s < 1e-3);
    // What the start alone tells is not enough.
    CHECK(error_s(at_start, clock, kHour) > 0.9 * std::abs(faster) * kHour - 1e-4);
    CHECK(estimate.line().faster == Approx(-faster).margin(5e-6));
  }
}

TEST_CASE("clock estimate: ranks that share a clock are never set apart") {
  const RankClock clock;
  Exchanges exchanges;
  ClockEstimate estimate;
  for (int second = 0; second < kHour; ++second) {
    CHECK_FALSE(estimate.add(exchanges.at(second, clock)));
    REQUIRE((estimate.line().ahead == 0 && estimate.line().faster == 0));
  }
}

TEST_CASE("clock estimate: a jump is told once, and known at once") {
  RankClock clock{kHostsApart, 3e-5};
  Exchanges exchanges;
  ClockEstimate estimate;
  const auto run = [&](int from, int to) {
    for (int second = from; second < to; ++second) CHECK_FALSE(estimate.add(exchanges.at(second, clock)));
  };
  run(0, 300);
  clock.ahead_s -= 12.5;  // it stood still, as in a virtual machine that was moved
  const auto jump = estimate.add(exchanges.at(300, clock));
  REQUIRE(jump.has_value());
  CHECK(*jump == Approx(-12.5).margin(0.02));
  run(301, 330);
  CHECK(error_s(estimate, clock, 330) < 1e-3);
  // Ranks that shared a clock may jump, too.
  RankClock own;
  ClockEstimate shared;
  CHECK_FALSE(shared.add(exchanges.at(1, own)));
  own.ahead_s = 3;
  CHECK(shared.add(exchanges.at(2, own)).value_or(0) == Approx(3).margin(0.1));
  CHECK(shared.line().to_rank_0(8) == Approx(5).margin(0.1));
}

// A rate is not known after a few exchanges. What it may add up to until the next good one is no jump.
TEST_CASE("clock estimate: a clock that drifts while nothing tells of it has not jumped") {
  constexpr double kQuick_s = 1e-4, kDrift = 1.5e-4;
  const auto exchange = [](const RankClock& clock, double true_s, double round_trip_s) {
    return ClockExchange{true_s, clock.time(true_s + 0.5 * round_trip_s), true_s + round_trip_s};
  };
  for (const double faster : {kDrift, -kDrift}) {
    RankClock clock{kHostsApart, faster};
    for (const double silent_s : {15.0, 60.0, 600.0}) {
      INFO("runs faster by " << faster << ", silent for " << silent_s << " s");
      ClockEstimate silent;
      for (int i = 0; i < 4; ++i) CHECK_FALSE(silent.add(exchange(clock, 1e-3 * i, kQuick_s)));
      ClockEstimate slow = silent;
      CHECK_FALSE(silent.add(exchange(clock, silent_s, kQuick_s)));
      // Answers that took long do not tell, either.
      for (double at_s = 1; at_s < silent_s; at_s += 5) CHECK_FALSE(slow.add(exchange(clock, at_s, 0.5)));
      CHECK_FALSE(slow.add(exchange(clock, silent_s, kQuick_s)));
      // What no such rate explains has.
      RankClock jumped = clock;
      jumped.ahead_s += 4e-4 * silent_s + 0.1;
      CHECK(silent.add(exchange(jumped, silent_s + 1, kQuick_s)));
      CHECK(slow.add(exchange(jumped, silent_s + 1, kQuick_s)));
    }
  }
}

}  // namespace
}  // namespace pprt::clock_estimate_test
