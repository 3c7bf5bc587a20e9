#include "render/plan/film_time.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

namespace pprt::film_time_test {
namespace {

FramePrice price(double rmse, double deviation_share = 0, bool cut = false) {
  return {{rmse * rmse, std::pow(deviation_share * rmse * rmse, 2), 0}, cut};
}

double sum_of(const std::vector<double>& times) {
  return std::accumulate(times.begin(), times.end(), 0.0);
}

}  // namespace

TEST_CASE("film time: frames get what makes their errors equal, in all as much as before") {
  const std::vector<FramePrice> prices = {price(0.01), price(0.02), price(0.03), price(0.02)};
  const std::vector<double> times = divided_time(prices);
  REQUIRE(times.size() == 4);
  CHECK(sum_of(times) == Approx(4));
  for (std::size_t i = 1; i < 4; ++i) {
    const double error = std::sqrt(prices[i].error.squared) * std::pow(times[i], -0.65);
    CHECK(error == Approx(0.01 * std::pow(times[0], -0.65)));
  }
}

TEST_CASE("film time: no frame gets less than a fifth, and nothing measured is divided evenly") {
  const std::vector<double> times =
      divided_time(std::vector<FramePrice>{price(0), price(0.02), price(0.02), price(0.02)});
  CHECK(times[0] > 0.15);
  CHECK(sum_of(times) == Approx(4));
  CHECK(divided_time(std::vector<FramePrice>(3)) == std::vector<double>(3, 1));
}

TEST_CASE("film time: frames known roughly are priced with their neighbours, but not across a cut") {
  std::vector<FramePrice> prices;
  for (int i = 0; i < 8; ++i) prices.push_back(price(i % 2 == 0 ? 0.01 : 0.03, 1.5));
  for (int i = 0; i < 8; ++i) prices.push_back(price(0.06, 1.5, i == 0));
  const std::vector<double> times = divided_time(prices);
  CHECK(std::abs(times[3] / times[4] - 1) < 0.3);
  CHECK(times[8] == Approx(times[15]));
  CHECK(times[7] < 0.6 * times[8]);
}

TEST_CASE("film time: both passes take the film's time together") {
  const SessionSettings film{.sampler = SamplerChoice::kAuto};
  const SessionSettings pricing = pricing_settings(film, 48, 10);
  CHECK(48 / pricing.frames_per_second == Approx(10 * kPricingShare));
  CHECK(pricing.probe_share > 10 * film.probe_share);
  CHECK(48 / pass_settings(film, 48, 8).frames_per_second == Approx(8));
}

}  // namespace pprt::film_time_test
