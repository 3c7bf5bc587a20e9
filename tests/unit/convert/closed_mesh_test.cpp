// Meshes that enclose a volume, and meshes with open sides.
#include "convert/model/closed_mesh.h"

#include <catch2/catch.hpp>

#include <utility>

namespace pprt::closed_mesh_test {
namespace {

// A tetrahedron whose faces have corners of their own.
ModelMesh tetrahedron() {
  const Vec3d a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), d(0, 0, 1);
  ModelMesh mesh;
  for (const Vec3d& p : {a, c, b, a, b, d, b, c, d, c, a, d}) {
    mesh.corners.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    mesh.positions.push_back(p);
    if (mesh.corners.size() % 3 == 0) mesh.ends.push_back(mesh.corners.size());
  }
  return mesh;
}

}  // namespace

TEST_CASE("closed meshes: corners at one place are one") {
  ModelMesh mesh = tetrahedron();
  CHECK(is_closed(mesh));
  mesh.positions[4].x = 1.5;
  CHECK_FALSE(is_closed(mesh));
}

TEST_CASE("closed meshes: rounding parts no corners, wherever they lie") {
  for (int i = 0; i < 40; ++i) {
    ModelMesh mesh = tetrahedron();
    mesh.positions[4].x = 1 + 1e-7;
    mesh.positions[1].x = -1e-16;
    for (Vec3d& p : mesh.positions) p = p * 3.7 + Vec3d(i * 1e-5, 0.5 + i * 1.3e-5, -i * 0.9e-5);
    CHECK(is_closed(mesh));
    mesh.positions[4].x += 2e-3;
    CHECK_FALSE(is_closed(mesh));
  }
}

TEST_CASE("closed meshes: corners on both sides of a cell's border are one") {
  const auto part_at = [](ModelMesh& mesh, int axis, double border) {
    bool is_first = true;
    for (Vec3d& p : mesh.positions) {
      if (p[axis] != 1) continue;
      p[axis] = border + (std::exchange(is_first, false) ? -1e-9 : 1e-9);
    }
  };
  constexpr double kFirst = 0.500025, kSecond = 0.500075;  // of each of the two grids
  for (const double border : {kFirst, kSecond}) {
    ModelMesh mesh = tetrahedron();
    part_at(mesh, 1, border);
    CHECK(is_closed(mesh));
  }
  ModelMesh both = tetrahedron();
  part_at(both, 1, kFirst), part_at(both, 2, kSecond);
  CHECK(is_closed(both));
}

TEST_CASE("closed meshes: one that lacks a face, or has one turned, is open") {
  ModelMesh mesh = tetrahedron();
  std::swap(mesh.corners[0], mesh.corners[1]);
  CHECK_FALSE(is_closed(mesh));
  mesh = tetrahedron();
  mesh.ends.pop_back();
  CHECK_FALSE(is_closed(mesh));
  mesh.corners.resize(9);
  CHECK_FALSE(is_closed(mesh));
}

TEST_CASE("closed meshes: a face twice is as closed as it is once") {
  ModelMesh mesh = tetrahedron();
  const std::vector<std::uint32_t> once = mesh.corners;
  mesh.corners.insert(mesh.corners.end(), once.begin(), once.begin() + 3);
  mesh.ends.push_back(mesh.corners.size());
  CHECK_FALSE(is_closed(mesh));  // its edges run three times one way and once the other
  // What has no area has no side.
  mesh = tetrahedron();
  mesh.corners.insert(mesh.corners.end(), {0, 3, 0});
  mesh.ends.push_back(mesh.corners.size());
  CHECK(is_closed(mesh));
}

TEST_CASE("closed meshes: faces of four corners, and corners that are not there") {
  ModelMesh mesh;  // two squares, back to back
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.corners = {0, 1, 2, 3, 3, 2, 1, 0};
  mesh.ends = {4, 8};
  CHECK(is_closed(mesh));
  mesh.corners[7] = 4;
  CHECK_FALSE(is_closed(mesh));
}

}  // namespace pprt::closed_mesh_test
