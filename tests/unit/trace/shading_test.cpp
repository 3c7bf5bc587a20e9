#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "spd/spd.h"
#include "unit/trace/test_scenes.h"

namespace pprt::shading_test {

using namespace pprt::test;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

// Ambient light reflected by a white surface under n lights.
double ambient(int lights) {
  return 0.1 * 0.5 / std::sqrt(lights);
}

Material colored(double r, double g, double b) {
  Material material;
  material.color = {r, g, b};
  return material;
}

// A view of the origin from above, `degrees` away from the vertical.
View slanted(double degrees, double distance = 10) {
  View view = view_from({distance * std::sin(degrees * kDegree), 0, distance * std::cos(degrees * kDegree)},
                        {0, 0, 0});
  return view;
}

}  // namespace

TEST_CASE("Lambert shading multiplies Kd, colour, cosine and light, and adds the ambient term") {
  Material material = colored(1, 0.5, 0.25);
  material.diffuse = 0.8;
  SceneDescription scene = scene_with(material, {{0, 0, 1000}});
  add_square(scene, 1, 0);
  const Color one = look(compile(scene), *scene.view).color;
  CHECK(one.x == Approx(ambient(1) + 0.8 * 0.5));
  CHECK(one.y == Approx(0.5 * (ambient(1) + 0.8 * 0.5)));
  CHECK(one.z == Approx(0.25 * (ambient(1) + 0.8 * 0.5)));

  scene.lights.push_back({{1000, 0, 1000}, Rgb(1, 0, 0), {}});
  const Color two = look(compile(scene), *scene.view).color;
  const double weight = 0.5 / std::sqrt(2);
  CHECK(two.x == Approx(ambient(2) + 0.8 * weight * (1 + std::sqrt(0.5))).epsilon(1e-5));
  CHECK(two.y == Approx(0.5 * (ambient(2) + 0.8 * weight)).epsilon(1e-5));
}

TEST_CASE("shadows are hard, and cast no ray towards a light behind the surface") {
  SceneDescription scene = scene_with(Material(), {{0, 0, 10}});
  add_square(scene, 5, 0);
  add_sphere(scene, {{0, 0, 5}, 1, 0, {}});
  const CompiledScene compiled = compile(scene);
  CHECK(look(compiled, view_from({8, 0, 3}, {0, 0, 0})).color.x == Approx(ambient(1)));
  CHECK(look(compiled, view_from({8, 0, 3}, {4.5, 0, 0})).color.x > 2 * ambient(1));
  // From below the light is behind the face turned to the eye.
  Tracer below(compiled, compiled.camera(view_from({0, 0, -8}, {3, 0, 0})));
  CHECK(below.trace(32, 32).color.x == Approx(ambient(1)));
  CHECK(below.counts().shadow == 0);
}

TEST_CASE("what lies beyond a light casts no shadow") {
  SceneDescription scene = scene_with(Material(), {{0, 0, 2}});
  add_square(scene, 5, 0);
  add_square(scene, 5, 3);
  CHECK(look(compile(scene), view_from({0.5, 0, 1}, {0, 0, 0})).color.x ==
        Approx(ambient(1) + 0.5).epsilon(1e-5));
}

TEST_CASE("a Phong highlight is white and weighs Ks, and is skipped where it would sparkle") {
  Material material = colored(0, 0, 0);
  material.specular = 0.4;
  material.shine = 20;
  SceneDescription scene = scene_with(material, {{0, 0, 1000}});
  add_square(scene, 1, 0);
  CompileOptions options;
  options.effects = parse_effects("highlights");
  CHECK(look(compile(scene, options), slanted(0.001)).color.y == Approx(0.4 * 0.5).epsilon(1e-5));
  CHECK(look(compile(scene, options), slanted(20)).color.y ==
        Approx(0.4 * 0.5 * std::pow(std::cos(20 * kDegree), 20)).epsilon(1e-4));
  CHECK(look(compile(scene, options), slanted(20)).eye_dependent);
  for (const double shine : {0.0, 100000.0}) {
    scene.materials[0].shine = shine;
    CHECK(look(compile(scene, options), slanted(0.001)).color.y == 0);
    CHECK_FALSE(compile(scene).effects().has(Effect::kHighlights));
  }
}

TEST_CASE("a mirror shows what is there, weighed by Ks, and the background beyond") {
  Material mirror = colored(0, 0, 0);
  mirror.specular = 0.5;
  SceneDescription scene = scene_with(mirror);
  scene.lights.clear();
  scene.background = Rgb(0, 0, 1);
  scene.materials.push_back(colored(1, 0, 0));
  add_square(scene, 2, 0);
  add_sphere(scene, {{-3, 0, 3}, 0.5, 1, {}});
  const Color ball = look(compile(scene), slanted(45)).color;
  CHECK(ball.x == Approx(0.5 * ambient(1)));
  CHECK(ball.z == 0);
  const Color sky = look(compile(scene), slanted(10)).color;
  CHECK(sky.x == 0);
  CHECK(sky.z == Approx(0.5));
}

