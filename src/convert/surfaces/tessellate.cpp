#include "convert/surfaces/tessellate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "base/affine.h"
#include "base/diagnostics.h"
#include "scene/animation/resting_nodes.h"

namespace pprt {
namespace {

constexpr double kPi = std::numbers::pi;

int limited(double n) {
  return static_cast<int>(std::clamp(std::ceil(n), 1.0, static_cast<double>(kMaxDivisions)));
}

// Adds three vertices of a surface as a patch.
void add_triangle(SceneDescription& scene, const Surface& surface, const TriangleIndices& t,
                  MaterialIndex material, SourceLocation location) {
  const std::array<PatchVertex, 3> corners = {surface.vertices[t[0]], surface.vertices[t[1]],
                                              surface.vertices[t[2]]};
  add_patch(scene, corners, material, location);
}

// Turns the surface so that only its inside is visible.
void turn(Surface& surface) {
  for (PatchVertex& v : surface.vertices) v.normal = -v.normal;
  for (TriangleIndices& t : surface.triangles) std::swap(t[1], t[2]);
}

}  // namespace

// The largest cell lies in the middle of a face: pi / (2N) wide both ways. A triangle's plane passes the
// centre at cos(half its diagonal), which is at least 1 / sqrt(1 + 2 tan^2(pi / 4N)), with equality for odd
// N.
int divisions(const Sphere& sphere, const Fineness& fineness) {
  if (sphere.radius == 0) return 0;
  if (!fineness.chord_error) return fineness.divisions;
  const double cosine = 1 - *fineness.chord_error / std::abs(sphere.radius);
  if (!(cosine > 0)) return 1;
  return limited(kPi / (4 * std::atan(std::sqrt((1 / (cosine * cosine) - 1) / 2))));
}

// A chord of 1 / 4N of a circle passes its centre at cos(pi / 4N).
int divisions(const Cone& cone, const Fineness& fineness) {
  const double radius = std::max(std::abs(cone.base_radius), std::abs(cone.apex_radius));
  if (radius == 0 || cone.base == cone.apex) return 0;
  if (!fineness.chord_error) return fineness.divisions;
  const double cosine = 1 - *fineness.chord_error / radius;
  if (!(cosine > 0)) return 1;
  return limited(kPi / (4 * std::acos(cosine)));
}

// Each face of the cube has the angles -45 to 45 degrees in N equal steps, both ways. Cells are cut along the
// diagonal towards the corner of their face, the shorter one.
Surface tessellate(const Sphere& sphere, int n) {
  const double radius = std::abs(sphere.radius);
  const auto side = static_cast<std::uint32_t>(n + 1);
  std::vector<double> tangents;
  for (int i = 0; i <= n; ++i) tangents.push_back(std::tan(kPi / 4 * (2.0 * i / n - 1)));
  Surface surface;
  surface.vertices.reserve(std::size_t{6} * side * side);
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const double sign = face % 2 == 0 ? 1 : -1;
    const auto first = static_cast<std::uint32_t>(surface.vertices.size());
    for (const double a : tangents) {
      for (const double b : tangents) {
        Vec3d direction;
        direction[axis] = sign;
        direction[(axis + 1) % 3] = sign * a;  // turned with the face, so that all wind alike
        direction[(axis + 2) % 3] = b;
        direction.normalize();
        surface.vertices.push_back({sphere.center + direction * radius, direction});
      }
    }
    for (std::uint32_t i = 0; i + 1 < side; ++i) {
      for (std::uint32_t j = 0; j + 1 < side; ++j) {
        const std::uint32_t q = first + i * side + j;
        const bool far_i = 2 * i + 2 > side;
        const bool far_j = 2 * j + 2 > side;
        if (far_i == far_j) {
          surface.triangles.push_back({q, q + side, q + side + 1});
          surface.triangles.push_back({q + side + 1, q + 1, q});
        } else {
          surface.triangles.push_back({q, q + side, q + 1});
          surface.triangles.push_back({q + 1, q + side, q + side + 1});
        }
      }
    }
  }
  if (sphere.radius < 0) turn(surface);
  return surface;
}

