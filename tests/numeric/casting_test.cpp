// Casts samples into views that differ as much as possible from the one before.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "numeric/pictures.h"
#include "numeric/report.h"
#include "pipeline/casting/casting.h"
#include "pipeline/mesh/mesh_casting.h"
#include "pipeline/mesh/seeds.h"
#include "unit/trace/test_scenes.h"

namespace pprt::casting_test {
namespace {

const TileGrid kGrid{96, 72, 16};

View view_of(const SceneDescription& scene) {
  View view = scene.view.value();
  view.width = kGrid.width, view.height = kGrid.height;
  return view;
}

SampleMesh seen(const CompiledScene& scene, const View& view) {
  Tracer tracer(scene, scene.camera(view));
  SampleMesh mesh(Region::whole(kGrid));
  SampleId id = 0;
  for (const Vec2d& p : seed_points(kGrid.width, kGrid.height, 1)) {
    Sample sample;
    sample.x = p.x, sample.y = p.y, sample.id = id++, sample.frame = 1;
    sample.ray = tracer.trace(p.x, p.y);
    mesh.insert(sample);
  }
  return mesh;
}

struct Move {
  std::string name;
  Camera next;
  bool none_survives;
};

std::vector<Move> moves(const CompiledScene& scene, const View& view, const SampleMesh& mesh) {
  const auto camera_with = [&](auto change) {
    View next = view;
    change(next);
    return scene.camera(next);
  };
  std::vector<Move> all = {
      {"turned round", camera_with([](View& v) { v.at = v.from * 2 - v.at; }), true},
      {"turned aside", camera_with([](View& v) { v.at = v.from + (v.at - v.from).cross(v.up); }), true},
      {"upside down", camera_with([](View& v) { v.up = -v.up; }), false},
      {"zoomed by 1e6", camera_with([](View& v) { v.angle_degrees *= 1e-6; }), false},
      {"seen by 179.999 degrees", camera_with([](View& v) { v.angle_degrees = 179.999; }), false},
      {"from 1e6 times as far", camera_with([](View& v) { v.from = v.at + (v.from - v.at) * 1e6; }), false},
      {"from behind", camera_with([](View& v) { v.from = v.at * 2 - v.from; }), false}};
  for (const Sample& sample : mesh.samples()) {
    if (sample.ray.at_infinity || sample.id % 5 != 0) continue;
    Camera at_point = scene.camera(view);
    at_point.eye = Vec3d(sample.ray.hit);
    all.push_back({"from a hit point", at_point, false});
  }
  return all;
}

// Returns the number of samples that are lost, duplicated, not finite or outside the image.
std::size_t faults(const SampleMesh& mesh, const CastResult& cast) {
  const std::size_t gone = cast.out_of_view + cast.hidden + cast.too_old;
  std::size_t count = gone + cast.samples.size() == mesh.samples().size() ? 0 : 1;
  for (const Sample& s : cast.samples) {
    count += !(s.x >= 0 && s.x <= kGrid.width && s.y >= 0 && s.y <= kGrid.height);
  }
  return count + !std::isfinite(cast.moved);
}

}  // namespace

TEST_CASE("samples cast into any view are finite points of its image, and none is lost") {
  int casts = 0;
  std::size_t wrong = 0;
  for (const SceneDescription& scene : test::spd_scenes()) {
    const CompiledScene compiled = compile(scene);
    const View view = view_of(scene);
    const SampleMesh mesh = seen(compiled, view);
    for (const Move& move : moves(compiled, view, mesh)) {
      for (const CastMethod method : {CastMethod::kPaper, CastMethod::kVerified}) {
        const CastResult cast = cast_samples(mesh, move.next, 2, {.method = method});
        CAPTURE(scene.name, move.name);
        const std::size_t found = faults(mesh, cast);
        CHECK(found == 0);
        if (move.none_survives) CHECK(cast.samples.empty());
        wrong += found, ++casts;
      }
    }
  }
  test::report(
      fmt::format("{} casts of nine SPD scenes: turned round, zoomed by 1e6, from hit points, from behind",
                  casts),
      "every sample accounted for, survivors in the image; none after a turn",
      "behind the eye and at it nothing is projected", wrong == 0 ? "so" : fmt::format("{}", wrong));
}

}  // namespace pprt::casting_test
