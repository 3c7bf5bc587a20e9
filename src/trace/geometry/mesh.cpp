#include "trace/geometry/mesh.h"

#include <algorithm>
#include <cmath>

#include "trace/geometry/numerics.h"

namespace pprt {
namespace {

// Embree filter: rejects hits on invisible faces. The user pointer is the mesh's facets.
template <VisibleFaces kFaces>
void keep_visible_faces(const RTCFilterFunctionNArguments* args) {
  const Facet* facets = static_cast<const Facet*>(args->geometryUserPtr);
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    const Vec3f direction(RTCRayN_dir_x(args->ray, args->N, i), RTCRayN_dir_y(args->ray, args->N, i),
                          RTCRayN_dir_z(args->ray, args->N, i));
    const float slope = facets[RTCHitN_primID(args->hit, args->N, i)].normal.dot(direction);
    const bool visible = kFaces == VisibleFaces::kFront ? slope < 0 : slope > 0;
    if (!visible) args->valid[i] = 0;
  }
}

template <VisibleFaces kFaces>
void set_filter(RTCGeometry geometry) {
  rtcSetGeometryIntersectFilterFunction(geometry, keep_visible_faces<kFaces>);
  rtcSetGeometryOccludedFilterFunction(geometry, keep_visible_faces<kFaces>);
}

struct FacetShape {
  Vec3d normal;  // of length twice_area
  double twice_area;
  double offset;  // see triangle_offset; only where there is an area
};

FacetShape facet_shape(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d normal = (b - a).cross(c - a);
  const double twice_area = std::sqrt(normal.dot(normal));
  if (!(twice_area > 0)) return {normal, 0, 0};
  const double longest = std::sqrt(std::max({(b - a).length2(), (c - b).length2(), (a - c).length2()}));
  const double reach = std::max({sum_of_coordinates(a), sum_of_coordinates(b), sum_of_coordinates(c)});
  return {normal, twice_area, triangle_offset(longest, twice_area, reach)};
}

// Gradients of the weights of a triangle's second and third corner, in its plane.
struct WeightGradients {
  Vec3d b, c;
};

WeightGradients weight_gradients(const Mesh& mesh, std::uint32_t triangle) {
  const TriangleIndices& index = mesh.triangles[triangle];
  const Vec3d a(mesh.vertices[index[0]]);
  const Vec3d ab = Vec3d(mesh.vertices[index[1]]) - a;
  const Vec3d ac = Vec3d(mesh.vertices[index[2]]) - a;
  const Vec3d normal = ab.cross(ac);
  const double per_area2 = 1 / normal.dot(normal);
  return {ac.cross(normal) * per_area2, normal.cross(ab) * per_area2};
}

}  // namespace

std::size_t Mesh::add(std::span<const Vec3d> polygon, std::span<const Vec3f> vertex_normals) {
  const auto first_vertex = static_cast<std::uint32_t>(vertices.size());
  const std::size_t first_triangle = triangles.size();
  float offset = 0;
  for (const TriangleIndices& index : triangulate(polygon)) {
    // Positions as the float vertices have them.
    const Vec3d a{Vec3f(polygon[index[0]])};
    const Vec3d b{Vec3f(polygon[index[1]])};
    const Vec3d c{Vec3f(polygon[index[2]])};
    const FacetShape shape = facet_shape(a, b, c);
    if (!(shape.twice_area > 0)) continue;
    offset = std::max(offset, static_cast<float>(shape.offset));
    triangles.push_back({first_vertex + index[0], first_vertex + index[1], first_vertex + index[2]});
    facets.push_back({Vec3f(shape.normal * (1 / shape.twice_area)), 0});
  }
  const std::size_t added = triangles.size() - first_triangle;
  if (added == 0) return 0;
  for (std::size_t i = first_triangle; i < facets.size(); ++i) facets[i].offset = offset;
  for (const Vec3d& p : polygon) vertices.emplace_back(p);
  normals.insert(normals.end(), vertex_normals.begin(), vertex_normals.end());
  return added;
}

TrianglePoint on_surface(const Mesh& mesh, std::uint32_t triangle, const Vec3d& origin,
                         const Vec3d& direction) {
  const TriangleIndices& index = mesh.triangles[triangle];
  const Vec3d a(mesh.vertices[index[0]]);
  const Vec3d ab = Vec3d(mesh.vertices[index[1]]) - a;
  const Vec3d ac = Vec3d(mesh.vertices[index[2]]) - a;
  const Vec3d across = direction.cross(ac);
  const double inverse = 1 / ab.dot(across);
  const Vec3d from_a = origin - a;
  // Edge on, the quotients are infinite or not numbers: every comparison puts them on the triangle.
  const auto within = [](double x, double most) { return x > 0 ? (x < most ? x : most) : 0; };
  const double u = within(from_a.dot(across) * inverse, 1);
  const double v = within(direction.dot(from_a.cross(ab)) * inverse, 1 - u);
  return {{a + ab * u + ac * v, Vec3d(mesh.facets[triangle].normal)}, u, v};
}

