#include "parallel/clock/reserve_estimator.h"

#include <catch2/catch.hpp>

namespace pprt::reserve_estimator_test {
namespace {

constexpr double kPeriod = 0.25;

TEST_CASE("reserve: the worst of the last twelve frames and a quarter more") {
  ReserveEstimator reserve(kPeriod, 1);
  CHECK(reserve.reserve_s() == Approx(0.2 * kPeriod));  // nothing is known yet
  reserve.learn(0.02);
  CHECK(reserve.reserve_s() == Approx(1.25 * 0.02 + 0.0005));
  for (int frame = 0; frame < 11; ++frame) reserve.learn(0.01);
  CHECK(reserve.reserve_s() == Approx(1.25 * 0.02 + 0.0005));
  reserve.learn(0.01);
  CHECK(reserve.reserve_s() == Approx(1.25 * 0.01 + 0.0005));
}

TEST_CASE(
    "reserve: larger where ranks share cores, at most seven tenths of the period, none without a rate") {
  ReserveEstimator shared(kPeriod, 2), no_rate(0, 1);
  shared.learn(0.02);
  no_rate.learn(0.02);
  CHECK(shared.reserve_s() == Approx(1.7 * 0.02 + 0.001));
  shared.learn(10);
  CHECK(shared.reserve_s() == Approx(0.7 * kPeriod));
  CHECK(no_rate.reserve_s() == 0);
}

TEST_CASE("reserve: reconstruction of all ranks of a core does not count") {
  const ReserveEstimator reserve(kPeriod, 4);
  CHECK(reserve.after_sampling_s(1.2, 1.0, 10) == Approx(0.2 - 0.04));
  CHECK(reserve.after_sampling_s(1.02, 1.0, 10) == 0);
}

}  // namespace
}  // namespace pprt::reserve_estimator_test
