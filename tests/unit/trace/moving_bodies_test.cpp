// Bodies that move are instances of one hierarchy: every picture must be that of the scene at rest at that
// time, built anew.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "parser/aff_parser.h"
#include "scene/animation/resting_nodes.h"
#include "unit/trace/test_scenes.h"

namespace pprt::moving_bodies_test {

using namespace pprt::test;

namespace {

constexpr int kSize = 48;
constexpr std::uint32_t kFloorTriangles = 2;

SceneDescription scene_of(const std::string& text) {
  return without_resting_nodes(parse_aff(text, "m.aff").scene);
}

const std::string kView = "v from 0 3 12 at 0 1 0 up 0 1 0 angle 30 hither 1 resolution 48 48\n";
const std::string kLight = "am 1 1 1 b .1 .2 .3 l 5 9 8 .8 .7 .6 l -6 7 9 .3 .3 .4\n";
const std::string kGround = "p 4 -9 -.5 -9 -9 -.5 9 9 -.5 9 9 -.5 -9\n";
const std::string kFloor = "fm .1 .1 .1 .5 .6 .5 .2 .2 .3 20 0 1\n" + kGround;
const std::string kMatte = "fm .1 0 0 .8 .2 .1 0 0 0 0 0 1\n";
const std::string kMirror = "fm 0 0 .1 .2 .2 .5 .3 .2 .1 30 0 1\n";
const std::string kGlass = "fm 0 0 0 .1 .1 .1 .2 .2 .2 50 .7 1.3\n";
const std::string kBall = "s 0 1 0 1\n";
const std::string kCone = "c 0 -.5 0 1 0 2 0 .4\n";
const std::string kPatch = "pp 3 -1 0 0 -.3 0 1 1 0 0 .3 0 1 0 2 0 0 .2 1\n";
// A tetrahedron, its faces outwards.
const std::string kSolid =
    "m vertices 4 -1 0 1 1 0 1 0 0 -1 0 1.6 0\n"
    "triangles 4 0 2 1 0 1 3 1 2 3 2 0 3\n";

// A track whose keys lie at times 0 to 4 and whose curve runs from 1 to 3.
std::string keys(const std::string& kind, const std::string& values, int step) {
  std::string text = kind + " 5";
  for (int i = 0; i < 5; ++i) {
    std::string row = values;
    const std::string place = std::to_string(step * i);
    for (std::size_t at; (at = row.find('@')) != std::string::npos;) row.replace(at, 1, place);
    text += " " + std::to_string(i) + " " + row + " 0 0 0";
  }
  return text + "\n";
}

std::string moving(const std::string& objects, const std::string& tracks) {
  return kView + kLight + kFloor + "a 1 3 9 x body {" + objects + "} k body {" + tracks + "}";
}

// Pixels whose colours differ by more than rounding.
int differing(const Tracer& like, Tracer& a, Tracer& b, double tolerance = 2e-3) {
  int count = 0;
  for (int y = 0; y < like.camera().height; ++y) {
    for (int x = 0; x < like.camera().width; ++x) {
      const Color one = a.trace(x + 0.5, y + 0.5).color, other = b.trace(x + 0.5, y + 0.5).color;
      const Color d = one - other;
      count += std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) > tolerance;
    }
  }
  return count;
}

// Compares the pose at a time with the scene built for that time. `other_time`: control.
void check_pose(const SceneDescription& scene, double time, double other_time, int edges = 6) {
  const CompiledScene moves = compile(scene);
  REQUIRE(moves.moves());
  const CompiledScene rests = compile(still_at(scene, time));
  const View view = *view_at(scene, time);
  Tracer a(moves, moves.camera(view)), b(rests, rests.camera(view));
  a.set_time(time);
  CHECK(differing(a, a, b) <= edges);
  a.set_time(other_time);
  CHECK(differing(a, a, b) > 10 * edges);
  a.set_time(time);
  CHECK(differing(a, a, b) <= edges);
}

}  // namespace