Vec3d shading_normal(const Mesh& mesh, std::uint32_t triangle, double u, double v) {
  const TriangleIndices& index = mesh.triangles[triangle];
  const Vec3d normal = Vec3d(mesh.normals[index[0]]) * (1 - u - v) + Vec3d(mesh.normals[index[1]]) * u +
                       Vec3d(mesh.normals[index[2]]) * v;
  const double length2 = normal.dot(normal);
  // Opposite normals cancel. Counted from: unit normals in float err by 2u = 1.2e-7 where they cancel, whose
  // square is 1.4e-14. Test: shading_test.cpp, "normals of no length ...".
  if (!(length2 > 1e-12)) return Vec3d(mesh.facets[triangle].normal);
  return normal * (1 / std::sqrt(length2));
}

// Each corner's tangent plane lies above the facet where the surface bulges. The mean of the heights,
// weighted as the normals are, is that of the smooth surface. Source: Hanika, Hacking the Shadow Terminator,
// in Ray Tracing Gems II, 2021.
Vec3d rise_to_smooth(const Mesh& mesh, std::uint32_t triangle, const TrianglePoint& at, const Vec3d& side) {
  const TriangleIndices& index = mesh.triangles[triangle];
  const std::array<double, 3> weights = {1 - at.u - at.v, at.u, at.v};
  Vec3d rise(0, 0, 0);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d normal(mesh.normals[index[i]]);
    const double above = normal.dot(at.position - Vec3d(mesh.vertices[index[i]]));
    const double height = normal.dot(side) < 0 ? std::max(0.0, above) : std::min(0.0, above);
    rise -= normal * (weights[i] * height);
  }
  return rise;
}

Vec2d texture_point(const Mesh& mesh, std::uint32_t triangle, double u, double v) {
  const TriangleIndices& index = mesh.triangles[triangle];
  return Vec2d(mesh.texture_points[index[0]]) * (1 - u - v) + Vec2d(mesh.texture_points[index[1]]) * u +
         Vec2d(mesh.texture_points[index[2]]) * v;
}

TextureGradients texture_gradients(const Mesh& mesh, std::uint32_t triangle) {
  const WeightGradients weights = weight_gradients(mesh, triangle);
  const TriangleIndices& index = mesh.triangles[triangle];
  const Vec2d from(mesh.texture_points[index[0]]);
  const Vec2d to_b = Vec2d(mesh.texture_points[index[1]]) - from;
  const Vec2d to_c = Vec2d(mesh.texture_points[index[2]]) - from;
  return {weights.b * to_b.x + weights.c * to_c.x, weights.b * to_b.y + weights.c * to_c.y};
}

// Half the trace of the normal's derivative.
double mean_curvature(const Mesh& mesh, std::uint32_t triangle) {
  const WeightGradients weights = weight_gradients(mesh, triangle);
  const TriangleIndices& index = mesh.triangles[triangle];
  const Vec3d from(mesh.normals[index[0]]);
  return 0.5 * (weights.b.dot(Vec3d(mesh.normals[index[1]]) - from) +
                weights.c.dot(Vec3d(mesh.normals[index[2]]) - from));
}

void Mesh::set_shape(std::size_t triangle, const std::array<Vec3d, 3>& corners,
                     const std::array<Vec3f, 3>& corner_normals) {
  const TriangleIndices& index = triangles[triangle];
  for (std::size_t i = 0; i < 3; ++i) {
    vertices[index[i]] = Vec3f(corners[i]);
    normals[index[i]] = corner_normals[i];
  }
  const std::array<Vec3d, 3> p = {Vec3d(vertices[index[0]]), Vec3d(vertices[index[1]]),
                                  Vec3d(vertices[index[2]])};
  const FacetShape shape = facet_shape(p[0], p[1], p[2]);
  facets[triangle] = shape.twice_area > 0 ? Facet{Vec3f(shape.normal * (1 / shape.twice_area)),
                                                  static_cast<float>(shape.offset)}
                                          : Facet{};
}

EmbreeGeometry new_mesh_geometry(const EmbreeDevice& device, Mesh& mesh, VisibleFaces faces) {
  const std::size_t vertex_count = mesh.vertices.size();
  mesh.vertices.emplace_back(0.f, 0.f, 0.f);  // Embree reads 16 bytes per vertex
  EmbreeGeometry geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             mesh.vertices.data(), 0, sizeof(Vec3f), vertex_count);
  rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             mesh.triangles.data(), 0, sizeof(TriangleIndices), mesh.triangles.size());
  rtcSetGeometryUserData(geometry.get(), mesh.facets.data());
  if (faces == VisibleFaces::kFront) set_filter<VisibleFaces::kFront>(geometry.get());
  if (faces == VisibleFaces::kBack) set_filter<VisibleFaces::kBack>(geometry.get());
  rtcCommitGeometry(geometry.get());
  return geometry;
}

}  // namespace pprt
