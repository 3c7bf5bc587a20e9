// Objects, lights and vertices far away: nothing ends the run, and what lies together keeps its digits.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "parser/aff_parser.h"
#include "scene/animation/resting_nodes.h"
#include "trace/compiled_scene.h"
#include "trace/geometry/embree_reach.h"

namespace pprt::far_objects_test {

namespace {

const std::string kView = "v from 0 -5 2 at 0 0 0 up 0 0 1 angle 45 hither .1 resolution 24 24\n";
const std::string kLight = "am .3 .3 .3 b .1 .2 .4 l 3 -4 6 f .8 .3 .2 .8 .1 10 0 1\n";
const std::string kNear = kView + kLight + "s 0 0 0 1 c 0 0 0 .3 0 0 2 .1 p 3 -2 -2 -1 2 -2 -1 0 3 -1\n";

// A body that no map of its own brings to rest.
std::string body(const std::string& objects) {
  return "xs .5 2 1 0 1 0 30 0 0 1 {" + objects + "}\n";
}

// A ball that stands at one place at time 0 and at another from time 3 on.
std::string flying(const std::string& from, const std::string& to) {
  std::string keys = "k ship { transl 6";
  for (int time = -1; time < 5; ++time)
    keys += " " + std::to_string(time) + " " + (time < 3 ? from : to) + " 0 0 0";
  return keys + " }\nx ship { s 0 0 0 1 }\na 0 4 5\n";
}

CompiledScene compiled(const std::string& text) {
  return compile(without_resting_nodes(parse_aff(text, "far.aff").scene));
}

// Pixels that differ visibly at a time between two scenes of the same view; those that see a body at all.
struct Difference {
  int pixels = 0, seen = 0;
};

Difference difference(const std::string& one, const std::string& other, double time = 0) {
  const CompiledScene a = compiled(one), b = compiled(other);
  const View view = *parse_aff(kView, "view.aff").scene.view;
  Tracer of_a(a, a.camera(view)), of_b(b, b.camera(view));
  of_a.set_time(time), of_b.set_time(time);
  Difference found;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const RaySample from_a = of_a.trace(x + 0.5, y + 0.5), from_b = of_b.trace(x + 0.5, y + 0.5);
      found.pixels += !((from_a.color - from_b.color).length() < 1.F / 255);
      found.seen += !from_b.at_infinity;
    }
  }
  return found;
}

}  // namespace

TEST_CASE("far objects: one that rests far away takes no digits of the others") {
  for (const char* distance : {"1e6", "1e10", "-1e14", "1e18"}) {
    INFO(distance);
    const Difference found = difference(kNear, kNear + "s 0 0 " + distance + " 1\n");
    CHECK(found.seen > 200);
    CHECK(found.pixels <= 2);
  }
}

TEST_CASE("far objects: of two objects the one that the view looks at is near") {
  const std::string one = kView + kLight + "s 0 0 0 1\n";
  for (const char* far :
       {"0 0 1e7", "0 0 -1e7", "0 1e8 0", "1e9 0 0", "-1e10 0 1e10", "0 0 1e16", "0 -1e18 0"}) {
    INFO(far);
    const Difference found = difference(one, one + "s " + far + " 1\n");
    CHECK(found.seen > 20);
    CHECK(found.pixels <= 2);
  }
}

TEST_CASE("far objects: one that flies away takes no digits of the others, at any time") {
  for (const char* distance : {"1e6", "1e10", "1e14", "1e18", "1e38", "1e60", "1e100"}) {
    for (const double time : {0.0, 4.0}) {
      INFO(distance << " at " << time);
      const Difference found =
          difference(kNear, kNear + flying("0 0 100", "0 0 " + std::string(distance)), time);
      CHECK(found.seen > 200);
      CHECK(found.pixels <= 2);
    }
  }
  // All move, and one of them flies away.
  const std::string all = kView + kLight + "x a {s 0 0 0 1} k a {visibility 1 0 1}\n";
  CHECK(difference(all, all + flying("0 0 90", "0 0 1e15"), 4).pixels <= 2);
}

TEST_CASE("far objects: a body keeps its place beside a vertex that is far away") {
  const auto scene = [](const std::string& distance) {
    return kView + kLight + "p 3 0 0 -30 1 0 -30 " + distance + " 2 -30\n" + body("c 0 0 0 .5 0 0 2 .2");
  };
  for (const char* distance : {"1e8", "3e15", "1e16"}) {
    INFO(distance);
    const Difference found = difference(scene("1e5"), scene(distance));
    CHECK(found.seen > 20);
    CHECK(found.pixels <= 6);
  }
}

// Embree's own assertions would end the test.
TEST_CASE("far objects: nothing that a file can say leaves Embree's reach") {
  int traced = 0;
  for (const char* far : {"1e17", "1e19", "2e20", "1e30", "1e37", "1e38", "3.4e38", "1e45", "1e100"}) {
    const std::string place = std::string(far) + " 1 -" + far;
    for (const std::string& objects :
         {"p 3 0 0 0 1 0 0 " + place + "\n" + body("s 0 0 0 1"), body("s " + place + " 1") + "s 0 0 0 1",
          body("s 0 0 0 1 p 3 0 0 0 1 0 0 " + place), "s 0 0 0 1 l " + place + " la ship " + place + "\n",
          "s 0 0 0 1 " + flying(place, "0 0 0"), "s 0 0 0 " + std::string(far) + "\n" + body("s 0 0 0 1e-9"),
          "xs 1e-30 1e-30 1e-30 0 1 0 30 0 0 0 {" + body("s 0 0 0 " + std::string(far)) + "} s 0 0 0 1",
          "tpa 2 0 0 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1 1 " + place +
              " 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1 s 1 1 1 1"}) {
      INFO(objects);
      const CompiledScene scene = compiled(kView + kLight + objects);
      const View view = *parse_aff(kView, "view.aff").scene.view;
      if (!(scene.distance(view.from) <= kFarthestEye)) continue;
      Tracer tracer(scene, scene.camera(view));
      ++traced;
      for (const double time : {0.0, 0.5, 4.0}) {
        tracer.set_time(time);
        for (int i = 0; i < 24; ++i) tracer.trace(i + 0.5, 12.5);
      }
    }
  }
  CHECK(traced > 36);
}

TEST_CASE("far objects: a light beyond reach shines from its direction") {
  const std::string ball = kView + "am .1 .1 .1 b 0 0 0 f .8 .3 .2 .8 .1 10 0 1\ns 0 0 0 1\n";
  for (const char* far : {"1e25", "1e60", "1e100"}) {
    const std::string f = far;
    CHECK(difference(ball + "l 1e9 -1e9 1e9\n", ball + "l " + f + " -" + f + " " + f + "\n").pixels == 0);
  }
  CHECK(light_in_reach(Vec3d(3e200, 0, -3e200), 1e200) == Vec3d(kFarthestLight, 0, -kFarthestLight));
  CHECK(light_in_reach(Vec3d(3, 4, 5), 2) == Vec3d(6, 8, 10));
}

}  // namespace pprt::far_objects_test
