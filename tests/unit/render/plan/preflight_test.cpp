// A run that would show nothing does not begin, and says why.
#include "render/plan/preflight.h"

#include <catch2/catch.hpp>

#include "base/diagnostics.h"
#include "parser/nff_parser.h"

namespace pprt::preflight_test {
namespace {

using Catch::Matchers::Equals;
using Catch::Matchers::Matches;

const std::string kView = "v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 64 48\n";
const std::string kLit = kView + "b 0 0 1\nl 5 5 5\nf 1 1 1 1 0 0 0 1\n";
const std::string kBall = "s 0 0 0 1\n";

RenderPlan plan_of(const std::string& text) {
  RenderPlan plan;
  plan.scene = parse_nff(text, "t.nff").scene;
  plan.script_frames = {{1, plan.scene.view.value(), false}};
  return plan;
}

std::string outcome(const RenderPlan& plan) {
  try {
    return preflight(plan, compile(plan.scene, plan.compile));
  } catch (const InputError& error) {
    return error.what();
  }
}

std::string outcome(const std::string& text) {
  return outcome(plan_of(text));
}

std::string nothing(const std::string& reason) {
  return "t.nff: error: nothing is to be seen: " + reason;
}

// What the reason is when there are objects in view, but no ray meets them.
const std::string kTooSmall =
    "no ray meets an object: what is in view is smaller than a pixel or shows the eye a side that cannot be "
    "seen";
const std::string kOneColour =
    "t.nff: warning: the picture is of one colour throughout: a single surface fills the view\n";
const std::string kAllAlike =
    "t.nff: warning: the picture is of one colour throughout: all that is in view shows the same\n";
const std::string kNoLight =
    "t.nff: warning: the scene has no light: its objects show in ambient light alone\n";

}  // namespace

TEST_CASE("preflight accepts a scene with visible objects without a warning") {
  CHECK_THAT(outcome(kLit + kBall), Equals(""));
  CHECK_THAT(outcome(kLit + "s 1.8 -1.3 0 0.1"), Equals(""));  // in a corner, five pixels wide
  CHECK_THAT(outcome(kLit + "p 3 -1e3 -1.85 0 1e3 -1.85 0 1e3 -9 0"),
             Equals(""));  // below, three pixels high
}

TEST_CASE("preflight refuses a scene whose objects lie behind the eye or outside the view") {
  CHECK_THAT(outcome(kLit + "s 0 0 7 1\nc 1 1 6 1 0 0 9 0\n"),
             Equals(nothing("all objects lie behind the eye")));
  CHECK_THAT(outcome(kLit + "s 9 0 0 1\ns 0 0 7 1\n"), Equals(nothing("all objects lie outside the view")));
  for (const char* aside : {"s 9 0 0 1", "s -9 0 0 1", "s 0 9 0 1", "s 0 -9 0 1"}) {
    CHECK_THAT(outcome(kLit + aside), Equals(nothing("all objects lie outside the view")));
  }
  CHECK_THAT(outcome(kLit + "s 9 0 0 1\ns 0 0 0 1"), Equals(""));
}

TEST_CASE("preflight refuses a scene whose objects no ray meets") {
  CHECK_THAT(outcome(kLit + "s 0 0 0 1e-6"), Equals(nothing(kTooSmall)));
  CHECK_THAT(outcome(kLit + "s 0 0 0 -1"), Equals(""));          // a far wall seen through the near one
  RenderPlan plan = plan_of(kLit + "p 3 -1 -1 0 0 1 0 1 -1 0");  // its back
  CHECK_THAT(outcome(plan), Equals(""));
  plan.compile.cull = true;
  CHECK_THAT(outcome(plan), Equals(nothing(kTooSmall)));
}

TEST_CASE("preflight refuses a scene whose objects have the background's colour") {
  const std::string black = "f 0 0 0 1 0 0 0 1\n";
  const std::string same = "what is in view has the colour of the background";
  CHECK_THAT(outcome(kView + black + kBall), Equals(nothing(same + " (no light and no background)")));
  CHECK_THAT(outcome(kView + "b 0 0 0\n" + black + kBall), Equals(nothing(same + " (no light)")));
  CHECK_THAT(outcome(kView + "l 5 5 5\n" + black + kBall), Equals(nothing(same)));
  CHECK_THAT(outcome(kView + "b 0 0 1\n" + black + kBall), Equals(kNoLight));
}

TEST_CASE("preflight takes no sky for an object, and whatever is before one for seen") {
  RenderPlan plan = plan_of(kView + "f 0 0 0 1 0 0 0 1\n" + kBall);
  plan.scene.sky = Sky{.up = {0, 1, 0}, .horizon = {0, 0, 0}, .zenith = {1, 1, 1}};
  CHECK_THAT(outcome(plan), Equals(kNoLight));
  plan = plan_of(kLit + "s 0 0 7 1\n");
  plan.scene.sky = Sky{.up = {0, 1, 0}, .horizon = {0, 0, 0}, .zenith = {1, 1, 1}};
  CHECK_THAT(outcome(plan), Equals(nothing("all objects lie behind the eye")));
}

TEST_CASE("preflight warns of a scene without a light") {
  CHECK_THAT(outcome(kView + "f 1 1 1 1 0 0 0 1\n" + kBall), Equals(kNoLight));
}

TEST_CASE("preflight warns of a picture of one colour") {
  CHECK_THAT(outcome(kLit + "s 0 0 0 6"), Equals(kOneColour));  // the light is outside
  CHECK_THAT(outcome(kLit + "s 0 0 0 6\ns 1.8 -1.3 0 0.1"),
             Equals(kAllAlike));  // and in the dark is all alike
  CHECK_THAT(outcome(kLit + "s 0 0 0 6\nf 0 0 0 1 0 0 0 1\ns 1.8 -1.3 0 0.1"), Equals(""));
}

TEST_CASE("preflight counts objects that repeat earlier ones") {
  CHECK_THAT(outcome(kLit + kBall + kBall), Equals("t.nff:6:1: warning: an object repeats an earlier one "
                                                   "exactly, with its fill: it is left out\n"));
  CHECK_THAT(outcome(kLit + kBall + "s 1 0 0 1\n" + kBall + kBall),
             Equals("t.nff:7:1: warning: 2 objects repeat earlier ones exactly, with their fill: they are "
                    "left out (the first is here)\n"));
  CHECK_THAT(outcome(kLit + kBall + "f 1 0 0 1 0 0 0 1\n" + kBall), Equals(""));
}

TEST_CASE("preflight warns of glass that is inside out") {
  const std::string glass = kLit + "f 1 1 1 0.1 0 0 0.9 ";
  // A tetrahedron, its faces turned outwards, and the same turned inwards.
  const std::string a = " -1 -1 1", b = " 1 -1 1", c = " 0 1 1", d = " 0 0 -1";
  const auto faces = [](std::initializer_list<std::string> each) {
    std::string text;
    for (const std::string& face : each) text += "p 3" + face + "\n";
    return text;
  };
  const std::string outwards = faces({a + b + c, b + a + d, c + b + d, a + c + d});
  const std::string inwards = faces({a + c + b, a + b + d, b + c + d, c + a + d});
  CHECK_THAT(outcome(glass + "1.5\n" + outwards), Equals(""));
  CHECK_THAT(
      outcome(glass + "1.5\n" + inwards),
      Matches("t.nff:6:1: warning: glass is inside out and will look dark: ([1-9][0-9]*) of \\1 rays that "
              "meet glass meet its back from outside; reverse the vertices of its polygons\n"));
  CHECK_THAT(outcome(glass + "1\n" + inwards), Equals(""));  // bends no ray
  RenderPlan plan = plan_of(glass + "1.5\n" + inwards);
  plan.compile.effects = EffectSet();
  CHECK_THAT(outcome(plan), Equals(""));
  // An eye in the glass, one that looks into an open cylinder, and a pane from behind.
  CHECK_THAT(outcome(glass + "1.5\ns 0 0 0 9\nf 1 0 0 1 0 0 0 1\n" + kBall), Equals(""));
  CHECK_THAT(outcome(glass + "1.5\nc 0 0 -1 1.5 0 0 -4 1.5\n"), Equals(""));
  CHECK_THAT(outcome(glass + "1.5\np 3" + a + c + b), Equals(""));
}

TEST_CASE("preflight accepts a sequence when one of its frames shows something") {
  RenderPlan plan = plan_of(kLit + kBall);
  View away = plan.scene.view.value();
  away.at = {0, 0, 9};
  plan.script_frames.assign(40, {1, away, false});
  CHECK_THAT(outcome(plan),
             Equals("t.nff: error: nothing is to be seen in any frame: all objects lie behind the eye"));
  plan.script_length = 41;  // one has not been looked at
  CHECK_THAT(outcome(plan),
             Equals("t.nff: warning: nothing is to be seen in 40 of its 41 frames, the only ones "
                    "looked at\n"));
  plan.script_length = 40;
  plan.script_frames[30].view = plan.scene.view.value();
  CHECK_THAT(outcome(plan), Equals(""));
}

TEST_CASE("a camera path is checked before its first frame: an eye too far away is refused with its frame") {
  RenderPlan plan = plan_of(kLit + kBall);
  const CompiledScene scene = compile(plan.scene, plan.compile);
  const auto refused = [&](const Vec3d& eye) -> std::string {
    View far = plan.scene.view.value();
    far.from = eye;
    plan.script_frames[1].view = far;
    try {
      require_eyes_in_reach(plan, scene);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  plan.script_name = "t.anim";
  plan.script_frames.assign(3, plan.script_frames[0]);
  plan.script_frames[1].number = 2;
  CHECK_THAT(refused({0, 0, 2e12}), Equals(""));
  CHECK_THAT(
      refused({0, 0, 4e19}),
      Equals("t.anim: error: frame 2: the eye is 2.0e+19 times the scene's size away; the most is 1.1e+12"));
  CHECK_THAT(refused({1e308, 1e308, 1e308}), Catch::Contains("frame 2: the eye is"));
  plan.script_name.clear();
  CHECK_THAT(refused({0, -4e19, 0}),
             Equals("t.nff: error: the eye is 2.0e+19 times the scene's size away; the most is 1.1e+12"));
}

TEST_CASE("preflight accepts colours that are not finite") {
  RenderPlan plan = plan_of(kLit + kBall);
  plan.scene.materials[0].color = Rgb(1e308, -1e308, 0) * 1e10;
  CHECK_THAT(outcome(plan), !Catch::Contains("error"));
}

}  // namespace pprt::preflight_test
