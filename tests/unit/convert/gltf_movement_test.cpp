// How what moves in glTF moves in a scene.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "scene/movement/movement.h"
#include "unit/convert/gltf_sample.h"

namespace pprt::gltf_movement_test {

namespace {

using Notes = std::vector<std::string>;

Vec3d place_at(const ReadMesh& read, const std::string& track, double time) {
  return track_at(read.scene.movement, track, time).value().to_parent.origin;
}

}  // namespace

TEST_CASE("gltf: STEP jumps, LINEAR slides, CUBICSPLINE eases") {
  GltfSample sample;
  const int mesh = sample.triangle();
  for (const char* name : {"step", "line", "curve"}) sample.node({{"name", name}, {"mesh", mesh}});
  sample.move(0, "translation", "STEP", {0, 1, 2}, {0, 0, 0, 4, 0, 0, 8, 0, 0});
  sample.move(1, "translation", "LINEAR", {0, 1, 2}, {0, 0, 0, 4, 0, 0, 8, 0, 0});
  // Tangents of 0 at both keys: 3 t^2 - 2 t^3.
  sample.move(2, "translation", "CUBICSPLINE", {0, 1},
              {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 0, 0, 0, 0});
  const ReadMesh read = sample.read();
  for (const double t : {0.0, 0.3, 0.999, 1.0, 1.5}) {
    CAPTURE(t);
    CHECK(place_at(read, "step", t).x == (t < 1 ? 0 : 4));
    CHECK(place_at(read, "line", t).x == Approx(4 * t));
    const double c = std::min(t, 1.0);
    CHECK(place_at(read, "curve", t).x == Approx(4 * (3 * c * c - 2 * c * c * c)).margin(4 / 4000.0));
  }
  CHECK(place_at(read, "step", 2).x == 8);
  CHECK(read.notes.empty());
}

TEST_CASE("gltf: a curve of turns stays within 0.02 degrees") {
  GltfSample sample;
  sample.node({{"name", "wheel"}, {"mesh", sample.triangle()}});
  const float half = std::sqrt(0.5F);  // of a quarter turn about z
  sample.move(0, "rotation", "CUBICSPLINE", {0, 2},
              {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0.5F, 0, 0, 0, 0.5F, 0, 0, 0, half, half, 0, 0, 0, 0});
  const ReadMesh read = sample.read();
  for (const double t : {0.1, 0.77, 1.3}) {
    // Hermite's cubic of z and w over 2 s, and then the angle.
    const double s = t / 2, s2 = s * s, s3 = s2 * s, h = static_cast<double>(half);
    const double z = 2 * (s3 - 2 * s2 + s) * 0.5 + (3 * s2 - 2 * s3) * h + 2 * (s3 - s2) * 0.5;
    const double w = (2 * s3 - 3 * s2 + 1) + (3 * s2 - 2 * s3) * h;
    const Vec3d x = track_at(read.scene.movement, "wheel", t)->to_parent.x;
    CAPTURE(t);
    CHECK(std::atan2(x.y, x.x) == Approx(2 * std::atan2(z, w)).margin(0.02 * M_PI / 180));
  }
}

TEST_CASE("gltf: nodes of one name go their own ways, and what a track leaves out stays") {
  GltfSample sample;
  const int mesh = sample.triangle();
  for (int i = 0; i < 3; ++i)
    sample.node({{"name", "Cube"}, {"mesh", mesh}, {"scale", {2, 2, 2}}, {"translation", {0, 0, 7}}});
  sample.node({{"name", "Cube_2"}, {"mesh", mesh}});
  sample.move(0, "translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0});
  sample.move(1, "translation", "LINEAR", {0, 1}, {0, 0, 0, 0, 1, 0});
  sample.move(3, "rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, 1, 0});
  const ReadMesh read = sample.read();
  CHECK(read.notes.empty());
  CHECK(place_at(read, "Cube", 1) == Vec3d(1, 0, 0));
  CHECK(place_at(read, "Cube_2", 1) == Vec3d(0, 1, 0));
  CHECK(track_at(read.scene.movement, "Cube", 1)->to_parent.x == Vec3d(2, 0, 0));
  CHECK(read.scene.movement.tracks.size() == 3);
  CHECK(read.scene.primitive_count() == 4);
}

TEST_CASE("gltf: of several animations one is shown, and all are named") {
  GltfSample sample;
  sample.node({{"name", "b"}, {"mesh", sample.triangle()}});
  sample.move(0, "translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0}, "walk");
  sample.move(0, "translation", "LINEAR", {0, 1}, {0, 0, 0, 0, 1, 0}, "jump");
  const ReadMesh first = sample.read(), second = sample.read({.animation = "jump"});
  CHECK(place_at(first, "b", 1) == Vec3d(1, 0, 0));
  CHECK(place_at(second, "b", 1) == Vec3d(0, 1, 0));
  CHECK(first.notes == Notes{"of 2 animations 'walk' is shown; --animation takes another: 'jump'"});
  CHECK(second.notes == Notes{"of 2 animations 'jump' is shown; --animation takes another: 'walk'"});
  CHECK_THROWS_WITH(sample.read({.animation = "run"}),
                    Catch::EndsWith(": error: it has no animation 'run', but 'walk', 'jump'"));
}

}  // namespace pprt::gltf_movement_test