TEST_CASE("moving bodies: every kind of object, every transform: as the scene built at that time") {
  struct Case {
    std::string name, objects, tracks;
  };
  const std::string shift = keys("transl", "@ .2 -@", 1);
  const std::string turn = keys("rot", ".3 1 .2 @", 70);
  const std::string stretch = keys("scale", "1 1.@ .8", 1);
  const std::string mirror = keys("scale", "-1 1.@ 1", 2);
  const std::vector<Case> cases = {
      {"a sphere that is shifted", kMatte + kBall, shift},
      {"a cone that turns", kMirror + kCone, turn},
      {"a cone that is stretched and turns", kMirror + kCone, turn + stretch},
      {"a sphere that is stretched", kMirror + kBall, stretch + shift},
      {"a patch that turns", kMirror + kPatch, turn + shift},
      {"a solid that is mirrored", kMatte + kSolid, mirror + shift},
      {"a glass solid that turns", kGlass + kSolid, turn + shift},
      {"a glass solid that is mirrored", kGlass + kSolid, mirror + shift},
      {"a glass ball", kGlass + kBall, shift},
  };
  for (const Case& c : cases) {
    INFO(c.name);
    for (const double time : {1.3, 2.0, 2.9})
      check_pose(scene_of(moving(c.objects, c.tracks)), time, time < 2 ? 3 : 1);
  }
}

TEST_CASE("moving bodies: nodes within nodes, and resting ones between them") {
  const std::string text = kView + kLight + kFloor + "a 1 3 9 x outer { xs 1 .5 1 0 0 1 30 0 1 0 {" +
                           kMirror + "x inner {" + kBall + kSolid + "} s 2 0 0 .4 } } k outer {" +
                           keys("rot", "0 1 0 @", 50) + "} k inner {" + keys("transl", ".@ 0 .@", 2) + "}";
  check_pose(scene_of(text), 1.7, 3);
}

TEST_CASE("moving bodies: triangles that change their shape, also within what moves") {
  const std::string cloth = kMirror +
                            "tpa 3 1 -1 0 0 0 0 1 1 0 0 0 0 1 0 2 0 0 0 1\n"
                            "2 -1 0 0 0 .3 1 1 0 2 0 0 1 0 1 1 0 0 1\n"
                            "3 -2 0 0 0 0 1 1 1 0 .2 0 1 0 2 0 0 0 1\n";
  check_pose(scene_of(kView + kLight + kFloor + "a 1 3 9 " + cloth), 1.6, 2.6);
  check_pose(scene_of(moving(cloth, keys("transl", ".@ 0 0", 2))), 2.3, 1);
}

TEST_CASE("moving bodies: lights move with their node, or by a track of their own") {
  const std::string lamp = "la lamp 0 9 0 .8 .8 .8 k lamp {" + keys("transl", "@ 5 4", 2) + "}";
  const std::string carried = "x body { l 0 5 4 .8 .8 .8 } k body {" + keys("transl", "-@ 0 0", 2) + "}";
  for (const std::string& light : {lamp, carried})
    check_pose(scene_of(kView + "am 1 1 1 a 1 3 9 " + kFloor + kMatte + kBall + light), 1.5, 3);
}

TEST_CASE("moving bodies: a sun turns with its node and does not move with it") {
  const std::string sun = "x body { ls .5 1 .3 .8 .7 .6 }";
  const SceneDescription scene =
      scene_of(kView + "am 1 1 1 a 1 3 9 " + kFloor + kMatte + kBall + sun + " k body {" +
               keys("rot", "0 0 1 @", 20) + keys("transl", "@ 0 0", 50) + "}");
  check_pose(scene, 1.5, 3);
  const Light still = still_at(scene, 2).lights.at(0);
  CHECK(still.is_sun);
  CHECK(still.position.length() == Approx(Vec3d(.5, 1, .3).length()));  // at 100 along x
  const Light sun_alone{.position = {0, 2, 0}, .is_sun = true};
  for (const double scale : {0.0, HUGE_VAL, 1e-320}) {  // no map takes it its direction
    const Vec3d direction = place_of(sun_alone, scaling({scale, scale, scale}));
    CHECK((direction.x == 0 && direction.y > 0 && direction.y < 3));
  }
}

