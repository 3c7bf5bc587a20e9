#include "study/rate/moving_scene.h"

#include <catch2/catch.hpp>

#include "spd/spd.h"

namespace pprt::moving_scene_test {
namespace {

CameraKey key(double frame, const Vec3d& from, bool cut) {
  CameraKey key;
  key.frame = frame, key.from = from, key.at = {0, 0, 1}, key.up = {0, 0, 1}, key.cut = cut;
  return key;
}

}  // namespace

TEST_CASE("moving scene: its frames at its own rate are the script's, whatever rounding says") {
  constexpr int kCut = 30;  // 29 / 25.0 * 25 is less than 29
  Animation script;
  script.frames = 40, script.fps = 25;
  script.keys = {key(1, {4, 0, 2}, false), key(kCut, {0, 5, 2}, true)};
  const MovingScene moving = moved_by_script("cut.anim", make_spd("tree", 1), script);
  const std::vector<FrameRequest> frames = frames_at(moving, moving.rate, script.frames, 16);
  REQUIRE(frames.size() == 40);
  for (const FrameRequest& frame : frames) {
    INFO(frame.number);
    CHECK(frame.cut == (frame.number == kCut));
    CHECK((frame.camera == frames.front().camera) == (frame.number < kCut));
  }
}

}  // namespace pprt::moving_scene_test
