// Frames that end at an estimated FLIP, against the FLIP that they have.
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <vector>

#include "image/metrics.h"
#include "parallel/exchange/samplers.h"
#include "parallel/session.h"
#include "unit/parallel/rank/discs.h"

namespace pprt::flip_estimate_test {
namespace {

FinishedFrame still(int ranks, SamplerChoice sampler, const StopRules& stop) {
  const SessionSettings settings = settings_until(stop, sampler);
  VirtualRun run = run_session(ranks, settings, still_or_pan(settings, 1), discs());
  REQUIRE(run.error.empty());
  REQUIRE(run.frames.size() == 1);
  return std::move(run.frames[0]);
}

}  // namespace

TEST_CASE("estimated FLIP: a frame that ends at one has about that FLIP") {
  static const Image finished = still(1, SamplerChoice::kDelaunay, {.samples = 250'000}).image;
  const SamplerChoice sampler = GENERATE(from_range(kSamplerChoices));
  const int ranks = GENERATE(1, 4);
  INFO("sampler " << static_cast<int>(sampler) << ", " << ranks << " ranks");
  std::uint64_t fewer = 0;
  for (const double target : {0.08, 0.04, 0.02}) {
    const FinishedFrame frame = still(ranks, sampler, {.flip = target});
    const double found = mean_flip(frame.image, finished);
    INFO("target " << target << ", samples " << samples_of(frame));
    CHECK(found < 1.5 * target);
    // Refinement of triangles finds some discs late, and all of one at once.
    if (traits_of(sampler).store == SampleStore::kTriangulation) continue;
    CHECK(found > target / 4);
    CHECK(samples_of(frame) >= fewer);
    fewer = samples_of(frame);
  }
}

TEST_CASE("estimated FLIP: a resting picture is good enough at once") {
  SessionSettings settings = settings_until({.flip = 0.05}, SamplerChoice::kAuto);
  settings.cast = CastChoice::kAuto;
  const VirtualRun run = run_session(1, settings, still_or_pan(settings, 2), discs());
  REQUIRE(run.frames.size() == 2);
  CHECK(run.frames[1].ranks[0].samples_new == 0);
}

TEST_CASE("estimated FLIP: what was found in one view says nothing of the next") {
  const SessionSettings settings = settings_until({.flip = 0.0005}, SamplerChoice::kAuto);
  const auto frames_of = [&](const std::vector<double>& shifts) {
    const CameraSource source = [&](int index) -> std::optional<FrameRequest> {
      const auto i = static_cast<std::size_t>(index);
      if (i >= shifts.size()) return std::nullopt;
      return FrameRequest{index + 1, camera_before_disc(settings.width, settings.height, shifts[i]), false};
    };
    return run_session(1, settings, source).frames;
  };
  constexpr double kBesideTheDisc = 1000;
  const std::vector<FinishedFrame> both = frames_of({kBesideTheDisc, 0}), alone = frames_of({0});
  REQUIRE((both.size() == 2 && alone.size() == 1));
  REQUIRE(samples_of(both[0]) < samples_of(alone[0]) / 2);
  CHECK(static_cast<double>(samples_of(both[1])) > 0.9 * static_cast<double>(samples_of(alone[0])));
}

TEST_CASE("estimated FLIP: looking costs work, and the frame is the same each time") {
  const StopRules stop{.flip = 0.04};
  const FinishedFrame first = still(3, SamplerChoice::kAuto, stop),
                      again = still(3, SamplerChoice::kAuto, stop);
  CHECK(first.image.pixels == again.image.pixels);
  const FinishedFrame counted = still(3, SamplerChoice::kAuto, {.samples = samples_of(first)});
  CHECK(first.ranks[0].finished_s > 1.02 * counted.ranks[0].finished_s);
}

}  // namespace pprt::flip_estimate_test
