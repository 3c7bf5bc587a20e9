#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "spd/spd.h"
#include "unit/trace/test_scenes.h"

namespace pprt::image_shape_test {

using namespace pprt::test;

namespace {

// Returns the nearness of a shape at an image point, in double; 0 where it is not.
double nearness(const ImageFacet& f, double x, double y) {
  for (const LinearForm& edge : f.edges) {
    if (edge.at(x, y) < 0) return 0;
  }
  return f.nearness.at(x, y);
}

double nearness(const ImageQuadric& q, double x, double y) {
  const double discriminant = q.discriminant.at(x, y), middle = q.middle.at(x, y);
  if (discriminant < 0) return 0;
  const auto held = [&](double n) {
    const double height = q.height * n + q.along.at(x, y);
    return n > 0 && (!q.has_ends || (height >= 0 && height <= q.top * n)) ? n : 0.0;
  };
  const double root = std::sqrt(discriminant);
  const double front = q.front ? held(root - middle) : 0;
  return front > 0 ? front : q.back ? held(-root - middle) : 0;
}

double nearness(const ImageShape& shape, double x, double y) {
  if (shape.kind == ImageShape::Kind::kQuadric) return nearness(shape.quadric, x, y);
  double nearest = 0;
  for (const ImageFacet& f : shape.facets) nearest = std::max(nearest, nearness(f, x, y));
  return nearest;
}

// Returns how many random image points hit another primitive than the nearest shape there, or hit it at
// another depth. `shift` moves the shapes, pixels.
int wrong(const CompiledScene& scene, const View& view, int points, double shift = 0) {
  const Camera camera = scene.camera(view);
  Tracer tracer(scene, camera);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> place(0, view.width);
  std::vector<ImageShape> shapes;
  int wrong = 0;
  for (int i = 0; i < points; ++i) {
    const double x = place(random), y = place(random);
    const RaySample seen = tracer.trace(x, y);
    for (auto p = static_cast<std::uint32_t>(shapes.size()); p <= seen.primitive + 50; ++p) {
      shapes.emplace_back();
      if (p > 0) tracer.project(p, shapes.back());
    }
    std::uint32_t nearest = 0;
    double least = 0;
    for (std::uint32_t p = 1; p < shapes.size(); ++p) {
      const double n = nearness(shapes[p], x + shift, y);
      if (n > least) least = n, nearest = p;
    }
    const double depth = (Vec3d(seen.hit) - camera.eye).dot(camera.forward);
    wrong += nearest != seen.primitive ||
             (nearest != 0 && std::abs(least * depth - 1) > 1e-5 + 2e-7 / depth);  // hits are floats
  }
  return wrong;
}

View square(View view, int size) {
  view.width = view.height = size;
  return view;
}

SceneDescription all_kinds() {
  SceneDescription scene = scene_with(Material());
  add_square(scene, 6, -4);
  add_sphere(scene, {{-1.5, 1, 0}, 1, 0, {}});
  add_sphere(scene, {{-0.7, 1.2, 0.3}, 0.8, 0, {}});                // grown into the one before
  add_cone(scene, {{1, -2, 0}, 0.9, {2, 1, 1}, 0.2, 0, {}});        // tapered, open: its inside is seen
  add_cone(scene, {{-2, -2, 1}, 0.5, {-1, -1.5, -2}, 0.5, 0, {}});  // a cylinder
  const std::array<Vec3d, 5> arrow = {{{0, 0, 1}, {2, 2, 1}, {0, 1.2, 1}, {-2, 2.5, 1}, {-0.3, 0.4, 1}}};
  add_polygon(scene, arrow, 0);  // concave
  const std::array<Vec3d, 3> behind = {{{0, -1, -3}, {4, -3, 30}, {-4, -3, 30}}};
  add_polygon(scene, behind, 0);  // reaches behind the eye
  return scene;
}

}  // namespace

TEST_CASE("the nearest projected shape at an image point is what the eye ray hits, at the same depth") {
  const CompiledScene scene = compile(all_kinds());
  const View view = square(view_from({0, 0, 10}, {0, 0, 0}), 256);
  CHECK(wrong(scene, view, 20000) <= 2);      // float against double on an outline
  CHECK(wrong(scene, view, 20000, 1) > 500);  // a pixel beside it is another picture
}

TEST_CASE("shapes of the databases' primitives are what eye rays find") {
  for (const SceneDescription& scene :
       {make_spd("rings", 2), make_spd("gears", 1), make_spd("mount", 3), make_spd("tree", 4)}) {
    const CompiledScene compiled = compile(scene);
    CHECK(wrong(compiled, square(*scene.view, 300), 3000) <= 3);
  }
}

TEST_CASE("shapes stay where eye rays find them from far away and from just above a huge sphere") {
  SceneDescription far = all_kinds();
  const View view = square(view_from({2e4, 3e4, 1e5}, {0, 0, 0}, 0.008), 256);
  CHECK(wrong(compile(far), view, 10000) <= 30);  // floats of the rays: a hundred millionth of the way
  SceneDescription ground = scene_with(Material());
  add_sphere(ground, {{0, 0, -1e4}, 1e4, 0, {}});
  add_sphere(ground, {{3, 0, 1}, 1, 0, {}});
  CHECK(wrong(compile(ground), square(view_from({0, 0, 2}, {10, 0, 0}, 60), 256), 10000) <= 3);
}

TEST_CASE("faces that are not visible have no shape") {
  SceneDescription scene = scene_with(Material());
  add_sphere(scene, {{0, 0, 0}, -2, 0, {}});  // seen from inside alone
  add_square(scene, 1, 0);
  CompileOptions options;
  options.cull = true;
  const CompiledScene compiled = compile(scene, options);
  CHECK(wrong(compiled, square(view_from({0, 0, 10}, {0, 0, 0}), 64), 2000) == 0);
  CHECK(wrong(compiled, square(view_from({0, 1, -10}, {0, 0, 0}), 64), 2000) == 0);
}

TEST_CASE("from inside a sphere or cone its inner face is seen, and what else is in there") {
  SceneDescription scene = scene_with(Material());
  add_sphere(scene, {{0, 0, 0}, 5, 0, {}});
  add_cone(scene, {{0, 0, -4}, 2, {0, 0, 4}, 1, 0, {}});
  add_sphere(scene, {{0.5, 0, -3}, 0.5, 0, {}});
  add_cone(scene, {{0, 3, -2}, 0.5, {0, 2.8, -4}, 0.1, 0, {}});  // the eye is in its infinite continuation
  const View view = square(view_from({0, 3.2, 0}, {0, 0.5, -9}, 80), 128);
  CHECK(wrong(compile(scene), view, 5000) <= 2);
  CHECK(wrong(compile(scene), square(view_from({0, 0, 1}, {0.2, 0, -9}, 80), 128), 5000) <= 2);
}

TEST_CASE("next to a surface there is no shape, nor for an unknown primitive") {
  SceneDescription scene = scene_with(Material());
  add_sphere(scene, {{0, 0, 0}, 1, 0, {}});
  add_sphere(scene, {{0, 0, -30}, 1, 0, {}});
  const CompiledScene compiled = compile(scene);
  const Tracer tracer(compiled, compiled.camera(view_from({0, 0, 1}, {0, 0, -9})));
  ImageShape shape;
  tracer.project(1, shape);
  CHECK(shape.kind == ImageShape::Kind::kUnknown);
  tracer.project(2, shape);
  CHECK(shape.kind == ImageShape::Kind::kQuadric);
  tracer.project(3, shape);
  CHECK(shape.kind == ImageShape::Kind::kUnknown);
}

}  // namespace pprt::image_shape_test
