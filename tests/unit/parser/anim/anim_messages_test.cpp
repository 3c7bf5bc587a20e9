#include <algorithm>
#include <catch2/catch.hpp>

#include "unit/parser/anim/script.h"

namespace pprt::anim_messages_test {
namespace {

// The report of a script with a problem in its one line, without the line and the caret.
std::string message(const std::string& text) {
  const std::string whole = script_report(text);
  return whole.substr(0, whole.find('\n'));
}

std::string in_animation(const std::string& body) {
  return message("animation {" + body + "}");
}
std::string in_camera(const std::string& body) {
  return message("animation{camera{" + body + "}}");
}
std::string in_key(const std::string& body) {
  return message("animation{camera{key 1{" + body + "}}}");
}

TEST_CASE("a report has file, line, column, the line and a caret, and every problem in order") {
  CHECK(script_report(
            "animation {\n  frmes 40\n  fps -4\n  camera {\n    key 1 { from <1, 2 at <0, 0> anlge 190 }\n"
            "    key 1 { angle 1/0 }\n  }\n}\n") ==
        R"(a.anim:2:3: error: unknown word 'frmes'; did you mean 'frames'?
      frmes 40
      ^
a.anim:3:7: error: 'fps' is from 0.001 to 1000, not -4
      fps -4
          ^
a.anim:5:24: error: expected '>' at the end of the vector, found 'at'
        key 1 { from <1, 2 at <0, 0> anlge 190 }
                           ^
a.anim:5:27: error: 'at' is a vector of three: <x, y, z>
        key 1 { from <1, 2 at <0, 0> anlge 190 }
                              ^
a.anim:5:34: error: unknown word 'anlge'; did you mean 'angle'?
        key 1 { from <1, 2 at <0, 0> anlge 190 }
                                     ^
a.anim:6:9: error: frame 1 has its key already, in line 5
        key 1 { angle 1/0 }
            ^
a.anim:6:20: error: division by zero
        key 1 { angle 1/0 }
                       ^)");
}

TEST_CASE("each problem of the text has its message") {
  const auto [text, expected] = GENERATE(table<const char*, const char*>({
      {"", "a.anim:1:1: error: expected 'animation { ... }', found the end of the script"},
      {"// nothing", "a.anim:1:11: error: expected 'animation { ... }', found the end of the script"},
      {"animation", "a.anim:1:10: error: expected '{' after 'animation', found the end of the script"},
      {"animation {",
       "a.anim:1:12: error: expected '}' at the end of the animation, found the end of the script"},
      {"animation frames 3 }", "a.anim:1:11: error: expected '{' before this"},
      {"#version 2; animation {}",
       "a.anim:1:10: error: this is a script of version 2; version 1 is the one that can be read"},
      {"#version <1, 2>; animation {}", "a.anim:1:10: error: '#version' is a number, not a vector"},
      {"#version 1 animation {}", "a.anim:1:12: error: expected ';' after the version, found 'animation'"},
      {"animation {} animation {}", "a.anim:1:14: error: a script has one animation"},
      {"animation {} }", "a.anim:1:14: error: did not expect '}' in the script itself"},
      {"anmation {{} frames {}}", "a.anim:1:1: error: unknown word 'anmation'; did you mean 'animation'?"},
      {"frames 3", "a.anim:1:1: error: 'frames' stands in animation { ... }, not in the script itself"},
      {"\"x\"", "a.anim:1:1: error: did not expect '\"x\"' in the script itself"},
      {"animation {} /* open", "a.anim:1:14: error: expected '*/' at the end of this comment"},
      {"#declare = 3; animation {}", "a.anim:1:10: error: expected a name to declare, found '='"},
      {"#declare sin = 3; animation {}", "a.anim:1:10: error: expected a name to declare, found 'sin'"},
      {"#declare key = 3; animation {}", "a.anim:1:10: error: expected a name to declare, found 'key'"},
      {"#declare R 3; animation {}", "a.anim:1:12: error: expected '=' after the declared name, found '3'"},
      {"#declare R = 3 animation {}",
       "a.anim:1:16: error: expected ';' after the declared value, found 'animation'"},
      {"#declare R = ; animation {}",
       "a.anim:1:14: error: expected a number, a name, a vector or '(', found ';'"},
  }));
  CHECK(message(text) == expected);
}

TEST_CASE("each problem of the animation has its message") {
  const auto [body, expected] = GENERATE(table<const char*, const char*>({
      {"frames 0", "a.anim:1:19: error: 'frames' is a whole number from 1 to 1000000, not 0"},
      {"frames 2.5", "a.anim:1:19: error: 'frames' is a whole number from 1 to 1000000, not 2.5"},
      {"frames 1e7", "a.anim:1:19: error: 'frames' is a whole number from 1 to 1000000, not 10000000"},
      {"frames <1,2>", "a.anim:1:19: error: 'frames' is a number, not a vector"},
      {"frames 1 frames 2", "a.anim:1:21: error: 'frames' is given twice"},
      {"fps 0", "a.anim:1:16: error: 'fps' is from 0.001 to 1000, not 0"},
      {"fps 0.0009", "a.anim:1:16: error: 'fps' is from 0.001 to 1000, not 0.0009"},
      {"fps 1001", "a.anim:1:16: error: 'fps' is from 0.001 to 1000, not 1001"},
      {"fps <1,2,3>", "a.anim:1:16: error: 'fps' is a number, not a vector"},
      {"fps 4 fps 4", "a.anim:1:18: error: 'fps' is given twice"},
      {"resolution 256", "a.anim:1:23: error: 'resolution' is a vector of two: <width, height>"},
      {"resolution <1,2,3>", "a.anim:1:23: error: 'resolution' is a vector of two: <width, height>"},
      {"resolution <0, 9>",
       "a.anim:1:23: error: 'resolution' is of whole numbers from 1 to 16384, not <0, 9>"},
      {"resolution <9, 16385>",
       "a.anim:1:23: error: 'resolution' is of whole numbers from 1 to 16384, not <9, 16385>"},
      {"resolution <1,2> resolution <1,2>", "a.anim:1:29: error: 'resolution' is given twice"},
      {"scene tree", "a.anim:1:18: error: expected the scene's name in quotation marks, found 'tree'"},
      {"scene \"\"", "a.anim:1:19: error: expected the scene's name between the quotation marks, found '\"'"},
      {"scene \"a\n", "a.anim:1:20: error: expected '\"' at the end of the scene's name, found '\\n'"},
      {"scene \"a\" scene \"b\"", "a.anim:1:22: error: 'scene' is given twice"},
      {"key 1 {}", "a.anim:1:12: error: 'key' stands in camera { ... }, not in animation { ... }"},
      {"camra { key 1 { } }", "a.anim:1:12: error: unknown word 'camra'; did you mean 'camera'?"},
      {"camera {} camera {}", "a.anim:1:22: error: an animation has one camera"},
      {"camera spline tcb }", "a.anim:1:19: error: expected '{' before this"},
      {"; 5", "a.anim:1:12: error: did not expect ';' in animation { ... }"},
      {"turntable <1, 2> 5", "a.anim:1:12: error: unknown word 'turntable'"},
  }));
  CHECK(in_animation(body) == expected);
}

TEST_CASE("each problem of the camera has its message") {
  const auto [body, expected] = GENERATE(table<const char*, const char*>({
      {"spline tbc",
       "a.anim:1:25: error: expected linear, catmull_rom or tcb, found 'tbc'; did you mean 'tcb'?"},
      {"spline 3", "a.anim:1:25: error: expected linear, catmull_rom or tcb, found '3'"},
      {"spline tcb spline tcb", "a.anim:1:29: error: 'spline' is given twice"},
      {"frames 3", "a.anim:1:18: error: 'frames' stands in animation { ... }, not in camera { ... }"},
      {"from <1,2,3>", "a.anim:1:18: error: 'from' stands in a key's { ... }, not in camera { ... }"},
      {"kye 1 { from <1,2,3> }", "a.anim:1:18: error: unknown word 'kye'; did you mean 'key'?"},
      {"hold 3", "a.anim:1:18: error: nothing to hold: no key stands before this"},
      {"cut 3 {}", "a.anim:1:18: error: nothing to cut from: no key stands before this"},
      {"key {}", "a.anim:1:22: error: expected a number, a name, a vector or '(', found '{'"},
      {"key 1 from <1,2,3> }", "a.anim:1:24: error: expected '{' before this"},
      {"key 1 }", "a.anim:1:24: error: expected '{' with the camera of the key, found '}'"},
      {"key 1 { key 2 {}", "a.anim:1:26: error: expected '}' at the end of the key, found 'key'"},
      {"key <1,2,3> {}", "a.anim:1:22: error: 'key' is a number, not a vector"},
      {"key 0 {}",
       "a.anim:1:22: error: frame 0 is before the first one: frames count from 1, seconds from 0"},
      {"key 2e6 {}", "a.anim:1:22: error: frame 2000000 is beyond the last possible one, 1000000"},
      {"key 1s {}", "a.anim:1:22: error: a time in seconds needs 'fps' in the animation"},
      {"key 2 {} hold 2", "a.anim:1:32: error: frame 2 has its key already, in line 1"},
      {"key 5 {} key 2 {}",
       "a.anim:1:31: error: frame 2 comes after frame 5 of line 1: keys stand in the order of time"},
  }));
  CHECK(in_camera(body) == expected);
}

TEST_CASE("each problem of a key has its message") {
  const auto [body, expected] = GENERATE(table<const char*, const char*>({
      {"form <1,2,3>", "a.anim:1:24: error: unknown word 'form'; did you mean 'from'?"},
      {"from 3", "a.anim:1:29: error: 'from' is a vector of three: <x, y, z>"},
      {"at <1,2>", "a.anim:1:27: error: 'at' is a vector of three: <x, y, z>"},
      {"from <1,2,3> from <1,2,3>", "a.anim:1:37: error: 'from' is given twice in this key"},
      {"from <1 2,3>", "a.anim:1:32: error: expected ',' and the next component of the vector, found '2'"},
      {"from <1,2,3", "a.anim:1:35: error: expected '>' at the end of the vector, found '}'"},
      {"angle 0", "a.anim:1:30: error: 'angle' is between 0 and 180 degrees, not 0"},
      {"angle 180", "a.anim:1:30: error: 'angle' is between 0 and 180 degrees, not 180"},
      {"angle <1,2,3>", "a.anim:1:30: error: 'angle' is a number, not a vector"},
      {"tension 1.5", "a.anim:1:32: error: 'tension' is from -1 to 1, not 1.5"},
      {"bias -2", "a.anim:1:29: error: 'bias' is from -1 to 1, not -2"},
      {"ease_in -0.1", "a.anim:1:32: error: 'ease_in' is from 0 to 1, not -0.1"},
      {"ease_in .7 ease_out .6",
       "a.anim:1:44: error: 'ease_in' and 'ease_out' share the way: 0.7 and 0.6 are more than 1"},
      {"from <1,2,3> at <1,2,3> up <0,0,1>",
       "a.anim:1:51: error: the camera stands where it looks at: 'from' and 'at' are the same point"},
      {"from <0,0,0> at <0,0,5> up <0,0,-1>", "a.anim:1:51: error: 'up' is parallel to the view"},
      {"from <0,0,0> at <0,0,5> up <0,0,0>", "a.anim:1:51: error: 'up' has no direction"},
      {"3", "a.anim:1:24: error: did not expect '3' in a key's { ... }"},
  }));
  CHECK(in_key(body) == expected);
}

TEST_CASE("each problem of an expression has its message") {
  const auto [expression, expected] = GENERATE(table<const char*, const char*>({
      {"1/0", "a.anim:1:31: error: division by zero"},
      {"1/(2-2)", "a.anim:1:31: error: division by zero"},
      {"0^-1", "a.anim:1:31: error: division by zero"},
      {"sqrt(-1)", "a.anim:1:30: error: a negative number has no square root"},
      {"(-8)^.5", "a.anim:1:34: error: a negative number has no power that is not whole"},
      {"tan(90)", "a.anim:1:30: error: the tangent is infinite here"},
      {"1e101", "a.anim:1:30: error: the number is too large"},
      {"1e999", "a.anim:1:30: error: the number is too large"},
      {"10^101", "a.anim:1:32: error: the result is too large"},
      {"1e99*1e99", "a.anim:1:34: error: the result is too large"},
      {"R", "a.anim:1:30: error: unknown name 'R'"},
      {"pie", "a.anim:1:30: error: unknown name 'pie'; did you mean 'pi'?"},
      {"sin", "a.anim:1:30: error: 'sin' is a function: expected '(' after it"},
      {"sine(3)", "a.anim:1:30: error: unknown function 'sine'; did you mean 'sin'?"},
      {"pi(3)", "a.anim:1:30: error: 'pi' is a number, not a function"},
      {"sin(1,2)", "a.anim:1:30: error: 'sin' is of one number, not of 2"},
      {"max()", "a.anim:1:34: error: expected a number, a name, a vector or '(', found ')'"},
      {"max(1", "a.anim:1:35: error: expected ')', found '}'"},
      {"(1", "a.anim:1:32: error: expected ')', found '}'"},
      {"1+", "a.anim:1:32: error: expected a number, a name, a vector or '(', found '}'"},
      {"1+*2", "a.anim:1:32: error: expected a number, a name, a vector or '(', found '*'"},
      {"abs(<1,2,3>)", "a.anim:1:34: error: 'abs' is of numbers, not vectors"},
      {"1+<1,2,3>", "a.anim:1:31: error: cannot add a number and a vector"},
      {"<1,2>-<1,2,3>", "a.anim:1:35: error: cannot subtract vectors of 2 and 3 components"},
      {"<1,2,3>*<1,2,3>", "a.anim:1:37: error: cannot multiply a vector and a vector"},
      {"1/<1,2,3>", "a.anim:1:31: error: cannot divide a number and a vector"},
      {"<1,2,3>^2", "a.anim:1:37: error: cannot raise to a power a vector and a number"},
      {"<1,<1,2>,3>", "a.anim:1:33: error: a component of a vector is a number"},
      {"<1,2,<1,2>>", "a.anim:1:35: error: a component of a vector is a number"},
  }));
  CAPTURE(expression);
  CHECK(in_key("angle " + std::string(expression)) == expected);
}

TEST_CASE("one mistake is one problem: what depends on it is not reported again") {
  const auto text = GENERATE(
      "#declare R = 1/0; animation { camera { key 1 { from <R, R+1, sin(R)> at R*<1,2,3> angle -R } } }",
      "#declare R = 4.6 animation { camera { key 1 { from <R, 0, 0> at <0, 0, 0> } } }",
      "animation { camera { key 1 { from <0,0,0> at <0,0,5> up <0,0,1> } hold 2 key 3 { angle 3 } } }",
      "animation { fps 0 camera { key 1s { } key 2s { } } }");
  const std::string whole = script_report(text);
  CHECK(std::count(whole.begin(), whole.end(), '\n') == 2);
}

TEST_CASE("an unknown name is compared with those declared") {
  CHECK(message("#declare Radius = 3; animation { camera { key Radios {} } }") ==
        "a.anim:1:47: error: unknown name 'Radios'; did you mean 'Radius'?");
}

TEST_CASE("a script file that is not there is reported") {
  CHECK_THROWS_WITH(read_animation("/nonexistent/a.anim"),
                    "cannot read '/nonexistent/a.anim': No such file or directory");
}

// Whatever a value was made from, what is said of it later needs its place.
TEST_CASE("a field with an erroneous value and without effect causes both messages") {
  const std::string camera = "animation { camera { spline linear key 1 { bias ";
  for (const char* value :
       {"X", "(X * 2)", "-X", "X - 1", "1 / 0", "abs(X)", "sqrt(-1)", "what(1)", "<X, 1>", "1e99 * 1e99"}) {
    CAPTURE(value);
    const std::string text = script_report(camera + value + " } } }");
    CHECK(text.starts_with("a.anim:1:"));
    CHECK(text.find("warning: 'bias' has no effect: the spline is not tcb\n") != std::string::npos);
  }
}

}  // namespace
}  // namespace pprt::anim_messages_test
