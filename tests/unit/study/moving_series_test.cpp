// Series of frames in which objects move: what is carried must never show where they were.
#include <catch2/catch.hpp>

#include "parallel/exchange/samplers.h"
#include "parser/aff_parser.h"
#include "scene/animation/resting_nodes.h"
#include "study/frame_series.h"
#include "study/rate/moving_scene.h"
#include "study/reference.h"
#include "unit/each_sampler.h"

namespace pprt::moving_series_test {
namespace {

constexpr int kSize = 64;
constexpr int kFrames = 6;

// A camera at rest over a floor; a ball crosses it under two lights, and a box turns.
constexpr const char* kScene = R"(
v from 0 4 7 at 0 0 0 up 0 1 0 angle 40 hither 1 resolution 64 64
am 1 1 1 b .1 .2 .4 l 4 6 3 .5 .5 .5 l -5 5 2 .4 .4 .4 a 1 2 6
fm .1 .1 .1 .6 .6 .5 0 0 0 0 0 1
p 4 -4 0 4  4 0 4  4 0 -4  -4 0 -4
x ball { fm .1 0 0 .8 .2 .1 .2 .2 .2 20 0 1 s 0 .8 0 .8 }
x box { fm 0 .1 0 .2 .7 .3 0 0 0 0 0 1
p 4 -.5 1 .5 .5 1 .5 .5 1 -.5 -.5 1 -.5  p 4 -.5 0 .5 .5 0 .5 .5 1 .5 -.5 1 .5
p 4 .5 0 -.5 -.5 0 -.5 -.5 1 -.5 .5 1 -.5  p 4 .5 0 .5 .5 0 -.5 .5 1 -.5 .5 1 .5
p 4 -.5 0 -.5 -.5 0 .5 -.5 1 .5 -.5 1 -.5 }
k ball { transl 4 0 -3 0 0 0 0 0 1 -2 0 0 0 0 0 2 2 0 .5 0 0 0 3 3 0 0 0 0 0 }
k box { rot 4 0 0 1 0 0 0 0 0 1 0 1 0 0 0 0 0 2 0 1 0 90 0 0 0 3 0 1 0 90 0 0 0
        transl 4 0 1.5 0 -1.5 0 0 0 1 1.5 0 -1.5 0 0 0 2 1.5 0 -1.5 0 0 0 3 1.5 0 -1.5 0 0 0 }
)";

SessionSettings settings_for(SamplerChoice sampler, CastChoice cast) {
  SessionSettings settings{.sampler = sampler};
  settings.width = settings.height = kSize;
  settings.clock = ClockKind::kWork;
  settings.frames_per_second = 10;
  settings.budget_units = 12'000'000;
  settings.cast = cast;
  return settings;
}

struct Series {
  std::vector<Image> pictures;
  std::vector<Carry> carried;
};

Series render(const CompiledScene& scene, const std::vector<FrameRequest>& frames, int ranks,
              const SessionSettings& settings) {
  Series series;
  render_series(scene, frames, ranks, settings, [&](FinishedFrame&& frame) {
    series.pictures.push_back(frame.image);
    series.carried.push_back(frame.order.carry);
  });
  return series;
}

}  // namespace

TEST_CASE("moving series: what is carried shows nothing of where things were") {
  const SceneDescription description = without_resting_nodes(parse_aff(kScene, "m.aff").scene);
  const MovingScene moving = moved_by_itself("m.aff", description);
  const CompiledScene& scene = moving.scene;
  const std::vector<FrameRequest> frames = frames_at(moving, moving.rate, kFrames, kSize);
  std::vector<Image> references;
  for (const FrameRequest& frame : frames)
    references.push_back(converged_reference({scene, frame.camera, frame.time}, 6).image);

  for (const SamplerChoice sampler : kEachSampler) {
    for (const int ranks : {1, 3}) {
      const Series off = render(scene, frames, ranks, settings_for(sampler, CastChoice::kOff));
      for (const CastChoice cast : {CastChoice::kAuto, CastChoice::kVerified}) {
        const Series on = render(scene, frames, ranks, settings_for(sampler, cast));
        REQUIRE(on.pictures.size() == kFrames);
        for (std::size_t i = 1; i < kFrames; ++i) {
          INFO(static_cast<int>(sampler) << " " << ranks << " " << static_cast<int>(cast) << " frame " << i);
          CHECK(on.carried[i] != Carry::kAccumulate);
          const double error = rmse_of(on.pictures[i], references[i]);
          // With --cast verified samples carry colours that depend on the eye for two frames.
          const bool may_be_stale =
              traits_of(sampler).cast_use == CastUse::kSamples && cast == CastChoice::kVerified;
          // Errors of a fortieth of a display step are of chance alone.
          constexpr double kChance = 1e-4;
          CHECK((may_be_stale || error < 1.1 * rmse_of(off.pictures[i], references[i]) + kChance));
          // Control: the frame before is another picture.
          CHECK(error < 0.6 * rmse_of(on.pictures[i], references[i - 1]));
        }
      }
    }
  }
}

TEST_CASE("moving series: samples accumulate while nothing moves") {
  const SceneDescription description = without_resting_nodes(parse_aff(kScene, "m.aff").scene);
  const CompiledScene scene = compile(description);
  CHECK(scene.moves_between(1.5, 1.6));
  CHECK_FALSE(scene.moves_between(1.5, 1.5));
  CHECK_FALSE(scene.moves_between(2, 2.5));  // all tracks have ended
  std::vector<FrameRequest> frames;
  for (const double time : {1.5, 1.5, 1.7, 2.0, 2.5}) {
    frames.push_back({.number = static_cast<int>(frames.size()) + 1,
                      .camera = square_camera(scene, *description.view, kSize),
                      .time = time,
                      .moves = frames.empty() || scene.moves_between(frames.back().time, time)});
  }
  SessionSettings settings = settings_for(SamplerChoice::kAuto, CastChoice::kAuto);
  settings.budget_units /= 6;
  const Series series = render(scene, frames, 2, settings);
  REQUIRE(series.carried.size() == 5);
  CHECK(series.carried[1] == Carry::kAccumulate);
  CHECK(series.carried[2] == Carry::kCastWherePaying);
  CHECK(series.carried[4] == Carry::kAccumulate);
  const Image reference = converged_reference({scene, frames[4].camera, 2.5}, 6).image;
  CHECK(rmse_of(series.pictures[4], reference) < 0.9 * rmse_of(series.pictures[3], reference));
}

}  // namespace pprt::moving_series_test
