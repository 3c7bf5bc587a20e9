// How often the interval of a measured error holds the true error, in frames of scripts and scenes. Takes
// minutes, so it is run by hand (docs/accuracy.md):
//
//   PPRT_COVERAGE="scenes/tree-casting.anim scenes/balls-orbit.anim" test_study "[coverage]"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "parallel/master/measured_error.h"
#include "parallel/rank/error_probes.h"
#include "parallel/session.h"
#include "study/frame_series.h"
#include "study/rate/moving_scene.h"
#include "study/reference.h"

namespace pprt::error_coverage_test {
namespace {

constexpr int kSize = 128, kFrames = 200, kRanks = 2, kRepeats = 400;

// A film of kFrames frames, however many it has.
struct Film {
  std::string name;
  MovingScene moving;
  std::vector<FrameRequest> frames;
};

Film film_of(const std::string& name) {
  MovingScene moving = read_moving_scene({name});
  std::vector<FrameRequest> frames = frames_at(moving, kFrames / moving.length_s, kFrames, kSize);
  return {name, std::move(moving), std::move(frames)};
}

// A frame as it was shown, its true mean squared error, and the samples of a rank.
struct Shown {
  PixelBlock pixels;
  double squared = 0;
  std::uint64_t samples = 0;
};

// At 60 frames/s of two ranks that trace some 30,000 samples of the tree. True pictures are kept for the next
// run.
std::vector<Shown> played(const Film& film) {
  SessionSettings settings{.sampler = SamplerChoice::kAuto};
  settings.width = settings.height = kSize;
  settings.clock = ClockKind::kWork;
  settings.frames_per_second = 60;
  settings.budget_units = 17'000'000;
  std::vector<Shown> all;
  render_series(film.moving.scene, film.frames, kRanks, settings, [&](FinishedFrame&& frame) {
    const FrameRequest& request = film.frames[all.size()];
    const Reference reference = cached_reference(film.name, {film.moving.scene, request.camera, request.time},
                                                 6, default_cache_directory());
    const double rmse = rmse_of(frame.image, reference.image);
    all.push_back({.pixels = {{0, 0, kSize, kSize}, std::move(frame.image.pixels)},
                   .squared = rmse * rmse - reference.own_rmse * reference.own_rmse,
                   .samples = frame.ranks[0].samples_new});
    if (all.size() % 20 == 0) std::cout << film.name << ": " << all.size() << " frames shown" << std::endl;
  });
  return all;
}

struct Coverage {
  double single = 0, running = 0;  // shares
  double first = 0;                // single, of the first frame of the film
  double half_width = 0;           // of the last frame's running interval, RMSE
};

bool holds(const RmseInterval& interval, double squared) {
  return interval.low <= std::sqrt(squared) && std::sqrt(squared) <= interval.high;
}

Coverage coverage_of(const Film& film, const std::vector<Shown>& shown) {
  const Partition partition = equal_areas(
      tile_grid(SessionSettings{.width = kSize, .height = kSize, .sampler = SamplerChoice::kAuto}, kRanks),
      kRanks);
  std::vector<Coverage> repeats(kRepeats);
  run_concurrently(kRepeats, [&](std::size_t repeat) {
    ShotErrors errors;
    double sum = 0;
    for (std::size_t f = 0; f < shown.size(); ++f) {
      Tracer tracer = tracer_of({film.moving.scene, film.frames[f].camera, film.frames[f].time});
      std::vector<RankReport> reports(kRanks);
      for (int rank = 0; rank < kRanks; ++rank) {
        const Region region = region_of(partition, rank);
        reports[static_cast<std::size_t>(rank)].error = measure_error(
            region, shown[f].pixels, plan_probes(shown[f].samples, shown[f].samples, region.pixel_count()),
            {repeat + 1, f, static_cast<std::uint64_t>(rank)},
            [&](double x, double y, double side) { return tracer.trace(x, y, {}, side).color; });
      }
      const FrameError error = errors.add(f == 0, reports, kSize * kSize).value();
      sum += shown[f].squared;
      const bool holds_own = holds(error.frame.interval(), shown[f].squared);
      repeats[repeat].single += holds_own;
      if (f == 0) repeats[repeat].first = holds_own;
      repeats[repeat].running += holds(error.shot, sum / static_cast<double>(f + 1));
      repeats[repeat].half_width = (error.shot.high - error.shot.low) / 2;
    }
  });
  Coverage mean;
  const double frames = kRepeats * static_cast<double>(shown.size());
  for (const Coverage& c : repeats)
    mean.single += c.single / frames, mean.running += c.running / frames, mean.first += c.first / kRepeats,
        mean.half_width += c.half_width / kRepeats;
  return mean;
}

}  // namespace

TEST_CASE("measured error: coverage of its intervals in films", "[.coverage]") {
  const char* given = std::getenv("PPRT_COVERAGE");
  std::istringstream names(given != nullptr ? given : PPRT_SOURCE_DIR "/scenes/tree-casting.anim");
  for (std::string name; names >> name;) {
    const Film film = film_of(name);
    const std::vector<Shown> shown = played(film);
    const Coverage coverage = coverage_of(film, shown);
    double squared = 0;
    for (const Shown& s : shown) squared += s.squared / static_cast<double>(shown.size());
    std::cout << name << ": " << shown.size() << " frames, RMSE " << std::sqrt(squared) << ", single "
              << coverage.single << " (the first frame " << coverage.first << "), so far " << coverage.running
              << ", half width at the end " << coverage.half_width << std::endl;
    CHECK(coverage.single >= 0.90);
    CHECK(coverage.running >= 0.93);
    CHECK(coverage.running <= 0.97);
  }
}

}  // namespace pprt::error_coverage_test