Surface tessellate(const Cone& cone, int n) {
  const double base_radius = std::abs(cone.base_radius);
  const double apex_radius = std::abs(cone.apex_radius);
  const Vec3d axis = cone.apex - cone.base;
  const double length = axis.length();
  const Vec3d along = axis / length;
  const int least = std::abs(along.x) <= std::abs(along.y) && std::abs(along.x) <= std::abs(along.z) ? 0
                    : std::abs(along.y) <= std::abs(along.z)                                         ? 1
                                                                                                     : 2;
  Vec3d other(0, 0, 0);
  other[least] = 1;
  const Vec3d u = other.cross(along).normalized();
  const Vec3d v = along.cross(u);

  const auto steps = static_cast<std::uint32_t>(4 * n);
  Surface surface;
  for (std::uint32_t i = 0; i < steps; ++i) {
    const double angle = 2 * kPi * i / steps;
    const Vec3d radial = u * std::cos(angle) + v * std::sin(angle);
    const Vec3d normal = (radial + along * ((base_radius - apex_radius) / length)).normalized();
    surface.vertices.push_back({cone.base + radial * base_radius, normal});
    surface.vertices.push_back({cone.apex + radial * apex_radius, normal});
  }
  for (std::uint32_t i = 0; i < steps; ++i) {
    const std::uint32_t here = 2 * i;
    const std::uint32_t next = 2 * ((i + 1) % steps);
    if (base_radius > 0) surface.triangles.push_back({here, next, next + 1});
    if (apex_radius > 0) surface.triangles.push_back({next + 1, here + 1, here});
  }
  if (cone.base_radius < 0 || cone.apex_radius < 0) turn(surface);
  return surface;
}

std::size_t triangle_count(const SceneDescription& scene, const Fineness& fineness) {
  std::size_t count = 0;
  for (const Sphere& s : scene.spheres) {
    const auto n = static_cast<std::size_t>(divisions(s, fineness));
    count += 12 * n * n;
  }
  for (const Cone& c : scene.cones) {
    const int rings = (c.base_radius != 0 ? 1 : 0) + (c.apex_radius != 0 ? 1 : 0);
    count += static_cast<std::size_t>(4 * divisions(c, fineness) * rings);
  }
  return count;
}

void check_triangle_count(const SceneDescription& scene, const Fineness& fineness) {
  const std::size_t count = triangle_count(scene, fineness);
  if (count <= kMaxTriangles) return;
  throw InputError(scene.name + ": error: its spheres and cones would become " + std::to_string(count) +
                   " triangles, more than " + std::to_string(kMaxTriangles) + ": cut them less finely");
}

namespace {

// Returns the fineness in the space of a node: a map lengthens nothing by more than the root of the sum of
// all squares.
Fineness in_node(const Fineness& fineness, const Affine& map) {
  Fineness result = fineness;
  if (result.chord_error && map != Affine())
    *result.chord_error /= std::sqrt(map.x.length2() + map.y.length2() + map.z.length2());
  return result;
}

// Cuts all spheres and cones, or only those that a node stretches.
SceneDescription cut(const SceneDescription& scene, const Fineness& fineness, bool all) {
  const std::vector<Placement> placements = placements_at(scene.movement, start_time(scene.movement));
  SceneDescription result = scene;
  result.spheres.clear(), result.cones.clear();
  result.polygons.clear(), result.polygon_vertices.clear();
  result.patches.clear(), result.patch_vertices.clear();
  result.triangles.clear(), result.moving_triangles.clear();
  result.order.clear(), result.nodes.clear();
  NodeIndex node = 0;
  const auto add_surface = [&](const auto& object) {
    const int n = divisions(object, in_node(fineness, placements[node].to_parent));
    if (n == 0) return;
    const Surface surface = tessellate(object, n);
    for (const TriangleIndices& t : surface.triangles) {
      add_triangle(result, surface, t, object.material, object.location);
    }
  };
  for (std::size_t place = 0; place < scene.order.size(); ++place) {
    const PrimitiveRef ref = scene.order[place];
    node = node_of(scene, place);
    switch (ref.kind) {
      case PrimitiveKind::kSphere: {
        const Sphere& s = scene.spheres[ref.index];
        all || node != 0 ? add_surface(s) : add_sphere(result, s);
        break;
      }
      case PrimitiveKind::kCone: {
        const Cone& c = scene.cones[ref.index];
        all || node != 0 ? add_surface(c) : add_cone(result, c);
        break;
      }
      case PrimitiveKind::kPolygon: {
        const Polygon& p = scene.polygons[ref.index];
        add_polygon(result, scene.vertices(p), p.material, p.location);
        break;
      }
      case PrimitiveKind::kPatch: {
        const Patch& p = scene.patches[ref.index];
        add_patch(result, scene.vertices(p), p.material, p.location);
        break;
      }
      case PrimitiveKind::kTriangle:
        result.order.push_back({ref.kind, static_cast<std::uint32_t>(result.triangles.size())});
        result.triangles.push_back(scene.triangles[ref.index]);
        break;
      case PrimitiveKind::kMovingTriangle:
        add_moving_triangle(result, scene.moving_triangles[ref.index]);
        break;
    }
    result.nodes.resize(result.order.size(), node);
  }
  if (scene.nodes.empty()) result.nodes.clear();
  return without_resting_nodes(std::move(result));
}

}  // namespace

SceneDescription tessellated(const SceneDescription& scene, const Fineness& fineness) {
  check_triangle_count(scene, fineness);
  return cut(scene, fineness, true);
}

SceneDescription with_stretched_tessellated(const SceneDescription& scene, const Fineness& fineness) {
  return cut(scene, fineness, false);
}

}  // namespace pprt
