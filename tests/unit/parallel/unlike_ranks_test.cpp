// Ranks of unlike speed: each is given as much of the image as it has time for.
#include <algorithm>
#include <catch2/catch.hpp>

#include "parallel/exchange/samplers.h"
#include "unit/each_sampler.h"
#include "unit/parallel/virtual_run.h"

namespace pprt::unlike_ranks_test {
namespace {

constexpr int kRanks = 8, kSlow = 4, kFrames = 16;

SessionSettings unlike_ranks(SamplerChoice sampler, BalanceMode balance) {
  SessionSettings settings{.sampler = sampler};
  settings.width = 256, settings.height = 192;
  settings.clock = ClockKind::kWork;
  settings.frames_per_second = 4;
  settings.budget_units = 1'500'000;
  settings.balance = balance;
  settings.machine.slow_ranks = kSlow;
  settings.machine.slowness = 2;
  return settings;
}

VirtualRun pan(const SessionSettings& settings) {
  return run_session(kRanks, settings, still_or_pan(settings, kFrames, 1.5), {.period = 20});
}

// Median over the second half of the sequence.
double settled_unevenness(const VirtualRun& run) {
  std::vector<double> values;
  for (std::size_t i = kFrames / 2; i < run.frames.size(); ++i) values.push_back(unevenness(run.frames[i]));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

// Tiles of the slow ranks by all tiles, in the last frame.
double share_of_slow(const VirtualRun& run) {
  const std::vector<std::int32_t>& owners = run.frames.back().owners;
  const auto slow =
      std::count_if(owners.begin(), owners.end(), [](std::int32_t rank) { return rank < kSlow; });
  return static_cast<double>(slow) / static_cast<double>(owners.size());
}

}  // namespace

EACH_SAMPLER_TEST_CASE(
    "unlike ranks: four of eight at half speed are as far as the others, by global and combined balancing") {
  const VirtualRun none = pan(unlike_ranks(sampler, BalanceMode::kNone));
  REQUIRE(none.error.empty());
  // The roots of weights deviate about half as much.
  const bool are_roots = traits_of(sampler).weights_are_roots;
  CHECK(settled_unevenness(none) > (are_roots ? 0.19 : 0.3));  // what is to be evened out
  for (const BalanceMode balance : {BalanceMode::kGlobal, BalanceMode::kCombined}) {
    const VirtualRun run = pan(unlike_ranks(sampler, balance));
    REQUIRE(run.error.empty());
    INFO("balance " << static_cast<int>(balance) << ": deviation " << settled_unevenness(run)
                    << ", slow ranks own " << share_of_slow(run));
    CHECK(settled_unevenness(run) <= (are_roots ? 0.15 : 0.25));
    CHECK((share_of_slow(run) > 0.2 && share_of_slow(run) < 0.42));
  }
}

EACH_SAMPLER_TEST_CASE("unlike ranks: a rank's report tells its pace") {
  const VirtualRun run = pan(unlike_ranks(sampler, BalanceMode::kCombined));
  REQUIRE(run.error.empty());
  for (int rank = 0; rank < kRanks; ++rank) {
    CHECK(run.frames.back().ranks[static_cast<std::size_t>(rank)].pace == (rank < kSlow ? 2 : 1));
  }
}

}  // namespace pprt::unlike_ranks_test
