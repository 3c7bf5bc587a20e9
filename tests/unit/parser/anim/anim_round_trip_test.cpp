// Scripts that are written read back as what they were.
#include <catch2/catch.hpp>
#include <string>

#include "parser/anim/anim_parser.h"
#include "scene/writers/anim_writer.h"

namespace pprt::anim_round_trip_test {

namespace {

void check_equal(const CameraKey& a, const CameraKey& b) {
  CHECK(a.frame == b.frame);
  CHECK(a.from == b.from);
  CHECK(a.at == b.at);
  CHECK(a.up == b.up);
  CHECK(a.angle_degrees == b.angle_degrees);
  CHECK(a.of_scene.from == b.of_scene.from);
  CHECK(a.of_scene.angle == b.of_scene.angle);
  CHECK(a.tension == b.tension);
  CHECK(a.continuity == b.continuity);
  CHECK(a.bias == b.bias);
  CHECK(a.ease_in == b.ease_in);
  CHECK(a.ease_out == b.ease_out);
  CHECK(a.cut == b.cut);
  CHECK(a.hold == b.hold);
}

Animation round_trip(const Animation& animation) {
  const std::string text = anim_script(animation);
  INFO(text);
  return parse_animation(text, "again.anim").animation;
}

}  // namespace

TEST_CASE("anim writer: a script with every statement reads back the same") {
  const Animation animation = parse_animation(R"(
animation {
  scene "spd:tree:5" frames 90 fps 23.976 resolution <320, 200>
  sun { from <1, 2/3, -3> } sky { up <0, 0, 1> horizon <.9, .8, .7> zenith <.1, .2, .5> }
  sun { color <.3, .2, .1> from <0, 1, 0> }
  camera {
    spline catmull_rom
    key 1 { at <0, 0, 1/3> up <0, 0, 1> }
    hold 10.5
    key 20 { from <-4.6*cos(30), 4.6*sin(30), -2e-7> angle 30.1 tension 0.5 ease_in 0.25 }
    key 30 { from <1, 2, 3> tension 0 bias -1 }
    cut 31 { from <4.6, 0.4, 2> up <0, 1e-9, 1> angle 45 continuity 0.1 ease_out 1 }
    key 50 { from <9, 9, 9> }
  }
})",
                                              "all.anim")
                                  .animation;
  const Animation again = round_trip(animation);
  CHECK(again.scene == animation.scene);
  CHECK(again.frames == 90);
  CHECK(again.fps == animation.fps);
  CHECK(again.width == 320);
  CHECK(again.height == 200);
  CHECK(again.spline == SplineKind::kCatmullRom);
  REQUIRE(again.daylight.suns.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(again.daylight.suns[i].position == animation.daylight.suns[i].position);
    CHECK(again.daylight.suns[i].color == animation.daylight.suns[i].color);
  }
  CHECK(again.daylight.suns[0].position.y == 2.0 / 3);
  CHECK(again.daylight.sky == Sky{.up = {0, 0, 1}, .horizon = {.9, .8, .7}, .zenith = {.1, .2, .5}});
  REQUIRE(again.keys.size() == animation.keys.size());
  for (std::size_t i = 0; i < again.keys.size(); ++i) check_equal(again.keys[i], animation.keys[i]);
}

TEST_CASE("anim writer: what an animation does not have is not written") {
  Animation animation;
  animation.frames = 7;
  const Animation again = round_trip(animation);
  CHECK_FALSE(again.scene);
  CHECK(again.fps == 0);
  CHECK_FALSE(again.width);
  CHECK(again.keys.empty());
  animation.scene = "a \"quoted\" name";
  CHECK_FALSE(round_trip(animation).scene);
}

}  // namespace pprt::anim_round_trip_test
