// Edges of primitives in a session: every frame sees them from its own camera.
#include <catch2/catch.hpp>
#include <cmath>

#include "unit/parallel/virtual_run.h"

namespace pprt::silhouettes_session_test {
namespace {

constexpr int kFrames = 3;
constexpr double kShift = 2.5;  // pixels a frame

SessionSettings settings_of(PixelRule rule) {
  SessionSettings settings{.sampler = SamplerChoice::kDelaunay};
  settings.width = 128, settings.height = 96;
  settings.clock = ClockKind::kWork;
  settings.frames_per_second = 4;
  settings.budget_units = 1'000'000;
  settings.pixel_rule = rule;
  settings.learned_weights = false;  // so that samples do not depend on the rule
  return settings;
}

// The disc as camera_before_disc() sees it from so many pixels to the right, one where it is and zero beside,
// as the mean over pixel (x, y).
double truth(int x, int y, double shift) {
  constexpr int kSide = 16;
  int inside = 0;
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const double px = x + (i + 0.5) / kSide - 64 + shift, py = y + (j + 0.5) / kSide - 48;
      inside += std::hypot(px, py) < 0.3 * 96;
    }
  }
  return inside / static_cast<double>(kSide * kSide);
}

// Root mean square over the red of frame `index`, whose colours are 0.9 and 0.1.
double error_of(const VirtualRun& run, int index) {
  const Image& image = run.frames[static_cast<std::size_t>(index)].image;
  double sum = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double d = image.at(x, y).x - (0.1 + 0.8 * truth(x, y, index * kShift));
      sum += d * d;
    }
  }
  return std::sqrt(sum / (image.width * image.height));
}

}  // namespace

TEST_CASE("silhouettes: moving frames of several ranks show edges where their own camera sees them") {
  for (const int ranks : {1, 3}) {
    const SessionSettings area = settings_of(PixelRule::kArea), edges = settings_of(PixelRule::kEdges);
    const auto run = [&](const SessionSettings& settings) {
      return run_session(ranks, settings, still_or_pan(settings, kFrames, kShift), {.tells_shapes = true});
    };
    const VirtualRun by_area = run(area), with_edges = run(edges);
    REQUIRE(by_area.error.empty());
    REQUIRE(with_edges.error.empty());
    REQUIRE(with_edges.frames.size() == kFrames);
    for (int frame = 0; frame < kFrames; ++frame) {
      INFO(ranks << " ranks, frame " << frame);
      CHECK(error_of(with_edges, frame) < 0.5 * error_of(by_area, frame));
    }
  }
}

}  // namespace pprt::silhouettes_session_test
