// Ranks that are threads of one process, and what the master learns of every sample.
#include "parallel/virtual_ranks.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>
#include <stdexcept>

#include "unit/each_sampler.h"
#include "unit/parallel/virtual_run.h"

namespace pprt::virtual_ranks_test {
namespace {

SessionSettings settings(SamplerChoice sampler) {
  SessionSettings s{.sampler = sampler};
  s.width = 96, s.height = 64;
  s.clock = ClockKind::kWork;
  s.frames_per_second = 4;
  s.budget_units = 1'000'000;
  s.report_samples = true;
  return s;
}

Probe grey_probe() {
  return {[](const Camera&) {},
          [](double x, double y) {
            RaySample sample;
            sample.color = Color(static_cast<float>(x > y), 0.5f, 0.5f);
            return sample;
          },
          [](const Vec3f&, bool) { return true; }, [] { return RayCounts(); }};
}

}  // namespace

EACH_SAMPLER_TEST_CASE("virtual ranks: a frame reports every sample once, and the owner of each tile") {
  const SessionSettings s = settings(sampler);
  std::vector<FinishedFrame> frames;
  run_virtual_ranks(
      5, s, [](int) { return grey_probe(); }, still_or_pan(s, 3),
      [&](FinishedFrame&& frame) { frames.push_back(std::move(frame)); });
  REQUIRE(frames.size() == 3);
  for (const FinishedFrame& frame : frames) {
    std::uint64_t counted = 0;
    for (const RankReport& r : frame.ranks) counted += r.samples_in_region;
    CHECK(frame.samples.size() == counted);
    std::set<std::pair<double, double>> points;
    for (const Sample& sample : frame.samples) points.emplace(sample.x, sample.y);
    CHECK(points.size() == frame.samples.size());
    for (int rank = 0; rank < 5; ++rank) {
      CHECK(std::count(frame.owners.begin(), frame.owners.end(), rank) > 0);
    }
    CHECK(std::count(frame.owners.begin(), frame.owners.end(), -1) == 0);
  }
}

EACH_SAMPLER_TEST_CASE("virtual ranks: samples stay with their ranks unless the settings ask for them") {
  SessionSettings s = settings(sampler);
  s.report_samples = false;
  bool empty = false;
  run_virtual_ranks(
      2, s, [](int) { return grey_probe(); }, still_or_pan(s, 1),
      [&](FinishedFrame&& frame) { empty = frame.samples.empty(); });
  CHECK(empty);
}

EACH_SAMPLER_TEST_CASE("virtual ranks: a rank that fails ends the run of all") {
  const SessionSettings s = settings(sampler);
  const auto failing = [](int rank) {
    Probe probe = grey_probe();
    if (rank == 2) probe.trace = [](double, double) -> RaySample { throw std::runtime_error("no such ray"); };
    return probe;
  };
  CHECK_THROWS_WITH(run_virtual_ranks(4, s, failing, still_or_pan(s, 5), [](FinishedFrame&&) {}),
                    "no such ray");
}

}  // namespace pprt::virtual_ranks_test
