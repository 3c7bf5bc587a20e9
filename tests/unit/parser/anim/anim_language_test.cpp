#include <catch2/catch.hpp>
#include <numbers>

#include "unit/parser/anim/script.h"

namespace pprt::anim_language_test {
namespace {

TEST_CASE("the example script is read with all its values") {
  const ParsedAnimation result = parse_animation(kExample, "a.anim");
  CHECK(result.warnings.empty());
  const Animation& a = result.animation;
  CHECK(a.name == "a.anim");
  CHECK(a.scene == "spd:tree");
  CHECK(a.frames == 40);
  CHECK(a.fps == 4);
  CHECK(a.width == 256);
  CHECK(a.height == 256);
  CHECK(a.spline == SplineKind::kTcb);
  REQUIRE(a.keys.size() == 4);

  CHECK(a.keys[0].frame == 1);
  CHECK(a.keys[0].from == Vec3d(4.6, 0.4, 2));
  CHECK(a.keys[0].up == Vec3d(0, 0, 1));
  CHECK(a.keys[0].angle_degrees == 45);
  CHECK_FALSE((a.keys[0].cut || a.keys[0].hold));
  CHECK(a.keys[0].location == SourceLocation{8, 5});

  CHECK(a.keys[1].hold);
  CHECK(a.keys[1].frame == 10);
  CHECK(a.keys[1].from == a.keys[0].from);

  CHECK_FALSE(a.keys[2].hold);
  CHECK(a.keys[2].from.x == Approx(-4.6 * std::sqrt(3) / 2));
  CHECK(a.keys[2].from.y == Approx(2.3));
  CHECK(a.keys[2].up == Vec3d(0, 0, 1));
  CHECK(a.keys[2].angle_degrees == 30);

  const CameraKey& cut = a.keys[3];
  CHECK(cut.cut);
  CHECK((cut.of_scene.up && !cut.of_scene.from && !cut.of_scene.at && !cut.of_scene.angle));
  CHECK(cut.tension == 0.5);
  CHECK(cut.continuity == -0.5);
  CHECK(cut.bias == 1);
  CHECK(cut.ease_in == 0.25);
  CHECK(cut.ease_out == 0.5);
}

TEST_CASE("an expression has the value that precedence and functions give it") {
  const auto [expression, expected] = GENERATE(table<const char*, double>({
      {"1", 1},
      {"1.", 1},
      {".5", 0.5},
      {"2.5e-1", 0.25},
      {"1E2", 100},
      {"1+2*3", 7},
      {"(1+2)*3", 9},
      {"7-2-1", 4},
      {"8/4/2", 1},
      {"2^3^2", 512},
      {"-2^2", -4},
      {"2^-1", 0.5},
      {"--3", 3},
      {"-+3", -3},
      {"2*-3", -6},
      {"2 - -3", 5},
      {"0^0", 1},
      {"(-2)^3", -8},
      {"sin(30)", 0.5},
      {"sin(180)", 0},
      {"cos(90)", 0},
      {"cos(-360)", 1},
      {"cos(120)", -0.5},
      {"tan(45)", 1},
      {"tan(-180)", 0},
      {"sqrt(2)^2", 2},
      {"abs(-4)", 4},
      {"abs(4)", 4},
      {"min(3, 1, 2)", 1},
      {"max(3, 1+4, 2)", 5},
      {"max(-1)", -1},
      {"pi", std::numbers::pi},
      {"min(1,2)+max(min(3,4),2)", 4},
      {"( ( 3 ) )", 3},
      {"1 /* one */ + // and\n 2 # three\n", 3},
  }));
  CAPTURE(expression);
  CHECK(value(expression) == Approx(expected).epsilon(1e-15).margin(1e-300));
}

TEST_CASE("vectors are added, subtracted, negated, and multiplied and divided by numbers") {
  const Animation a = camera(
      "#declare P = <1, 2, 3>; #declare K = 2; "
      "key 1 { from K*P + <1, 0, 0> at -P*2 - <0, 0, 1> up (<0, 0, 4> + <0, 2, 0>)/K angle 45 }");
  CHECK(a.keys[0].from == Vec3d(3, 4, 6));
  CHECK(a.keys[0].at == Vec3d(-2, -4, -7));
  CHECK(a.keys[0].up == Vec3d(0, 1, 2));
}

TEST_CASE("a name has its latest value") {
  const Animation a = parsed(
      "#declare a = 1; #declare b = a + 1; #declare a = 5; animation { #declare c = a*b; camera { "
      "#declare s = c; key s { from <a, b, c> at <0, 0, 0> } } }");
  CHECK(a.keys[0].frame == 10);
  CHECK(a.keys[0].from == Vec3d(5, 2, 10));
}

TEST_CASE("times count from the first frame, wherever fps stands") {
  const Animation a = parsed(
      "animation { camera { key 0s { from <1,2,3> } key 2.5s{ from <4,5,6> } hold (1+2) s cut 3.5 *2s { } } "
      "fps 4 }");
  REQUIRE(a.keys.size() == 4);
  CHECK(a.keys[0].frame == 1);
  CHECK(a.keys[1].frame == 11);
  CHECK(a.keys[2].frame == 13);
  CHECK(a.keys[3].frame == 29);
  CHECK(a.frames == 29);  // not given: up to the last key
}

TEST_CASE("without frames the animation ends with its last key, whole") {
  CHECK(parsed("animation { camera { key 1 {} key 7.2 {} } }").frames == 8);
  CHECK(parsed("animation { }").frames == 1);
}

TEST_CASE("what a key does not give stays as in the key before, and the first key's is the scene's") {
  const Animation a = camera(
      "key 1 { at <0,0,0> tension 1 ease_in 0.5 } key 2 { from <1,1,1> } hold 3 key 4 { tension 0 angle 20 } "
      "cut 5 { up <1,0,0> }");
  CHECK((a.keys[0].of_scene.from && !a.keys[0].of_scene.at && a.keys[0].of_scene.up &&
         a.keys[0].of_scene.angle));
  CHECK((!a.keys[1].of_scene.from && !a.keys[1].of_scene.at && a.keys[1].of_scene.up));
  CHECK(a.keys[1].tension == 1);
  CHECK(a.keys[1].ease_in == 0.5);
  CHECK(a.keys[2].tension == 1);
  CHECK(a.keys[3].tension == 0);
  CHECK(a.keys[3].ease_in == 0.5);
  CHECK(a.keys[3].from == Vec3d(1, 1, 1));
  CHECK_FALSE(a.keys[3].of_scene.angle);
  CHECK((a.keys[4].of_scene.from && a.keys[4].of_scene.at && !a.keys[4].of_scene.up &&
         a.keys[4].of_scene.angle));
  CHECK(a.keys[4].ease_in == 0);
}

TEST_CASE("splines have their names, and tcb is the default") {
  CHECK(camera("").spline == SplineKind::kTcb);
  CHECK(camera("spline tcb").spline == SplineKind::kTcb);
  CHECK(camera("spline linear").spline == SplineKind::kLinear);
  CHECK(camera("spline catmull_rom").spline == SplineKind::kCatmullRom);
}

TEST_CASE("comments, blanks, line ends and a byte order mark have no meaning") {
  CHECK(parsed("\xef\xbb\xbf# first\r\n/**/animation/* * / */{//\r\nframes\t3#x\r}\f#declared is a comment")
            .frames == 3);
  CHECK(parsed("animation{frames 3 fps 2scene\"a b/c.nff\"}").scene == "a b/c.nff");
  CHECK(parsed("animation { frames 2 // at the very end, without a line end\n}//").frames == 2);
}

TEST_CASE("warnings come with their places, and the animation all the same") {
  const ParsedAnimation result = parse_animation(
      "animation {\n  frames 10\n  camera {\n    spline linear\n    key 1 { from <1,2,3> bias 1 }\n"
      "    hold 12\n  }\n}\n",
      "a.anim");
  CHECK(result.animation.keys.size() == 2);
  CHECK(result.warnings ==
        "a.anim:5:31: warning: 'bias' has no effect: the spline is not tcb\n"
        "        key 1 { from <1,2,3> bias 1 }\n"
        "                                  ^\n"
        "a.anim:6:10: warning: frame 12 is beyond the last one, 10\n"
        "        hold 12\n"
        "             ^\n");
}

TEST_CASE("a script may tell the version of its language") {
  CHECK(parsed("#version 1;\nanimation { frames 3 }").frames == 3);
  CHECK(parsed("animation { frames 3 } #version 2 - 1;").frames == 3);
  CHECK(parsed("#versions 2;\nanimation { frames 3 }").frames == 3);  // a comment
}

}  // namespace
}  // namespace pprt::anim_language_test