TEST_CASE("moving bodies: what is hidden, or flattened, does not show and casts no shadow") {
  const std::string hidden = moving(kMatte + kBall, "visibility 2 0 1 2 0");
  check_pose(scene_of(hidden), 2.5, 1.5);
  const SceneDescription flat = scene_of(moving(kMatte + kSolid, keys("scale", "1 0 1", 0)));
  const SceneDescription empty = scene_of(kView + kLight + kFloor);
  const CompiledScene a = compile(flat), b = compile(empty);
  Tracer with(a, a.camera(*flat.view)), without(b, b.camera(*flat.view));
  with.set_time(2);
  CHECK(differing(with, with, without) == 0);
}

TEST_CASE("moving bodies: far away, tiny, and turned by a whole turn") {
  // The whole scene a million away, eye and light too: only the body is mapped there.
  const auto far_scene = [](const std::string& tracks) {
    return scene_of("v from 1e6 3 12 at 1e6 1 0 up 0 1 0 angle 30 hither 1 resolution 48 48\n" +
                    ("am 1 1 1 l 1000005 9 8 a 1 3 9 x body {" + kMirror + kBall + kSolid + "} k body {") +
                    tracks + "}");
  };
  std::string far_keys = "transl 5";
  for (int i = 0; i < 5; ++i)
    far_keys += " " + std::to_string(i) + " " + std::to_string(1000000 + i) + " 0 0 0 0 0";
  check_pose(far_scene(far_keys), 2.2, 1);

  // A millionth of the size, seen from as near.
  const std::string tiny =
      "v from 0 0 12e-6 at 0 1e-6 0 up 0 1 0 angle 30 hither 1 resolution 48 48\n" +
      ("am 1 1 1 l 5e-6 9e-6 8e-6 a 1 3 9 x body {" + kMirror + kBall + kSolid + "} k body {") +
      keys("scale", "1e-6 1e-6 1e-6", 0) + keys("rot", "0 1 0 @", 40) + "}";
  check_pose(scene_of(tiny), 1.4, 3, 3);

  const std::string turned = moving(kMirror + kSolid, keys("rot", "0 1 0 @", 360));
  const SceneDescription scene = scene_of(turned);
  const CompiledScene compiled = compile(scene);
  Tracer a(compiled, compiled.camera(*scene.view)), b(compiled, compiled.camera(*scene.view));
  a.set_time(1), b.set_time(2);
  CHECK(differing(a, a, b) <= 6);
  b.set_time(3);
  CHECK(differing(a, a, b) <= 6);
}

TEST_CASE("moving bodies: rays leave them and never meet them again") {
  // Convex, so that no point can shade another; many lights, some of which graze.
  std::string lights;
  for (int i = 0; i < 60; ++i) {
    const double angle = i * 2.399963, height = 1 - (2 * i + 1) / 60.0, r = std::sqrt(1 - height * height);
    lights += "l " + std::to_string(40 * r * std::cos(angle)) + " " + std::to_string(40 * height) + " " +
              std::to_string(40 * r * std::sin(angle)) + "\n";
  }
  const std::vector<std::string> tracks = {
      keys("rot", ".3 1 .2 @", 77),
      keys("scale", "1 .3 2", 0) + keys("rot", "1 .2 .4 @", 77),
      keys("scale", ".01 .01 .01", 0) + keys("transl", "3 .@ 2", 1) + keys("rot", "1 .2 .4 @", 77),
      keys("scale", "-1 1 1", 0) + keys("rot", "1 .2 .4 @", 77),
      keys("scale", ".02 .002 .01", 0) + keys("transl", "3 .@ 2", 1) + keys("rot", "1 .2 .4 @", 77),
  };
  for (const std::string& object : {kBall, kSolid}) {
    for (const std::string& track : tracks) {
      const SceneDescription scene = scene_of(kView + "am 1 1 1 " + lights + "a 1 3 9 x body {" + kMatte +
                                              object + "} k body {" + track + "} s 5 -1 -4 .5");
      CompileOptions without;
      without.effects = parse_effects("smooth-normals");
      const CompiledScene shadowed = compile(scene), plain = compile(scene, without);
      for (const double time : {1.1, 1.9, 2.7}) {
        const Affine place = placements_at(scene.movement, time).back().to_parent;
        View view = view_from(place.point({0, 1, 0}) + Vec3d(0, 2, 9) * place.y.length(),
                              place.point({0, 1, 0}), 25, kSize);
        Tracer a(shadowed, shadowed.camera(view)), b(plain, plain.camera(view));
        a.set_time(time), b.set_time(time);
        int hits = 0, dark = 0;
        for (int i = 0; i < kSize * kSize; ++i) {
          const double x = i % kSize + 0.5, y = i / kSize + 0.5;
          const RaySample with = a.trace(x, y), sans = b.trace(x, y);
          const bool on_body = with.primitive > 0 && with.primitive < scene.order.size();
          hits += on_body;
          dark += on_body && with.color != sans.color;
        }
        INFO(object << track << time);
        CHECK(hits > 100);
        CHECK(dark == 0);
      }
    }
  }
}

