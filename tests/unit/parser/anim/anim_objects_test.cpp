// Objects in scripts.
#include <catch2/catch.hpp>

#include "scene/writers/anim_writer.h"
#include "unit/parser/anim/script.h"

namespace pprt::anim_objects_test {
namespace {

std::string with_object(const std::string& body) {
  return "animation { fps 10 frames 30 object \"car\" { " + body + " } }";
}

bool tells(const std::string& body, const std::string& problem) {
  const std::string told = script_report(with_object(body));
  INFO(told);
  CHECK(told.find(problem) != std::string::npos);
  return told.find(problem) != std::string::npos;
}

}  // namespace

TEST_CASE("anim: an object's keys copy what they omit from the key before") {
  const Animation animation = parsed(with_object(
      "#declare R = 2; key 1 { translate <R, 0, 1> scale 3 } key 1.5s { rotate <0, 90, 0> tension .5 }\n"
      "key 30 { scale <1, 2, 3> visible 0 translate <0, 0, 0> }"));
  REQUIRE(animation.objects.size() == 1);
  const ObjectMotion& car = animation.objects[0];
  CHECK(car.name == "car");
  CHECK(car.location.column == 38);
  REQUIRE(car.keys.size() == 3);
  CHECK((car.keys[0].translate == Vec3d(2, 0, 1) && car.keys[0].scale == Vec3d(3, 3, 3)));
  CHECK((car.keys[1].frame == 16 && car.keys[1].translate == Vec3d(2, 0, 1)));
  CHECK((car.keys[1].rotate == Vec3d(0, 90, 0) && car.keys[1].shape.tension == .5 && car.keys[1].visible));
  CHECK((car.keys[2].scale == Vec3d(1, 2, 3) && !car.keys[2].visible && car.keys[2].rotate.y == 90));
}

TEST_CASE("anim: a script has any number of objects, beside its camera, with keys or without") {
  const Animation animation = parsed(
      "animation { object \"a.nff\" {} camera { key 1 { from <1, 2, 3> } } object \"b\" { key 9 { scale 2 } "
      "} }");
  REQUIRE(animation.objects.size() == 2);
  CHECK((animation.objects[0].keys.empty() && animation.objects[1].keys.size() == 1));
  CHECK(animation.keys.size() == 1);
  CHECK(animation.frames == 9);  // ends with the last key of all
}

TEST_CASE("anim: what an object's keys may not be is told with its place") {
  CHECK(tells("key 1 { from <1, 2, 3> }", "a.anim:1:53: error: 'from' is the camera's, not an object's"));
  CHECK(tells("key 1 { translate 3 }", "'translate' is a vector of three: <x, y, z>"));
  CHECK(tells("key 1 { scale <1, 2> }", "'scale' is a vector of three: <x, y, z>"));
  CHECK(tells("key 1 { visible <1, 2> }", "'visible' is a number, not a vector"));
  CHECK(tells("key 1 { bias 2 }", "'bias' is from -1 to 1, not 2"));
  CHECK(tells("key 3 {} key 2 {}", "frame 2 comes after frame 3 of line 1"));
  CHECK(tells("hold 3", "'hold' stands in camera { ... }, not in object { ... }"));
  CHECK(tells("keys 3 {}", "unknown word 'keys'; did you mean 'key'?"));
  CHECK(tells("key 1 { scale 1 scale 2 }", "'scale' is given twice in this key"));
  CHECK(script_report("animation { object car {} }").find("expected the object's name in quotation marks") !=
        std::string::npos);
  CHECK(script_report("animation { camera { key 1 { scale 2 } } }")
            .find("'scale' is an object's, not the camera's") != std::string::npos);
  // Several at once.
  const std::string all = script_report(with_object("key 1 { bias 2 } key 0 { up <1, 2, 3> }"));
  CHECK(all.find("'bias' is from") != std::string::npos);
  CHECK(all.find("'up' is the camera's") != std::string::npos);
  CHECK(all.find("frame 0 is before the first one") != std::string::npos);
}

TEST_CASE("anim: objects are written as they were read") {
  const Animation animation =
      parsed(with_object("key 1 { translate <.1, 2, 3> } key 7 { rotate <1, 2, .3> visible 0 bias .25 }"));
  const std::string text = anim_script(animation);
  const Animation again = parse_animation(text, "b.anim").animation;
  CHECK(anim_script(again) == text);
  REQUIRE(again.objects.size() == 1);
  REQUIRE(again.objects[0].keys.size() == 2);
  const ObjectKey &a = animation.objects[0].keys[1], &b = again.objects[0].keys[1];
  CHECK((a.frame == b.frame && a.translate == b.translate && a.rotate == b.rotate && a.visible == b.visible));
  CHECK(a.shape.bias == b.shape.bias);
}

TEST_CASE("anim: suns come beside the scene's lights, a sky in place of its own") {
  const Animation script =
      parsed("animation { sun { from <0, 1, 0> } sky { up <0, 1, 0> horizon <1, 1, 1> zenith <0, 0, 1> } }");
  SceneDescription scene;
  scene.lights = {{{1, 2, 3}, {}, {}}};
  scene.sky = Sky();
  add(script.daylight, scene);
  REQUIRE(scene.lights.size() == 2);
  CHECK((!scene.lights[0].is_sun && scene.lights[1].is_sun && scene.light_nodes.empty()));
  CHECK(scene.sky->zenith == Rgb(0, 0, 1));
}

TEST_CASE("anim: what a sun or a sky lacks is told with its place") {
  const auto report = [](const std::string& body) { return script_report("animation { " + body + " }"); };
  const auto has = [](const std::string& text, const char* part) {
    INFO(text);
    CHECK(text.find(part) != std::string::npos);
  };
  has(report("sun { color <1, 1, 1> }"), "a.anim:1:13: error: 'sun' lacks 'from'");
  has(report("sun { from <0, 0, 0> }"), "'from' is a direction: it must not be zero");
  has(report("sun { from 3 }"), "'from' is a vector of three: <x, y, z>");
  has(report("sun { up <0, 1, 0> }"), "'up' is the camera's, not a sun's");
  has(report("sky { up <0, 1, 0> horizon <1, 1, 1> }"), "'sky' lacks 'zenith'");
  has(report("sky { tint 3 }"), "unknown word 'tint'");
  has(report("camera { key 1 { zenith <1, 2, 3> } }"), "'zenith' is the sky's, not the camera's");
  has(report("sky { } sky { }"), "'sky' is given twice");
}

}  // namespace pprt::anim_objects_test
