#include "pipeline/casting/cast_choice.h"
#include "pipeline/core/display_values.h"

#include <array>
#include <bit>
#include <catch2/catch.hpp>
#include <cstddef>
#include <numeric>

namespace pprt::cast_choice_test {
namespace {

// A hundred fresh samples of seven rays each, in triangles of half a square pixel where the picture was wrong
// by 0.1; eight stale ones.
CastEvidence evidence(double stale_rms) {
  CastEvidence e;
  e.asked = 20;
  e.fresh = 100, e.fresh_area = 50, e.fresh_error = 50 * 0.1 * 0.1, e.fresh_rays = 700;
  e.stale = 8, e.stale_error = 8 * stale_rms * stale_rms;
  return e;
}

// A fresh sample costs 705 and 110 a ray.
constexpr CastPrices kPrices = {.cast = 935, .fresh = 705, .ray = 110};

CastLimits limits_of(const CastEvidence& e, const CastSummary& cast) {
  return cast_limits(e, cast, kPrices);
}

}  // namespace

TEST_CASE(
    "cast choice: the display error is the mean of the channels' squared differences on the display scale") {
  CHECK(display_error({0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0.5f}) == 0);
  CHECK(display_error({1, 0, 0}, {0, 0, 0}) == Approx(1.0 / 3));
  CHECK(display_error({0.75f, 0.5f, 0}, {0.25f, 0, 0}) == Approx(0.5 / 3));
  CHECK(display_error({5, 1, 1}, {1, 3, 1}) == 0);  // both show as white
}

TEST_CASE("cast choice: eye-dependent colour is carried where its error is below 1.1 of the picture's") {
  CHECK(limits_of(evidence(0.109), {1, 0, 0.5}).eye_dependent);
  CHECK_FALSE(limits_of(evidence(0.111), {1, 0, 0.5}).eye_dependent);
}

TEST_CASE("cast choice: the picture's error is weighted by area, not by number of samples") {
  CastEvidence e = evidence(0.05);
  CHECK(limits_of(e, {1, 0, 0.5}).eye_dependent);
  // As many samples more, in large triangles that were right.
  e.fresh *= 2, e.fresh_area *= 20;
  CHECK_FALSE(limits_of(e, {1, 0, 0.5}).eye_dependent);
}

TEST_CASE("cast choice: eye-dependent colour is not carried without evidence of its error") {
  CastEvidence no_stale = evidence(0.01), no_fresh = evidence(0.01);
  no_stale.stale = 0, no_stale.stale_error = 0;
  no_fresh.fresh = 0, no_fresh.fresh_area = 0, no_fresh.fresh_error = 0, no_fresh.fresh_rays = 0;
  CHECK_FALSE(limits_of(no_stale, {1, 0, 0.5}).eye_dependent);
  CHECK_FALSE(limits_of(no_fresh, {1, 0, 0.5}).eye_dependent);
  CHECK(limits_of({}, {1, 0, 0.5}).share == 0.5);  // other samples are carried, to be measured
}

TEST_CASE(
    "cast choice: samples live four frames where most colours are eye-dependent and hold, two elsewhere") {
  CHECK(cast_life(evidence(0.064), 0.6) == 4);
  CHECK(cast_life(evidence(0.066), 0.6) == 2);
  CHECK(cast_life(evidence(0.064), 0.4) == 2);
  CastEvidence outlines_change = evidence(0.064);
  outlines_change.hidden = 4;  // of 20
  CHECK(cast_life(outlines_change, 0.6) == 2);
  CHECK(cast_life({}, 0.6) == 2);  // nothing is known of them
}

TEST_CASE(
    "cast choice: with the eye at rest all samples are carried, but a fine picture of outlines takes one a "
    "pixel") {
  for (const double eye_dependent : {0.2, 0.8}) {
    for (const double samples_per_pixel : {0.5, 1.5}) {
      CAPTURE(eye_dependent, samples_per_pixel);
      const CastLimits limits = cast_limits_at_rest({5, eye_dependent, samples_per_pixel});
      CHECK(limits.eye_dependent);
      CHECK(limits.share == 0.5);
      CHECK(limits.one_a_pixel == (eye_dependent < 0.5 && samples_per_pixel > 1));
    }
  }
}

TEST_CASE("cast choice: a coarse picture that moved far and hides much reinserts less, and no other does") {
  CastEvidence e = evidence(0.01);
  e.hidden = 4;  // of 20
  CHECK(limits_of(e, {5, 0, 0.5}).share == Approx(0.2));
  CHECK(limits_of(e, {1, 0, 0.5}).share == Approx(0.5));
  CHECK(limits_of(e, {5, 0, 1.5}).share == Approx(0.5));
  CHECK(limits_of(e, {5, 0.6, 0.5}).share == Approx(0.5));
  e.hidden = 3;
  CHECK(limits_of(e, {5, 0, 0.5}).share == Approx(0.5));
}

TEST_CASE("cast choice: samples have moved far beyond two pixels and a half, not at that") {
  CastEvidence e = evidence(0.01);
  e.hidden = 4;  // of 20
  CHECK(limits_of(e, {2.5, 0, 0.5}).share == Approx(0.5));
  CHECK(limits_of(e, {2.501, 0, 0.5}).share == Approx(0.2));
}

TEST_CASE(
    "cast choice: nothing is carried where a cast sample that proves right is priced as high as a fresh "
    "one") {
  const CastSummary fine = {5, 0, 1.5};
  CastEvidence e = evidence(0.01);
  CHECK(limits_of(e, fine).share > 0);
  e.hidden = 8;  // 1558 against 0.9 * 1475
  CHECK(limits_of(e, fine).share == 0);
  e.hidden = 5;  // 1247
  CHECK(limits_of(e, fine).share > 0);
  e.hidden = 0, e.fresh_rays = 400;  // 935 against 0.9 * 1145
  CHECK(limits_of(e, fine).share > 0);
  e.hidden = 3;  // 1100
  CHECK(limits_of(e, fine).share == 0);
  // A picture of outlines that has moved little pays a tenth more than a fresh one costs: 1260.
  CHECK(limits_of(e, {1, 0, 0.5}).share > 0);
  CHECK(limits_of(e, {1, 0, 1.5}).share > 0);
  CHECK(limits_of(e, {1, 0.6, 0.5}).share == 0);
  CHECK(limits_of(e, {5, 0, 0.5}).share == 0);
  e.hidden = 6;  // 1336
  CHECK(limits_of(e, {1, 0, 0.5}).share == 0);
}

TEST_CASE("cast choice: measured times decide before fixed prices") {
  // By the table a fresh sample costs 1475 units and a carried one 935; here 0.8 ms for a hundred of them.
  CastEvidence e = evidence(0.01);
  e.asked_ms = 0.2 * 20 / 100, e.reinserted = 1000, e.reinserted_ms = 0.6 * 1000 / 100;
  const auto carries = [&e](double fresh_ms) {
    e.fresh_ms = fresh_ms;
    return limits_of(e, {1, 0, 0.5}).share > 0;
  };
  CHECK(carries(1.01));
  CHECK_FALSE(carries(0.99));
  e.hidden = 10;  // of 20: each that proves right is paid for twice
  CHECK(carries(2.01));
  CHECK_FALSE(carries(1.99));
  // Where colours that depend on the eye are no good, the others must be cheaper.
  e.hidden = 0, e.stale_error = 8;
  CHECK(carries(3.3));
  CHECK_FALSE(carries(3.1));
}

TEST_CASE("cast choice: nothing is carried by measured times before they are known") {
  CastEvidence e = evidence(0.01);
  e.asked_ms = 0.01, e.reinserted = 10, e.reinserted_ms = 0.01, e.fresh_ms = 1;
  CHECK(limits_of(e, {1, 0, 0.5}).share > 0);
  CastEvidence none_asked = e, none_reinserted = e;
  none_asked.asked = 0, none_asked.asked_ms = 0;
  none_reinserted.reinserted = 0, none_reinserted.reinserted_ms = 0;
  CHECK(limits_of(none_asked, {1, 0, 0.5}).share == 0);
  CHECK(limits_of(none_reinserted, {1, 0, 0.5}).share == 0);
}

TEST_CASE("cast choice: nothing is carried above four samples a pixel") {
  CHECK(limits_of(evidence(0.01), {1, 0, 3.5}).share > 0);
  CHECK(limits_of(evidence(0.01), {1, 0, 4.5}).share == 0);
}

TEST_CASE("cast choice: every field of the evidence adds up and is halved") {
  std::array<double, sizeof(CastEvidence) / sizeof(double)> sums{};
  std::iota(sums.begin(), sums.end(), 1);
  CastEvidence both = std::bit_cast<CastEvidence>(sums);
  both += std::bit_cast<CastEvidence>(sums);
  const auto doubled = std::bit_cast<decltype(sums)>(both);
  const auto halves = std::bit_cast<decltype(sums)>(halved(std::bit_cast<CastEvidence>(sums)));
  for (std::size_t i = 0; i < sums.size(); ++i) {
    CHECK(doubled[i] == 2 * sums[i]);
    CHECK(halves[i] == sums[i] / 2);
  }
}

TEST_CASE("cast choice: adding and halving evidence keeps its ratios") {
  CastEvidence sum = evidence(0.04);
  sum += evidence(0.04);
  CHECK(sum.fresh == 200);
  CHECK(halved(sum).stale_error == Approx(evidence(0.04).stale_error));
  CHECK(halved(sum).fresh_rays == 700);
  CHECK(halved(sum).fresh_area == 50);
}

}  // namespace pprt::cast_choice_test
