#include "parallel/master/measured_error.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

namespace pprt::measured_error_test {
namespace {

RankReport report_of(double squared, double variance, double third, double pixels, std::uint64_t probes = 5) {
  RankReport report;
  report.error = {.squared = squared,
                  .variance = variance,
                  .third = third,
                  .pixels = pixels,
                  .probes = probes,
                  .samples = 40,
                  .rays = 90};
  return report;
}

}  // namespace

TEST_CASE("measured error: sums of the ranks over their pixels") {
  ShotErrors errors;
  const std::vector<RankReport> ranks = {report_of(3, 4, 8, 60), report_of(1, 5, 19, 40)};
  const FrameError error = errors.add(true, ranks, 100).value();
  CHECK(error.own.squared == Approx(0.04));
  CHECK(error.own.variance == Approx(9e-4));
  CHECK(error.own.third == Approx(27e-6));
  CHECK(error.share == 1);
  CHECK((error.probes == 10 && error.samples == 80 && error.rays == 180));
  CHECK(error.shot.rmse == Approx(0.2));
}

TEST_CASE("measured error: a late rank's part of the picture is not measured") {
  ShotErrors errors;
  const std::vector<RankReport> ranks = {report_of(3, 4, 8, 75), RankReport()};
  const FrameError error = errors.add(true, ranks, 100).value();
  CHECK(error.share == 0.75);
  CHECK(error.own.squared == Approx(0.04));
  CHECK_FALSE(errors.add(false, std::vector<RankReport>(2), 100));
}

TEST_CASE("measured error: the upper bound is farther off where the distribution is skewed") {
  const double deviation = 0.001;
  const auto interval = [&](double skewness) {
    return ErrorEstimate{0.0036, deviation * deviation, skewness * std::pow(deviation, 3)}.interval();
  };
  CHECK(interval(0).rmse == Approx(0.06));
  CHECK(interval(0).low == Approx(std::sqrt(0.0036 - 1.96 * deviation)));
  CHECK(interval(0).high == Approx(std::sqrt(0.0036 + 1.96 * deviation)));
  CHECK(interval(0.5).low == interval(0).low);
  CHECK(interval(0.5).high == Approx(std::sqrt(0.0036 + 1.5 * 1.96 * deviation)));
  CHECK(interval(7).high == interval(1).high);
  CHECK(interval(-1).high == interval(0).high);
  CHECK(ErrorEstimate{-0.1, 0, 0}.interval().rmse == 0);
}

TEST_CASE("measured error: few probes are taken to miss the skewness, many show it") {
  const double deviation = 0.001;
  const auto growth = [&](double skewness, double probes) {
    const ErrorEstimate estimate{0.0036, deviation * deviation, skewness * std::pow(deviation, 3), probes};
    return (std::pow(estimate.interval().high, 2) - 0.0036) / (1.96 * deviation) - 1;
  };
  CHECK(growth(0.1, 64) == Approx(1));
  CHECK(growth(0.1, 256) == Approx(0.5));
  CHECK(growth(0.7, 256) == Approx(0.7));
  CHECK(growth(0.1, 1e6) == Approx(0.1));
  // Those of all frames count: 10 a frame.
  ShotErrors errors;
  const std::vector<RankReport> ranks = {report_of(1, 1, 0, 50), report_of(1, 1, 0, 50)};
  FrameError error;
  for (int frame = 0; frame < 10; ++frame) error = errors.add(frame == 0, ranks, 100).value();
  CHECK((error.own.probes == 10 && error.frame.probes == 10 && error.frame.pooled == 100));
  CHECK(error.shot.high == Approx(std::sqrt(0.02 + 1.96 * std::sqrt(2e-4 / 10) * 1.8)));
}

TEST_CASE("measured error: the frames of a shot narrow its interval, and a cut begins another shot") {
  ShotErrors errors;
  const std::vector<RankReport> small = {report_of(4, 16, 0, 100, 40)},
                                large = {report_of(16, 48, 0, 100, 40)};
  errors.add(true, small, 100);
  const FrameError second = errors.add(false, large, 100).value();
  CHECK(second.shot_frames == 2);
  CHECK(second.shot.rmse == Approx(std::sqrt(0.10)));
  CHECK(second.shot.high == Approx(std::sqrt(0.10 + 1.96 * 0.04 * (1 + 8 / std::sqrt(80)))));
  // Its own figure has the mean of both variances.
  CHECK(second.frame.squared == Approx(0.16));
  CHECK(second.frame.variance == Approx(0.0032));
  CHECK(second.own.variance == Approx(0.0048));
  const FrameError after_cut = errors.add(true, large, 100).value();
  CHECK(after_cut.shot_frames == 1);
  CHECK(after_cut.frame.variance == Approx(0.0048));
}

TEST_CASE("measured error: few probes do not tell an RMSE, whatever they find") {
  const auto interval = [](double squared, double deviation, double probes) {
    return ErrorEstimate{squared, deviation * deviation, 0, probes}.interval();
  };
  // What they may have missed all is at most this.
  const auto missed = [](double probes) { return std::sqrt(3 * (1 - std::pow(0.05, 1 / probes))); };
  for (const RmseInterval& few :
       {interval(0.0036, 1e-6, 10), interval(0, 0, 10), interval(1e-16, 1e-17, 10)}) {
    CHECK_FALSE(few.is_known);
    CHECK(few.low == 0);
    CHECK(few.high == Approx(missed(10)));
  }
  CHECK(interval(0.0036, 1e-6, 2).high == 1);
  CHECK_FALSE(interval(0.0036, 1e-3, kProbesForRmse - 1).is_known);
  CHECK(interval(0.0036, 1e-3, kProbesForRmse).is_known);
  CHECK(interval(0.0036, 1e-3, kProbesForRmse).high < 0.2);
}

TEST_CASE("measured error: probes that met none do not tell that there is none") {
  const RmseInterval none = ErrorEstimate{0, 0, 0, 1000}.interval();
  CHECK_FALSE(none.is_known);
  CHECK(none.low == 0);
  CHECK(none.high == Approx(std::sqrt(9.0 / 1000)).epsilon(0.01));           // the rule of three
  CHECK(ErrorEstimate{4e-17, 1e-34, 0, 1000}.interval().high == none.high);  // rounding
  CHECK(ErrorEstimate{1e-9, 1e-20, 0, 1000}.interval().is_known);
  // Two frames of few know more than one.
  ShotErrors errors;
  const std::vector<RankReport> ranks = {report_of(0, 0, 0, 50), report_of(0, 0, 0, 50)};
  const double first = errors.add(true, ranks, 100).value().shot.high;
  const FrameError second = errors.add(false, ranks, 100).value();
  CHECK((second.shot.high < first && second.shot_frames == 2));
  CHECK_FALSE(second.shot.is_known);
}

TEST_CASE("measured error: others' probes tell a frame's deviation, not that it has no error") {
  ShotErrors errors;
  const std::vector<RankReport> wrong = {report_of(4, 16, 0, 100, 2)},
                                met_none = {report_of(0, 0, 0, 100, 2)};
  FrameError error;
  for (int frame = 0; frame < 15; ++frame) error = errors.add(frame == 0, wrong, 100).value();
  CHECK_FALSE(error.frame.interval().is_known);  // 30 of the shot so far
  for (int frame = 0; frame < 2; ++frame) error = errors.add(false, wrong, 100).value();
  const RmseInterval known = error.frame.interval();
  CHECK(known.is_known);
  CHECK(known.rmse == Approx(0.2));
  CHECK(known.high == Approx(std::sqrt(0.04 + 1.96 * 0.04 * (1 + 8 / std::sqrt(34)))));
  error = errors.add(false, met_none, 100).value();
  CHECK_FALSE(error.frame.interval().is_known);
  CHECK(error.frame.interval().high == 1);  // two probes bound nothing
  CHECK(error.shot.is_known);
  // One frame of two probes deviates by its mean at least, however well the others agree.
  ShotErrors alike;
  const std::vector<RankReport> same = {report_of(4, 1e-9, 0, 100, 2)};
  for (int frame = 0; frame < 24; ++frame) error = alike.add(frame == 0, same, 100).value();
  CHECK(error.frame.interval().low == 0);
}

TEST_CASE("measured error: what is not seen is bounded by the rank, or the frame, with the fewest probes") {
  const auto bound = [](double probes) { return std::sqrt(3 * (1 - std::pow(0.05, 1 / probes))); };
  ShotErrors errors;
  const std::vector<RankReport> uneven = {report_of(0, 0, 0, 80, 100), report_of(0, 0, 0, 20, 100)};
  FrameError error = errors.add(true, uneven, 100).value();
  CHECK(error.own.interval().high == Approx(bound(125)));
  CHECK(error.frame.interval().high == Approx(bound(125)));
  errors.add(false, uneven, 100);
  const std::vector<RankReport> few = {report_of(0, 0, 0, 100, 40)};
  error = errors.add(false, few, 100).value();
  CHECK(error.shot.high == Approx(bound(3 * 40)));
}

TEST_CASE("measured error: an interval has a width where all probes agree") {
  const RmseInterval told = ErrorEstimate{0.04, 0, 0, 64}.interval();
  CHECK(told.low == Approx(std::sqrt(0.04 * (1 - 1.96 / 8))));
  CHECK(told.high == Approx(std::sqrt(0.04 * (1 + 2 * 1.96 / 8))));
  const RmseInterval spread = ErrorEstimate{0.04, 4e-4, 0, 64}.interval();
  CHECK(spread.low == Approx(std::sqrt(0.04 - 1.96 * 0.02)));
}

}  // namespace pprt::measured_error_test
