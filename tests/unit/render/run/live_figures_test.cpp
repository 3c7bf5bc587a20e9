// What the live page tells of frames that are made up.
#include "render/run/live_figures.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace pprt::live_figures_test {
namespace {

SessionSettings settings_at(double rate) {
  SessionSettings settings{.sampler = SamplerChoice::kAuto};
  settings.width = 100, settings.height = 50;
  settings.frames_per_second = rate;
  return settings;
}

FinishedFrame frame_with(double late_ms, double rmse = 0.01, bool cut = false) {
  FinishedFrame frame;
  frame.late_ms = late_ms;
  frame.order.cut = cut;
  frame.ranks.resize(2);
  for (RankReport& rank : frame.ranks) rank.samples_in_region = 2000;
  FrameError error;
  error.own.squared = rmse * rmse;
  frame.error = error;
  return frame;
}

}  // namespace

TEST_CASE("live figures: a frame's own, and the error of the last frames since a cut") {
  LiveFigures figures(settings_at(24), 2, 2, Remedies::kPage);
  FrameFigures told = figures.add(frame_with(-3, 0.03));
  CHECK((told.slack_ms == 3 && told.samples == 4000 && told.advice.empty()));
  CHECK(told.rmse.value()[0] == Approx(0.03));
  told = figures.add(frame_with(-3, 0.04));
  CHECK(told.rmse.value()[0] == Approx(std::sqrt((0.0009 + 0.0016) / 2)));
  // A picture at rest grows finer: what it was is forgotten.
  for (int i = 0; i < 24; ++i) told = figures.add(frame_with(-3, 0.005));
  CHECK(told.rmse.value()[0] == Approx(0.005));
  told = figures.add(frame_with(-3, 0.02, true));
  CHECK(told.rmse.value()[0] == Approx(0.02));
  FinishedFrame unmeasured = frame_with(-3);
  unmeasured.order.cut = true, unmeasured.error.reset();
  CHECK_FALSE(figures.add(unmeasured).rmse);
}

TEST_CASE("live figures: the error of few probes is not told, that of some frames is") {
  LiveFigures figures(settings_at(24), 2, 2, Remedies::kPage);
  FinishedFrame frame = frame_with(-3, 0.03);
  frame.error->own.probes = 12;
  CHECK_FALSE(figures.add(frame).rmse);
  CHECK_FALSE(figures.add(frame).rmse);
  CHECK(figures.add(frame).rmse.value()[0] == Approx(0.03));
}

TEST_CASE("live figures: advice comes with late or coarse frames, and goes with them") {
  LiveFigures figures(settings_at(50), 2, 2, Remedies::kPage);
  for (int i = 0; i < 23; ++i) CHECK(figures.add(frame_with(5)).advice.empty());
  CHECK(figures.add(frame_with(5)).advice ==
        "24 of 24 frames were late; 95 % of them would not have been at a Rate of 40 frames/s; all cores "
        "were used; more "
        "hosts (--hostfile) help");
  for (int i = 0; i < 119; ++i) figures.add(frame_with(-1));
  CHECK(figures.add(frame_with(-1)).advice.empty());
  for (int i = 0; i < 24; ++i) figures.add(frame_with(-1, 0.05));
  CHECK(figures.add(frame_with(-1, 0.05)).advice ==
        "0.8 samples a pixel are few; a Rate of 25 frames/s or a Size of half as many pixels gives twice as "
        "many; all cores were used; more "
        "hosts (--hostfile) help");
}

}  // namespace pprt::live_figures_test