TEST_CASE("two facing mirrors reflect as deep as allowed") {
  Material mirror;
  mirror.specular = 1;
  SceneDescription scene = scene_with(mirror);
  scene.lights.clear();
  add_square(scene, 1, -1);
  add_square(scene, 1, 1);
  for (int depth = 1; depth <= 6; ++depth) {
    CompileOptions options;
    options.max_depth = depth;
    const RaySample sample = look(compile(scene, options), view_from({0, 0, 0}, {0, 0.001, 1}));
    CHECK(sample.rays == static_cast<unsigned>(depth));
    CHECK(sample.color.x == Approx(depth * ambient(1)));
  }
}

TEST_CASE("refraction bends by Snell's law, both ways, and a meaningless index bends nothing") {
  Material glass = colored(0, 0, 0);
  glass.transmittance = 1;
  glass.refractive_index = 1.5;
  const auto seen = [&](double from_degrees, bool from_below, double to_degrees, double index) {
    SceneDescription scene = scene_with(glass);
    scene.lights.clear();
    scene.materials[0].refractive_index = index;
    scene.materials.push_back(colored(1, 0, 0));
    add_square(scene, 3, 0);
    // A small ball where the bent ray should go.
    const double side = from_below ? 1 : -1;
    add_sphere(
        scene,
        {{-3 * std::sin(to_degrees * kDegree), 0, side * 3 * std::cos(to_degrees * kDegree)}, 0.01, 1, {}});
    View view = slanted(from_degrees);
    if (from_below) view.from.z = -view.from.z;
    return look(compile(scene), view).color.x > 0;
  };
  const double inside = std::asin(std::sin(40 * kDegree) / 1.5) / kDegree;
  CHECK(seen(40, false, inside, 1.5));
  CHECK_FALSE(seen(40, false, 40, 1.5));
  CHECK(seen(inside, true, 40, 1.5));
  CHECK(seen(40, false, 40, 1));
  CHECK(seen(40, false, 40, 0));
  CHECK(seen(40, true, 40, -1));
}

TEST_CASE("beyond the critical angle nothing is refracted") {
  Material glass = colored(1, 1, 1);
  glass.transmittance = 1;
  glass.refractive_index = 1.5;
  SceneDescription scene = scene_with(glass);
  scene.lights.clear();
  scene.background = Rgb(1, 1, 1);
  add_square(scene, 3, 0);
  const CompiledScene compiled = compile(scene);
  const auto counts = [&](double degrees) {
    View view = slanted(degrees);
    view.from.z = -view.from.z;
    Tracer tracer(compiled, compiled.camera(view));
    tracer.trace(32, 32);
    return tracer.counts();
  };
  CHECK(counts(41.7).refraction == 1);  // the critical angle is 41.81 degrees
  CHECK(counts(41.7).total_internal_reflection == 0);
  CHECK(counts(41.9).refraction == 0);
  CHECK(counts(41.9).total_internal_reflection == 1);
}

TEST_CASE("a patch is shaded by its interpolated normals, whichever way they point") {
  for (const double sign : {1.0, -1.0}) {
    SceneDescription scene = scene_with(Material(), {{0, 0, 1e6}});
    const Vec3d tilted(std::sin(60 * kDegree), 0, std::cos(60 * kDegree));
    std::vector<PatchVertex> corners = {
        {{-1, -1, 0}, {0, 0, 0}}, {{1, -1, 0}, {0, 0, 0}}, {{1, 1, 0}, {0, 0, 0}}, {{-1, 1, 0}, {0, 0, 0}}};
    for (PatchVertex& v : corners) v.normal = tilted * (3 * sign);
    add_patch(scene, corners, 0);
    CHECK(look(compile(scene), *scene.view).color.x == Approx(ambient(1) + 0.5 * 0.5).epsilon(1e-5));
    CompileOptions flat;
    flat.effects = parse_effects("shadows");
    CHECK(look(compile(scene, flat), *scene.view).color.x == Approx(ambient(1) + 0.5).epsilon(1e-5));
  }
}

TEST_CASE("normals of no length leave the patch flat") {
  SceneDescription scene = scene_with(Material(), {{0, 0, 1e6}});
  const PatchVertex corners[] = {{{-1, -1, 0}, {0, 0, 0}}, {{1, -1, 0}, {0, 0, 0}}, {{0, 1, 0}, {0, 0, 0}}};
  add_patch(scene, corners, 0);
  CHECK(look(compile(scene), *scene.view).color.x == Approx(ambient(1) + 0.5).epsilon(1e-5));
}

