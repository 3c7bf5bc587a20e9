// Whole sessions: tiles have one owner in every frame, and no sample is lost when they get another.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "parallel/exchange/samplers.h"
#include "unit/each_sampler.h"
#include "unit/parallel/virtual_run.h"

namespace pprt::handover_session_test {
namespace {

constexpr int kRanks = 5;

// No rate, for at a fixed one the master drops a partition that hands over more than fits into a frame: each
// frame takes so many seconds. No rank is late, and tiles change hands in every packet.
SessionSettings settings_for(SamplerChoice sampler, BalanceMode balance, ClockKind clock) {
  SessionSettings settings{.sampler = sampler};
  // Above a sample a pixel nothing changes hands any more: in real time ranks are fast.
  settings.width = clock == ClockKind::kWork ? 128 : 256, settings.height = settings.width * 3 / 4;
  settings.clock = clock;
  settings.stop.seconds = clock == ClockKind::kWork ? 0.02 : 0.025;
  settings.balance = balance;
  settings.report_samples = true;
  return settings;
}

using Point = std::pair<double, double>;

// Not by their names: while a tile is on its way two ranks may trace the same point, of which one is kept.
std::set<Point> points_of(const FinishedFrame& frame) {
  std::set<Point> points;
  for (const Sample& s : frame.samples) points.emplace(s.x, s.y);
  return points;
}

int cuts_in(const VirtualRun& run) {
  return static_cast<int>(std::count_if(run.frames.begin(), run.frames.end(),
                                        [](const FinishedFrame& f) { return f.global_balance; }));
}

std::uint64_t total(const FinishedFrame& frame, std::uint64_t RankReport::*figure) {
  std::uint64_t sum = 0;
  for (const RankReport& r : frame.ranks) sum += r.*figure;
  return sum;
}

std::uint64_t total(const VirtualRun& run, std::uint64_t RankReport::*figure) {
  std::uint64_t sum = 0;
  for (const FinishedFrame& frame : run.frames) sum += total(frame, figure);
  return sum;
}

int missing_from(const std::set<Point>& all, const std::set<Point>& some) {
  return static_cast<int>(
      std::count_if(some.begin(), some.end(), [&](const Point& p) { return all.count(p) == 0; }));
}

// Which ranks have sent a tile's pixels as its owner, by frame and tile; and which as its giver.
struct Claims {
  std::map<std::pair<int, int>, int> owners, givers;
};

Claims claims_of(const VirtualRun& run) {
  Claims claims;
  for (const SentPixels& sent : run.pixels) {
    for (const int tile : sent.tiles) ++claims.owners[{sent.frame_index, tile}];
    for (const int tile : sent.given) ++claims.givers[{sent.frame_index, tile}];
  }
  return claims;
}

// Of a tile that nobody has sent as its owner the giver must have sent pixels; returns how many such there
// were.
int check_one_owner(const VirtualRun& run) {
  const Claims claims = claims_of(run);
  int on_their_way = 0;
  for (const FinishedFrame& frame : run.frames) {
    for (int tile = 0; tile < static_cast<int>(frame.owners.size()); ++tile) {
      const std::pair<int, int> key(frame.order.index, tile);
      const auto owners = claims.owners.find(key);
      INFO("frame " << key.first << ", tile " << tile);
      CHECK((owners == claims.owners.end() ? 0 : owners->second) <= 1);
      if (owners != claims.owners.end()) continue;
      ++on_their_way;
      CHECK(claims.givers.count(key) == 1);
    }
  }
  return on_their_way;
}

// The disc, where all the work is, at the image's left: the equal parts that ranks begin with are far from
// even.
CameraSource still_with_disc_aside(const SessionSettings& settings, int frames) {
  return [=](int index) -> std::optional<FrameRequest> {
    if (index >= frames) return std::nullopt;
    return FrameRequest{index + 1, camera_before_disc(settings.width, settings.height, 0.4 * settings.width),
                        false};
  };
}

}  // namespace

EACH_SAMPLER_TEST_CASE(
    "handover: no repartition and no transfer loses a sample at rest, and every tile has one owner") {
  for (const BalanceMode balance : {BalanceMode::kLocal, BalanceMode::kGlobal, BalanceMode::kCombined}) {
    SessionSettings settings = settings_for(sampler, balance, ClockKind::kWork);
    const bool balances_without_rate = traits_of(sampler).balances_without_rate;
    if (!balances_without_rate && balance == BalanceMode::kLocal)
      settings.frames_per_second = 10, settings.budget_units = 3'000'000, settings.stop = {};
    const bool gives =
        balance == BalanceMode::kLocal || (balance == BalanceMode::kCombined && balances_without_rate);
    const VirtualRun run = run_session(kRanks, settings, still_with_disc_aside(settings, 8));
    REQUIRE(run.error.empty());
    REQUIRE(run.frames.size() == 8);
    for (std::size_t i = 1; i < run.frames.size(); ++i) {
      const FinishedFrame &before = run.frames[i - 1], &after = run.frames[i];
      INFO("balance " << static_cast<int>(balance) << ", frame " << i);
      CHECK(missing_from(points_of(after), points_of(before)) == 0);
      CHECK(after.samples.size() == before.samples.size() + total(after, &RankReport::samples_new));
    }
    CHECK(check_one_owner(run) == 0);
    if (balance != BalanceMode::kLocal) CHECK(cuts_in(run) > 0);
    CHECK((total(run, &RankReport::tiles_given) > 0) == gives);
  }
}

EACH_SAMPLER_TEST_CASE("handover: a repartition that does not keep samples loses them") {
  SessionSettings settings = settings_for(sampler, BalanceMode::kGlobal, ClockKind::kWork);
  settings.keep_samples = false;
  const VirtualRun run = run_session(kRanks, settings, still_with_disc_aside(settings, 5));
  REQUIRE(run.frames.size() == 5);
  CHECK(cuts_in(run) > 0);
  CHECK(missing_from(points_of(run.frames[4]), points_of(run.frames[0])) > 100);
}

EACH_SAMPLER_TEST_CASE("handover: in real time no sample is lost whatever the order in which messages arrive",
                       "[realtime]") {
  constexpr int kFrames = 6;
  const std::vector<Conditions> all_conditions = {{.slow_at_random = true, .arrive_at_random = true},
                                                  {.bundle_delay_s = 0.003}};
  int cuts = 0;
  for (const BalanceMode balance : {BalanceMode::kGlobal, BalanceMode::kCombined}) {
    for (const Conditions& conditions : all_conditions) {
      const SessionSettings settings = settings_for(sampler, balance, ClockKind::kWall);
      const VirtualRun run = run_session(kRanks, settings, still_or_pan(settings, kFrames), conditions);
      REQUIRE(run.error.empty());
      REQUIRE(run.frames.size() == kFrames);
      check_one_owner(run);
      // A sample that goes to another rank is on its way for a while, in which nobody reports it as its own.
      std::set<Point> last;
      for (int i = kFrames - 3; i < kFrames; ++i)
        last.merge(points_of(run.frames[static_cast<std::size_t>(i)]));
      for (int i = 0; i < kFrames - 3; ++i) {
        INFO("balance " << static_cast<int>(balance) << ", delay " << conditions.bundle_delay_s << ", slow "
                        << conditions.slow_at_random << ", frame " << i);
        CHECK(missing_from(last, points_of(run.frames[static_cast<std::size_t>(i)])) == 0);
      }
      cuts += cuts_in(run);
    }
  }
  CHECK(cuts > 0);
}

}  // namespace pprt::handover_session_test