TEST_CASE("moving bodies: a sample moves with its object") {
  const SceneDescription scene =
      scene_of(moving(kMatte + kSolid, keys("transl", ".@ 0 0", 4) + keys("rot", "0 1 0 @", 20)));
  const CompiledScene compiled = compile(scene);
  Tracer tracer(compiled, compiled.camera(*scene.view));
  int carried = 0;
  for (int i = 0; i < kSize * kSize; i += 7) {
    tracer.set_time(1.5);
    RaySample sample = tracer.trace(i % kSize + 0.5, i / kSize + 0.5);
    if (sample.primitive <= kFloorTriangles) continue;
    const Vec3f before = sample.hit;
    tracer.set_time(1.75);
    REQUIRE(tracer.carry(sample) == Carried::kKept);
    CHECK(sample.hit != before);
    CHECK(sample.lights.asked == 0);  // it has turned towards them
    CHECK(sample.eye_dependent);
    const auto point = project(tracer.camera(), Vec3d(sample.hit) - tracer.camera().eye);
    REQUIRE(point);
    // What is seen there is the point itself, or hides it.
    const RaySample there = tracer.trace(point->x, point->y);
    const bool is_seen = tracer.visible(sample.hit, false);
    if (is_seen && there.primitive == sample.primitive) {
      CHECK((there.hit - sample.hit).length() < 1e-5);
      ++carried;
    }
    CHECK((is_seen || there.primitive != 0));
  }
  CHECK(carried > 10);
}

TEST_CASE("moving bodies: a sample forgets the lights that something moving may have hidden, and no others") {
  // A light on either side; a ball passes between the floor and the first.
  const std::string text =
      "v from 0 8 8 at 0 0 0 up 0 1 0 angle 40 hither 1 resolution 48 48 am 1 1 1 l -4 6 0 l 4 6 0 a 1 3 "
      "9\n" +
      kMatte + kGround + "x body { s 0 0 0 .5 } k body {" + keys("transl", "-3 3.@ 0", 1) + "}";
  const SceneDescription scene = scene_of(text);
  const CompiledScene compiled = compile(scene);
  Tracer tracer(compiled, compiled.camera(*scene.view));
  tracer.set_time(1);
  const auto floor_at = [&](const Vec3d& p) {
    RaySample sample = tracer.trace(24, 24);
    const SceneDescription at_rest = still_at(scene, 1);
    View view = *scene.view;
    view.at = p;
    tracer.set_camera(compiled.camera(view));
    sample = tracer.trace(24, 24);
    tracer.set_camera(compiled.camera(*scene.view));
    return sample;
  };
  RaySample below = floor_at({-2.4, -.5, 0}), aside = floor_at({3.5, -.5, 2});
  REQUIRE((below.primitive <= kFloorTriangles && aside.primitive <= kFloorTriangles));
  REQUIRE((below.lights.asked == 3 && aside.lights.asked == 3));
  const SeenLights known = aside.lights;
  tracer.set_time(2);
  CHECK(tracer.carry(below) == Carried::kRelit);
  CHECK(below.lights.asked == 2);
  CHECK(tracer.carry(aside) == Carried::kKept);
  CHECK((aside.lights.asked == known.asked && aside.lights.seen == known.seen));
  CHECK_FALSE(aside.eye_dependent);
  // Nothing has moved since: all is kept.
  tracer.set_time(2);
  RaySample again = floor_at({-2.4, -.5, 0});
  CHECK((tracer.carry(again) == Carried::kKept && again.lights.asked == 3));
}

