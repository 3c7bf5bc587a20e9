// The scripts that come with the project, and the manual page's examples.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <sstream>

#include "unit/parser/anim/script.h"

namespace pprt::anim_files_test {
namespace {

const std::string kSource = PPRT_SOURCE_DIR;

Animation script(const std::string& name) {
  const ParsedAnimation result = read_animation(kSource + "/scenes/" + name + ".anim");
  CHECK(result.warnings.empty());
  return result.animation;
}

// Checks that the cameras of all frames stay outside a ball around the scene and above its ground.
void check_stays_outside(const Animation& animation, const Vec3d& center, double radius, double ground) {
  for (double frame = 1; frame <= animation.frames; frame += 0.25) {
    const View view = view_at(animation, frame, View{});
    CAPTURE(frame);
    CHECK((view.from - center).length() > radius);
    CHECK(view.from.z > ground);
  }
}

// The SPD tree without its ground lies within 1.5 of <0, 0, 1.5>, and the sphereflake within 1.6 of its
// centre. The gears lie in [-2, 2] x [-2, 2] x [0, 1].
TEST_CASE("the scripts in scenes/ keep the eye above the ground and outside the objects") {
  for (const char* name : {"tree-simple", "tree-casting", "demo"}) {
    const Animation animation = script(name);
    CHECK(animation.scene == "spd:tree");
    check_stays_outside(animation, {0, 0, 1.5}, 1.5, 0.1);
  }
  check_stays_outside(script("balls-orbit"), {0, 0, 0}, 1.6, 0.5);
  check_stays_outside(script("gears-orbit"), {0, 0, 0}, 2.5, 1.5);
}

TEST_CASE("tree-simple has the paper's shape: still, moving, still, cut, still") {
  const Animation animation = script("tree-simple");
  CHECK(animation.frames == 40);
  CHECK(animation.fps == 4);
  for (int frame = 2; frame <= 40; ++frame) {
    CAPTURE(frame);
    const bool moved = view_at(animation, frame, View{}).from != view_at(animation, frame - 1, View{}).from;
    CHECK(moved == ((frame >= 11 && frame <= 20) || frame == 31));
    CHECK(cut_before(animation, frame) == (frame == 31));
  }
  CHECK((view_at(animation, 31, View{}).from - view_at(animation, 1, View{}).from).length() < 0.5);
}

TEST_CASE("tree-casting closes in a little with every frame") {
  const Animation animation = script("tree-casting");
  CHECK(animation.frames == 40);
  const auto seen = [&](int frame) {
    const View view = view_at(animation, frame, View{});
    return (view.at - view.from).length() * std::tan(view.angle_degrees * 0.00872664625997164788);
  };
  for (int frame = 2; frame <= 40; ++frame) {
    CHECK(seen(frame) < seen(frame - 1));
    CHECK(seen(frame) > 0.95 * seen(frame - 1));
  }
}

TEST_CASE("demo and balls-orbit can be played in a loop") {
  for (const char* name : {"demo", "balls-orbit"}) {
    const Animation animation = script(name);
    const Vec3d first = view_at(animation, 1, View{}).from;
    const Vec3d last = view_at(animation, animation.frames, View{}).from;
    CHECK((last - first).length() ==
          Approx((view_at(animation, 2, View{}).from - first).length()).epsilon(0.15));
  }
}

TEST_CASE("the manual page's examples are scripts") {
  std::ifstream page(kSource + "/man/pprt-anim.5");
  REQUIRE(page);
  int examples = 0;
  std::string line, text;
  bool inside = false;
  while (std::getline(page, line)) {
    if (line.starts_with(".Bd -literal")) {
      inside = true;
      text.clear();
    } else if (line == ".Ed" && inside) {
      inside = false;
      if (text.find("animation {") == std::string::npos) continue;
      ++examples;
      CHECK(script_report(text).empty());
    } else if (inside && line != ".") {
      text += line + '\n';
    }
  }
  CHECK(examples >= 2);
}

}  // namespace
}  // namespace pprt::anim_files_test