TEST_CASE("a mirror patch never reflects through itself") {
  Material mirror = colored(0, 0, 0);
  mirror.specular = 1;
  SceneDescription scene = scene_with(mirror);
  scene.lights.clear();
  scene.background = Rgb(0, 0, 1);
  scene.materials.push_back(colored(1, 0, 0));
  std::vector<PatchVertex> corners = {
      {{-1, -1, 0}, {0, 0, 0}}, {{1, -1, 0}, {0, 0, 0}}, {{0, 1, 0}, {0, 0, 0}}};
  for (PatchVertex& v : corners) v.normal = {-1, 0, 0.3};
  add_patch(scene, corners, 0);
  add_sphere(scene, {{0, 0, -6}, 5, 1, {}});  // fills everything below
  const RaySample sample = look(compile(scene), slanted(80));
  CHECK(sample.color.z == Approx(1));
  CHECK(sample.color.x == 0);
}

TEST_CASE("colours are not clamped, and every sample of every database is finite") {
  Material bright = colored(1, 1, 1);
  bright.diffuse = 10;
  SceneDescription scene = scene_with(bright, {{0, 0, 100}});
  add_square(scene, 1, 0);
  CHECK(look(compile(scene), *scene.view).color.x == Approx(5 + ambient(1)));
  for (const char* name :
       {"tree", "balls", "gears", "mount", "rings", "tetra", "teapot", "jacks", "lattice"}) {
    const SceneDescription database = make_spd(name, 2);
    const CompiledScene compiled = compile(database);
    View view = *database.view;
    view.width = view.height = 60;
    Tracer tracer(compiled, compiled.camera(view));
    for (int y = 0; y < 60; ++y) {
      for (int x = 0; x < 60; ++x) {
        const Color c = tracer.trace(x + 0.5, y + 0.5).color;
        REQUIRE((std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z)));
      }
    }
  }
}

TEST_CASE("only what shines, mirrors or transmits depends on the eye") {
  SceneDescription scene = scene_with(Material());
  add_square(scene, 1, 0);
  CHECK_FALSE(look(compile(scene), *scene.view).eye_dependent);
  scene.materials[0].specular = 0.1;
  CHECK(look(compile(scene), *scene.view).eye_dependent);
  CompileOptions none;
  none.effects = EffectSet();
  CHECK_FALSE(look(compile(scene, none), *scene.view).eye_dependent);
  scene.materials[0].specular = 0;
  scene.materials[0].transmittance = 0.1;
  CHECK(look(compile(scene), *scene.view).eye_dependent);
}

// A ball of few triangles has the ball's normals and one light from the side. What the smooth surface shows
// to the light is lit, up to a facet's width from its terminator.
TEST_CASE("shading: facets hide no light from the smooth surface that their normals describe") {
  constexpr int kSides = 12, kRings = 6;
  Material matte;
  matte.color = Rgb(1, 1, 1), matte.diffuse = 1;
  const Vec3d light(60, 30, 0), to_light = light.normalized();
  for (const double side : {1.0, -1.0}) {  // normals outwards, or inwards with the same faces
    SceneDescription scene = scene_with(matte, {light});
    const auto vertex = [](int ring, int k) {
      const double polar = std::numbers::pi * ring / kRings, turn = 2 * std::numbers::pi * k / kSides;
      return Vec3d(std::sin(polar) * std::cos(turn), std::cos(polar), std::sin(polar) * std::sin(turn));
    };
    const auto facet = [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
      const std::array<PatchVertex, 3> corners = {PatchVertex{a, a * side}, {b, b * side}, {c, c * side}};
      add_patch(scene, corners, 0, {});
    };
    for (int ring = 0; ring < kRings; ++ring) {
      for (int k = 0; k < kSides; ++k) {
        if (ring > 0) facet(vertex(ring, k), vertex(ring, k + 1), vertex(ring + 1, k));
        if (ring + 1 < kRings) facet(vertex(ring, k + 1), vertex(ring + 1, k + 1), vertex(ring + 1, k));
      }
    }
    const CompiledScene compiled = compile(scene);
    const Camera camera = compiled.camera(view_from({0, 0, 10}, {0, 0, 0}, 13, 64));
    Tracer tracer(compiled, camera);
    int near_terminator = 0, dark = 0, lit_behind = 0;
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x) {
        const RaySample sample = tracer.trace(x + 0.5, y + 0.5);
        if (sample.at_infinity) continue;
        const double cosine = Vec3d(tracer.first_hit(x + 0.5, y + 0.5).normal).dot(to_light);
        const bool is_lit = (sample.lights.seen & 1) != 0;
        if (cosine > 0.02 && cosine < 0.5) ++near_terminator, dark += !is_lit;
        if (cosine < 0) lit_behind += is_lit;
      }
    }
    INFO(near_terminator << " near the terminator, " << dark << " of them dark");
    CHECK(near_terminator > 300);
    CHECK(dark == 0);
    CHECK(lit_behind == 0);
  }
}