TEST_CASE("moving bodies: a sample is no more where its object is hidden or has changed its shape") {
  const SceneDescription hidden = scene_of(moving(kMatte + kBall, "visibility 2 0 1 2 0"));
  const SceneDescription deforms =
      scene_of(kView + kLight + "a 1 3 9 " + kMatte +
               "tpa 2 1 -1 0 0 0 0 1 1 0 0 0 0 1 0 2 0 0 0 1 3 -1 0 0 0 0 1 1 0 1 0 0 1 0 2 0 0 0 1");
  for (const SceneDescription* scene : {&hidden, &deforms}) {
    const CompiledScene compiled = compile(*scene);
    Tracer tracer(compiled, compiled.camera(*scene->view));
    tracer.set_time(1.5);
    RaySample sample = tracer.trace(24, 24);
    REQUIRE(sample.primitive == scene->order.size());
    tracer.set_time(2.5);
    CHECK(tracer.carry(sample) == Carried::kNothing);
  }
}

TEST_CASE("moving bodies: projected shapes cover what eye rays hit") {
  const std::string stretched = keys("scale", "1 .5 1.5", 0) + keys("rot", ".2 1 .3 @", 50);
  for (const std::string& object : {kBall, kCone, kSolid, kPatch}) {
    const SceneDescription scene = scene_of(kView + kLight + "a 1 3 9 s 9 0 -5 .5 x body {" + kMatte +
                                            object + "} k body {" + stretched + "}");
    const CompiledScene compiled = compile(scene);
    Tracer tracer(compiled, compiled.camera(*scene.view));
    tracer.set_time(1.6);
    int hits = 0;
    for (int i = 0; i < kSize * kSize; ++i) {
      const double x = i % kSize + 0.5, y = i / kSize + 0.5;
      const RaySample sample = tracer.trace(x, y);
      if (sample.primitive < 2) continue;
      ++hits;
      ImageShape shape;
      tracer.project(sample.primitive, shape);
      std::array<ShapeBounds, 1> bounds;
      tracer.bound(sample.primitive - 1, bounds);
      const ImageBounds& box = bounds[0].box;
      CHECK((box.x0 <= x && x <= box.x1 && box.y0 <= y && y <= box.y1));
      CHECK(box.x1 - box.x0 < 2 * kSize);
      const double nearness = 1 / (Vec3d(sample.hit) - tracer.camera().eye).dot(tracer.camera().forward);
      if (shape.kind == ImageShape::Kind::kQuadric) {
        const double root = std::sqrt(std::max(0.0, shape.quadric.discriminant.at(x, y)));
        const double front = -shape.quadric.middle.at(x, y) + root,
                     back = -shape.quadric.middle.at(x, y) - root;
        CHECK(std::min(std::abs(front - nearness), std::abs(back - nearness)) < 1e-3 * nearness);
      } else {
        REQUIRE(shape.kind == ImageShape::Kind::kFacets);
        bool is_covered = false;
        for (const ImageFacet& f : shape.facets) {
          const bool inside =
              f.edges[0].at(x, y) > -1e-9 && f.edges[1].at(x, y) > -1e-9 && f.edges[2].at(x, y) > -1e-9;
          is_covered = is_covered || (inside && std::abs(f.nearness.at(x, y) - nearness) < 1e-3 * nearness);
        }
        CHECK(is_covered);
      }
    }
    CHECK(hits > 10);
  }
}

TEST_CASE("moving bodies: a body that is pressed flat does not let hidden points show") {
  const SceneDescription scene =
      scene_of(kView + kLight + kFloor + kMatte + "s 0 1 4 .8 xs 1 .02 1 0 0 1 0 5 0 -3 { s 0 0 0 1 }");
  const CompiledScene compiled = compile(scene);
  REQUIRE(compiled.moves());
  Tracer tracer(compiled, compiled.camera(*scene.view));
  View from_behind = *scene.view;
  from_behind.from = {0, 1, -6}, from_behind.at = {0, 1, 4};
  tracer.set_camera(compiled.camera(from_behind));
  const RaySample back = tracer.trace(24, 24);
  REQUIRE(back.primitive == kFloorTriangles + 1);
  CHECK(tracer.visible(back.hit, false));
  tracer.set_camera(compiled.camera(*scene.view));
  CHECK_FALSE(tracer.visible(back.hit, false));
}

