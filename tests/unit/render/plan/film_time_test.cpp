#include "render/plan/film_time.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

namespace pprt::film_time_test {
namespace {

ErrorEstimate price(double rmse, double deviation_share = 0) {
  return {rmse * rmse, std::pow(deviation_share * rmse * rmse, 2), 0};
}

double sum_of(const std::vector<double>& times) {
  return std::accumulate(times.begin(), times.end(), 0.0);
}

// Frames of which those in `cuts`, counted from 0, begin a shot.
std::vector<FrameRequest> film_of(int frames, const std::vector<int>& cuts) {
  std::vector<FrameRequest> film;
  for (int i = 0; i < frames; ++i)
    film.push_back({.number = i + 1, .camera = {}, .cut = std::count(cuts.begin(), cuts.end(), i) > 0});
  return film;
}

}  // namespace

TEST_CASE("film time: the quick pass has one frame of each four in a shot, and carries nothing") {
  const std::vector<FrameRequest> quick = pricing_requests(film_of(14, {6, 7}));
  std::vector<int> numbers;
  for (const FrameRequest& frame : quick) {
    numbers.push_back(frame.number);
    CHECK(frame.carries_nothing);
  }
  CHECK(numbers == std::vector<int>{3, 6, 7, 10, 13});  // of frames 1-4, 5-6, 7, 8-11, 12-14
}

TEST_CASE("film time: frames get what makes their errors equal, in all as much as before") {
  const std::vector<ErrorEstimate> prices = {price(0.01), price(0.02), price(0.03), price(0.02)};
  const std::vector<double> times = divided_time(film_of(4, {1, 2, 3}), prices);
  REQUIRE(times.size() == 4);
  CHECK(sum_of(times) == Approx(4));
  for (std::size_t i = 1; i < 4; ++i) {
    const double error = std::sqrt(prices[i].squared) * std::pow(times[i], -0.65);
    CHECK(error == Approx(0.01 * std::pow(times[0], -0.65)));
  }
}

TEST_CASE("film time: no frame gets less than a fifth, and nothing measured is divided evenly") {
  const std::vector<double> times = divided_time(
      film_of(4, {1, 2, 3}), std::vector<ErrorEstimate>{price(0), price(0.02), price(0.02), price(0.02)});
  CHECK(times[0] > 0.15);
  CHECK(sum_of(times) == Approx(4));
  CHECK(divided_time(film_of(9, {}), std::vector<ErrorEstimate>(3)) == std::vector<double>(9, 1));
}

TEST_CASE("film time: frames known roughly are priced with their neighbours, but not across a cut") {
  std::vector<ErrorEstimate> prices;
  for (int i = 0; i < 8; ++i) prices.push_back(price(i % 2 == 0 ? 0.01 : 0.03, 0.5));
  for (int i = 0; i < 8; ++i) prices.push_back(price(0.12, 0.5));
  const std::vector<double> times = divided_time(film_of(64, {32}), prices);
  REQUIRE(times.size() == 64);
  CHECK(std::abs(times[15] / times[16] - 1) < 0.3);
  CHECK(times[32] == Approx(times[63]));
  CHECK(times[31] < 0.6 * times[32]);
}

TEST_CASE("film time: what chance alone may make of equal errors divides nothing") {
  std::vector<ErrorEstimate> prices;
  for (int i = 0; i < 12; ++i) prices.push_back(price(i % 2 == 0 ? 0.0109 : 0.0092, 0.15));
  CHECK(divided_time(film_of(48, {}), prices) == std::vector<double>(48, 1));
  for (std::size_t i = 6; i < 12; ++i) prices[i] = price(0.02, 0.15);
  CHECK(divided_time(film_of(48, {}), prices).back() > 1.3);
}

TEST_CASE("film time: both passes take the film's time together") {
  const SessionSettings film{.sampler = SamplerChoice::kAuto};
  const SessionSettings pricing = pricing_settings(film, 12, 10);
  CHECK(12 / pricing.frames_per_second == Approx(10 * kPricingShare));
  CHECK(pricing.probe_share > 10 * film.probe_share);
  CHECK(48 / pass_settings(film, 48, 8).frames_per_second == Approx(8));
}

}  // namespace pprt::film_time_test