TEST_CASE("what gives off light adds it, also in a mirror, and costs no ray") {
  Material lamp = colored(0.5, 0.5, 0.5);
  lamp.emission = {0.25, 0.5, 3};
  SceneDescription scene = scene_with(lamp, {{0, 0, 1000}});
  add_square(scene, 1, 0);
  const CompiledScene compiled = compile(scene);
  Tracer tracer(compiled, compiled.camera(*scene.view));
  const RaySample seen = tracer.trace(32, 32);
  const double lit = 0.5 * (ambient(1) + 0.5);
  CHECK(seen.color.x == Approx(lit + 0.25));
  CHECK(seen.color.z == Approx(lit + 3));
  CHECK((seen.rays == 2 && !seen.eye_dependent));  // as without: the eye ray and the shadow ray

  Material mirror = colored(0, 0, 0);
  mirror.specular = 0.5;
  scene.materials.push_back(mirror);
  scene.lights.clear();
  add_square(scene, 2, -1, 1);
  View below = view_from({1.8, 0, -0.5}, {1.4, 0, -1});  // by the mirror to the lamp's back
  CHECK(look(compile(scene), below).color.z == Approx(0.5 * (0.5 * ambient(1) + 3)));
  CompileOptions without;
  without.effects = parse_effects("reflection");
  CHECK(look(compile(scene, without), below).color.z == Approx(0.5 * 0.5 * ambient(1)));
}

TEST_CASE("a sun shines along one direction everywhere, and what is between hides it") {
  SceneDescription scene = scene_with(Material(), {});
  scene.lights = {{{3, 0, 4}, Rgb(1, 0.5, 0), {}, true}};
  add_square(scene, 1000, 0);
  add_sphere(scene, {{6, 0, 8}, 1, 0, {}});
  const CompiledScene compiled = compile(scene);
  for (const double x : {-500.0, 20.0, 900.0}) {
    const Color color = look(compiled, view_from({x, 0, 2}, {x + 1, 0, 0})).color;
    CHECK(color.x == Approx(ambient(1) + 0.5 * 0.8).epsilon(1e-6));
    CHECK(color.y == Approx(ambient(1) + 0.5 * 0.5 * 0.8).epsilon(1e-6));
  }
  CHECK(look(compiled, view_from({1, 0, 2}, {0, 0, 0})).color.x == Approx(ambient(1)));  // the ball's shadow
  scene.lights[0].is_sun = false;  // the control: a light in that place
  CHECK(look(compile(scene), view_from({-500, 0, 2}, {-499, 0, 0})).color.x < 0.1);
  CHECK_THAT(compiled.census(), Catch::Contains("lights      1, of them 1 sun\n"));
}

TEST_CASE("a sky runs from the horizon to the zenith, and mirrors show it") {
  Material mirror = colored(0, 0, 0);
  mirror.specular = 0.5;
  SceneDescription scene = scene_with(mirror);
  scene.lights.clear();
  scene.background = Rgb(0.25, 0, 0);
  scene.sky = Sky{.up = {0, 0, 5}, .horizon = {0, 1, 0}, .zenith = {0, 0, 1}};
  add_square(scene, 1, 0);
  const CompiledScene compiled = compile(scene);
  const auto seen = [&](const Vec3d& direction) {
    return look(compiled, view_from({5, 5, 5}, Vec3d(5, 5, 5) + direction)).color;
  };
  for (const double degrees : {1.0, 30.0, 85.0}) {
    const double sine = std::sin(degrees * kDegree);
    const Color color = seen({std::cos(degrees * kDegree), 0, sine});
    CHECK(color.y == Approx(1 - sine).margin(1e-5));
    CHECK(color.z == Approx(sine).margin(1e-5));
  }
  CHECK(seen({1, 0, -0.01}) == Color(0.25, 0, 0));
  CHECK(look(compiled, slanted(60)).color.z == Approx(0.5 * 0.5).epsilon(1e-5));  // 30 degrees up
  CompileOptions without;
  without.effects = parse_effects("reflection");
  CHECK(look(compile(scene, without), slanted(60)).color == Color(0.125, 0, 0));
  CHECK_FALSE(look(compiled, view_from({5, 5, 5}, {5, 6, 6})).eye_dependent);
}

}  // namespace pprt::shading_test