TEST_CASE("moving bodies: colours under lights that no sample notes, and that move, are relit") {
  std::string lights;
  for (int i = 0; i < 8; ++i) lights += "l " + std::to_string(i) + " -5 0\n";  // below the floor
  const std::string ninth = "la lamp 0 4 0 k lamp {" + keys("transl", "@ 4 0", 1) + "}";
  const std::string ball = kMatte + "x body { s 0 0 0 2 } k body {" + keys("transl", "@ 3 0", 1) + "}";
  for (const bool light_moves : {true, false}) {
    const SceneDescription scene = scene_of(kView + "am 1 1 1 a 1 3 9 " + lights + kMatte + kGround +
                                            (light_moves ? ninth : "l 0 4 0\n" + ball));
    const CompiledScene compiled = compile(scene);
    Tracer tracer(compiled, compiled.camera(*scene.view));
    tracer.set_time(1);
    RaySample below = tracer.trace(24, 40);
    REQUIRE((below.primitive > 0 && below.primitive <= kFloorTriangles && below.lights.asked == 0));
    CHECK(tracer.set_time(2));
    CHECK(tracer.carry(below) == Carried::kRelit);
    CHECK_FALSE(tracer.set_time(2));
    RaySample again = tracer.trace(24, 40);
    CHECK(tracer.carry(again) == Carried::kKept);
  }
}

TEST_CASE(
    "moving bodies: textures are filtered over what a pixel covers of a body that is turned and stretched") {
  SceneDescription scene = scene_of(
      moving(kMatte + "tt t -2 0 0 0 0  2 0 0 9 0  2 2 0 9 9  tt t -2 0 0 0 0  2 2 0 9 9  -2 2 0 0 9\n",
             keys("rot", "0 1 0 @0", 1) + keys("scale", ".5 2 1", 1)));
  Texture& stripes = scene.textures.at(0);
  stripes = {"t", 32, 32, {}};
  for (int i = 0; i < 32 * 32; ++i) stripes.rgb.insert(stripes.rgb.end(), 3, (i / 3) % 2 == 0 ? 255 : 0);
  check_pose(scene, 2.5, 1);
}

TEST_CASE("moving bodies: triangles with a texture but without area make no parts of their own") {
  std::string text = kView + kLight + kMatte;
  for (int i = 0; i < 300; ++i) text += "tt t 0 0 0 0 0  1 1 1 0 0  2 2 2 " + std::to_string(i) + " 0\n";
  text += "tt t -1 0 0 0 0  1 0 0 1 0  0 2 0 0 1\n";
  const CompiledScene compiled = compile(scene_of(text));
  CHECK(compiled.census().find("301 triangles; 300 without extent left out") != std::string::npos);
}

// Embree's builder for scenes that change often ends the process where all that it is given is one point.
TEST_CASE("moving bodies: a scene that shrinks to a point is seen before and after, and harms nothing") {
  const std::string shrinks =
      "tpa 3 2 2 3.4e38 1 .5 -.25 1e-30 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 "
      "0 0 "
      "0 0 0 0 0 0 0 0 0 0 0 0 0 0\n";
  const std::string tiny = "p 4 1 3.5 .5 1e-45 0 .5 .5 0 .5 1e-30 .5 1e-30\n";
  for (const std::string& body : {shrinks, tiny + shrinks, shrinks + shrinks}) {
    const SceneDescription scene = scene_of(kView + kLight + kMatte + body);
    const CompiledScene compiled = compile(scene);
    Tracer tracer(compiled, compiled.camera(*scene.view));
    for (const double time : {0.0, 1.0, 2.0, 3.0, 0.0}) {
      CAPTURE(time);
      tracer.set_time(time);
      CHECK(std::isfinite(tracer.trace(kSize / 2.0, kSize / 2.0).color.x));
    }
  }
}

}  // namespace pprt::moving_bodies_test
