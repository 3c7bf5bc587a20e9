// Frames that end at a measured RMSE, against the RMSE that they have.
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <vector>

#include "parallel/exchange/samplers.h"
#include "parallel/session.h"
#include "pipeline/core/display_values.h"
#include "unit/parallel/rank/discs.h"

namespace pprt::rmse_goal_test {
namespace {

SessionSettings settings_for(SamplerChoice sampler, const StopRules& stop) {
  SessionSettings settings = settings_until(stop, sampler);
  settings.measures_error = true;
  return settings;
}

// The same discs, by 16 x 16 points a pixel.
double true_rmse(const Image& image, double shift) {
  constexpr int kSide = 16;
  const Camera camera = camera_before_disc(image.width, image.height, shift);
  const Color disc(0.9f, 0.7f, 0.2f), plane(0.1f, 0.1f, 0.3f);
  double sum = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      int inside = 0;
      for (int i = 0; i < kSide * kSide; ++i) {
        const double u = x + (i % kSide + 0.5) / kSide, v = y + (i / kSide + 0.5) / kSide;
        const Vec3d hit = camera.eye + ray_direction(camera, u, v) * 10;
        inside += std::hypot(std::remainder(hit.x, kDiscPeriod), std::remainder(hit.y, kDiscPeriod)) <
                  0.3 * kDiscPeriod;
      }
      const float share = static_cast<float>(inside) / (kSide * kSide);
      sum += display_error(image.at(x, y), disc * share + plane * (1 - share));
    }
  }
  return std::sqrt(sum / (static_cast<double>(image.width) * image.height));
}

VirtualRun run_of(int ranks, const SessionSettings& settings, int frames, double shift = 0) {
  VirtualRun run = run_session(ranks, settings, still_or_pan(settings, frames, shift), discs());
  REQUIRE(run.error.empty());
  REQUIRE(run.frames.size() == static_cast<std::size_t>(frames));
  return run;
}

}  // namespace

TEST_CASE("measured RMSE: a frame that ends at one has it, and its interval holds it") {
  const SamplerChoice sampler = GENERATE(from_range(kSamplerChoices));
  const int ranks = GENERATE(1, 3);
  for (const double target : {0.04, 0.02}) {
    const VirtualRun run = run_of(ranks, settings_for(sampler, {.rmse = target}), 1);
    const FinishedFrame& frame = run.frames[0];
    const double found = true_rmse(frame.image, 0);
    const RmseInterval told = frame.error.value().frame.interval();
    INFO("sampler " << static_cast<int>(sampler) << ", " << ranks << " ranks, target " << target << ", found "
                    << found << ", told " << told.low << " to " << told.high << ", samples "
                    << samples_of(frame));
    CHECK(found < 1.15 * target);
    // A grid doubles its samples in steps, and triangulations find whole discs at once.
    const SamplerTraits traits = traits_of(sampler);
    if (traits.store == SampleStore::kLattice && traits.still_weight > 0) CHECK(found > 0.85 * target);
    CHECK((0.95 * told.low <= found && found <= 1.05 * told.high));
  }
}

TEST_CASE("measured RMSE: the rays that measure are told apart, and the run is the same each time") {
  const SessionSettings settings = settings_for(SamplerChoice::kAuto, {.rmse = 0.03});
  const VirtualRun first = run_of(3, settings, 1), again = run_of(3, settings, 1);
  CHECK(same_pictures(first, again));
  CHECK(first.frames[0].error->own.squared == again.frames[0].error->own.squared);
  std::uint64_t traced = 0, samples = 0;
  for (const RankReport& r : first.frames[0].ranks) traced += r.rays.primary, samples += r.samples_new;
  CHECK(traced <= samples + samples / 10);
}

TEST_CASE("measured RMSE: a resting picture is good enough at once, another view is measured anew") {
  SessionSettings settings = settings_for(SamplerChoice::kAuto, {.rmse = 0.04});
  settings.cast = CastChoice::kAuto;
  const VirtualRun resting = run_of(1, settings, 2);
  CHECK(resting.frames[1].ranks[0].samples_new == 0);
  const VirtualRun moving = run_of(2, settings, 3, 7.5);
  for (int f = 0; f < 3; ++f)
    CHECK(true_rmse(moving.frames[static_cast<std::size_t>(f)].image, 7.5 * f) < 0.046);
}

TEST_CASE("measured RMSE: one that cannot be reached ends when nothing is left to sample") {
  SessionSettings settings = settings_for(SamplerChoice::kGrid, {.rmse = 1e-6});
  settings.width = 48, settings.height = 32;
  const VirtualRun run = run_of(2, settings, 1);
  CHECK(samples_of(run.frames[0]) > 8 * 48 * 32);
}

}  // namespace pprt::rmse_goal_test
