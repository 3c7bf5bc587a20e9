// Samples that cross a border when they are cast.
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "parallel/balance/partition.h"
#include "parallel/exchange/samplers.h"
#include "parallel/settings/work_units.h"
#include "unit/each_sampler.h"
#include "unit/parallel/virtual_run.h"

namespace pprt::casting_session_test {
namespace {

constexpr int kRanks = 4;

SessionSettings casting_settings(SamplerChoice sampler, CastChoice cast) {
  SessionSettings settings{.sampler = sampler};
  settings.width = 128, settings.height = 96;
  settings.clock = ClockKind::kWork;
  settings.frames_per_second = 4;
  settings.budget_units = 2'000'000;
  settings.cast = cast;
  return settings;
}

// As the session cuts the image: by area.
Partition partition_of(const SessionSettings& settings) {
  const TileGrid grid = tile_grid_for(settings.width, settings.height, kRanks);
  std::vector<double> areas;
  for (int tile = 0; tile < grid.tile_count(); ++tile) {
    areas.push_back(static_cast<double>(grid.pixels(tile).area()));
  }
  return bisect(grid, areas, kRanks);
}

std::uint64_t total(const FinishedFrame& frame, std::uint64_t RankReport::*figure) {
  std::uint64_t sum = 0;
  for (const RankReport& r : frame.ranks) sum += r.*figure;
  return sum;
}

double distance_to_region(const Region& region, const Sample& s) {
  double nearest = 1e9;
  for (const int tile : region.tiles()) {
    const PixelRect r = region.grid().pixels(tile);
    nearest = std::min(nearest, std::max({r.x0 - s.x, s.x - r.x1, r.y0 - s.y, s.y - r.y1, 0.0}));
  }
  return nearest;
}

// Whether what is cast becomes samples of the next picture.
bool casts_samples(SamplerChoice sampler) {
  return traits_of(sampler).cast_use == CastUse::kSamples;
}

}  // namespace

EACH_SAMPLER_TEST_CASE("casting: cast samples serve the next frame, the same each time") {
  for (const CastChoice cast : {CastChoice::kPaper, CastChoice::kVerified}) {
    const SessionSettings settings = casting_settings(sampler, cast);
    const VirtualRun run = run_session(kRanks, settings, still_or_pan(settings, 4, 3));
    const VirtualRun again =
        run_session(kRanks, settings, still_or_pan(settings, 4, 3), {.slow_at_random = true});
    CHECK(run.error.empty());
    CHECK(same_pictures(run, again));
    REQUIRE(run.frames.size() == 4);
    CHECK(total(run.frames[0], &RankReport::samples_cast) == 0);
    // Those that are verified are dropped when they are older than two frames: up to here none is.
    // Lights always are, and they serve samples on the disc alone.
    const bool are_samples = casts_samples(sampler);
    const std::size_t end = !are_samples || cast == CastChoice::kVerified ? 3 : 4;
    for (std::size_t i = 1; i < end; ++i) {
      const std::uint64_t cast_in = total(run.frames[i], &RankReport::samples_cast);
      const std::uint64_t before = total(run.frames[i - 1], &RankReport::samples_in_region);
      INFO("frame " << i << ": " << cast_in << " of " << before);
      // Of 128 columns three leave the picture, and a plane hides nothing; but putting samples back takes at
      // most half of each rank's frame.
      const std::uint64_t room = kRanks * (settings.budget_units / 2 / price(Work::kKeptSample));
      CHECK(cast_in > (are_samples ? std::min(before, room) * 85 / 100 : before / 10));
      CHECK(cast_in <= before);
    }
  }
}

EACH_SAMPLER_TEST_CASE(
    "casting: auto carries samples where they pay, the same each time, and learns from the frames before") {
  const SessionSettings settings = casting_settings(sampler, CastChoice::kAuto);
  const VirtualRun run = run_session(kRanks, settings, still_or_pan(settings, 4, 3), {.more_rays = 4});
  const VirtualRun again =
      run_session(kRanks, settings, still_or_pan(settings, 4, 3), {.slow_at_random = true, .more_rays = 4});
  CHECK(run.error.empty());
  CHECK(same_pictures(run, again));
  REQUIRE(run.frames.size() == 4);
  // Where lights are cast the choice goes by the shadow rays of samples, and there is nothing to learn.
  CHECK((run.frames[3].order.evidence.fresh > 0) == casts_samples(sampler));
  for (std::size_t i = 1; i < 4; ++i) {
    CHECK(run.frames[i].order.carry == Carry::kCastWherePaying);
    CHECK(total(run.frames[i], &RankReport::samples_cast) > 0);
  }
}

EACH_SAMPLER_TEST_CASE("casting: where it does not pay it costs a few samples, not all") {
  // Rays are cheap: one carried sample costs 935 units, and a fresh one 815.
  const auto casting_ms = [&](CastChoice cast) {
    double sum = 0;
    const SessionSettings settings = casting_settings(sampler, cast);
    const VirtualRun run = run_session(kRanks, settings, still_or_pan(settings, 6, 3));
    CHECK(run.error.empty());
    for (const RankReport& r : run.frames.at(5).ranks) sum += r.cpu_ms.casting;
    return sum;
  };
  const double by_choice = casting_ms(CastChoice::kAuto), of_all = casting_ms(CastChoice::kVerified);
  CHECK((by_choice > 0) == casts_samples(sampler));  // the trial; lights need none
  CHECK(by_choice < 0.05 * of_all);
}

// On a lattice nothing is measured.
TEST_CASE("casting: ranks measure what samples cost in real time, and on no other clock (delaunay)",
          "[realtime]") {
  for (const ClockKind clock : {ClockKind::kWall, ClockKind::kWork}) {
    SessionSettings settings = casting_settings(SamplerChoice::kDelaunay, CastChoice::kAuto);
    settings.clock = clock;
    const VirtualRun run = run_session(kRanks, settings, still_or_pan(settings, 5, 3));
    CHECK(run.error.empty());
    CastEvidence all;
    for (const FinishedFrame& frame : run.frames) {
      for (const RankReport& r : frame.ranks) all += r.evidence;
    }
    CHECK(all.asked_ms > 0);
    CHECK(all.reinserted > 0);
    CHECK(all.reinserted_ms > 0);
    CHECK((all.fresh_ms > 0) == (clock == ClockKind::kWall));
  }
}

EACH_SAMPLER_TEST_CASE(
    "casting: where the eye rests and the view turns no ray checks samples, and they live for four frames or "
    "two") {
  const SessionSettings settings = casting_settings(sampler, CastChoice::kAuto);
  const CameraSource turning = [&](int index) -> std::optional<FrameRequest> {
    if (index >= 7) return std::nullopt;
    Camera camera = camera_before_disc(settings.width, settings.height);
    camera.slope_per_pixel *= 1 - 0.001 * index;
    return FrameRequest{index + 1, camera, false};
  };
  SessionSettings traced = settings;
  traced.report_samples = true;
  const VirtualRun run = run_session(kRanks, traced, turning, {.more_rays = 9});
  CHECK(run.error.empty());
  REQUIRE(run.frames.size() == 7);
  for (const FinishedFrame& frame : run.frames) {
    for (const RankReport& r : frame.ranks) CHECK(r.evidence.asked == 0);
  }
  int oldest = 7;
  for (const Sample& s : run.frames[6].samples) oldest = std::min(oldest, s.frame);
  CHECK(oldest == (casts_samples(sampler) ? 3 : 5));  // what lights are seen is asked sooner
}

EACH_SAMPLER_TEST_CASE("casting: frames that carry many samples are on time") {
  for (const CastChoice cast : {CastChoice::kPaper, CastChoice::kVerified, CastChoice::kAuto}) {
    const SessionSettings settings = casting_settings(sampler, cast);
    for (const FinishedFrame& frame : run_session(kRanks, settings, still_or_pan(settings, 8, 1)).frames) {
      INFO("frame " << frame.order.number << ": " << total(frame, &RankReport::samples_cast) << " cast");
      CHECK(frame.late_ms <= 0);
    }
  }
}

EACH_SAMPLER_TEST_CASE("casting: a cast sample that crosses a border is announced to the rank it came from") {
  // Its triangles reach over the border it has crossed: the former owner needs it as much as any. So near to
  // the border no other sample comes between.
  const double reach = casts_samples(sampler) ? 0.25 : 1;  // pixels
  SessionSettings settings = casting_settings(sampler, CastChoice::kPaper);
  if (!casts_samples(sampler)) settings.budget_units *= 4;  // so that enough samples lie there
  const Partition partition = partition_of(settings);
  const VirtualRun run = run_session(kRanks, settings, still_or_pan(settings, 2, 3));
  REQUIRE(run.frames.size() == 2);
  std::set<std::pair<int, SampleId>> sent;  // receiver, sample: after the first exchange of frame 1
  for (const SentBundle& b : run.bundles) {
    if (b.bundle.frame_index != 1 || b.bundle.round == 0) continue;
    for (const Sample& s : b.bundle.samples) sent.emplace(b.to, s.id);
  }
  int crossed = 0, back = 0;
  for (const SentBundle& b : run.bundles) {
    if (b.bundle.frame_index != 1 || b.bundle.round != 0) continue;
    for (const Sample& s : b.bundle.samples) {
      const bool guest = s.frame == 1 && region_of(partition, b.to).owns_point(s.x, s.y);
      if (!guest || distance_to_region(region_of(partition, b.from), s) > reach) continue;
      ++crossed;
      back += sent.count({b.from, s.id}) != 0;
    }
  }
  INFO(back << " of " << crossed);
  CHECK(crossed > 10);
  if (casts_samples(sampler)) {
    CHECK(back >= crossed * 9 / 10);
  } else {
    CHECK(back == 0);  // it is no sample of the picture
  }
}

}  // namespace pprt::casting_session_test
