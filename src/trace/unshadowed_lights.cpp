#include "trace/unshadowed_lights.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "trace/pose.h"

namespace pprt {
namespace {

// A point of a primitive, with the unit normal that it is lit by, against the ray.
struct LitPoint {
  Vec3d position{0, 0, 0}, normal{0, 0, 1};
};

// Where a ray passes beside, its point nearest the middle is moved onto the surface. `direction`: unit, as in
// all that follow.
template <class Record>
LitPoint beside(const Record& record, const Vec3d& from, const Vec3d& direction) {
  const double t = (bounds(record).center() - from).dot(direction);
  const SurfacePoint point = on_surface(record, from + direction * t);
  return {point.position, point.normal};
}

LitPoint meet(const SphereRecord& sphere, VisibleFaces faces, const Vec3d& from, const Vec3d& direction) {
  const Vec3d from_center = from - sphere.center;
  const Vec3d middle = from_center - direction * from_center.dot(direction);
  const double inside = sphere.radius * sphere.radius - middle.dot(middle);
  if (!(inside >= 0)) return beside(sphere, from, direction);
  const double sign = faces == VisibleFaces::kBack ? -1 : 1;
  const Vec3d outwards = (middle - direction * (sign * std::sqrt(inside))) * (1 / sphere.radius);
  return {sphere.center + outwards * sphere.radius, outwards * sign};
}

// The equation of crossings(), along the axis and across it: with a unit axis the normal needs no root.
LitPoint meet(const ConeRecord& cone, const LitCone& shape, VisibleFaces faces, const Vec3d& from,
              const Vec3d& direction) {
  const Vec3d from_base = from - cone.base;
  const Vec3d middle = from_base - direction * from_base.dot(direction);
  const double along = direction.dot(shape.axis), height = middle.dot(shape.axis);
  const Vec3d across = direction - shape.axis * along, aside = middle - shape.axis * height;
  const double growth = shape.slope * along, radius = cone.base_radius + shape.slope * height;
  const double a = across.dot(across) - growth * growth, b = across.dot(aside) - radius * growth,
               c = aside.dot(aside) - radius * radius;
  const double root = std::sqrt(std::max(b * b - a * c, 0.0));
  const double sum = b >= 0 ? -b - root : -b + root, first = sum / a, second = c / sum;
  const double entered = b >= 0 ? first : second, left = b >= 0 ? second : first;
  const auto is_there = [&](double t) {
    const double h = height + t * along;
    return h >= 0 && h <= shape.length;
  };
  const bool is_outer = faces != VisibleFaces::kBack && is_there(entered);
  const double t = is_outer ? entered : left, radius_there = radius + t * growth;
  if (!(b * b >= a * c) || !(is_outer || is_there(left)) || !(radius_there > 0))
    return beside(cone, from, direction);
  const Vec3d radial = (aside + across * t) * (1 / radius_there);
  const Vec3d outwards = (radial - shape.axis * shape.slope) * shape.per_slant;
  return {cone.base + middle + direction * t, is_outer ? outwards : -outwards};
}

Vec3d turned_against(const Vec3d& normal, const Vec3d& direction) {
  return normal.dot(direction) < 0 ? normal : -normal;
}

// A polygon's plane: the ray may meet any of its triangles.
LitPoint meet_plane(const Mesh& mesh, std::uint32_t triangle, const Vec3d& from, const Vec3d& direction) {
  const Vec3d normal(mesh.facets[triangle].normal), corner(mesh.vertices[mesh.triangles[triangle][0]]);
  const double t = (corner - from).dot(normal) / direction.dot(normal);
  return {std::isfinite(t) ? from + direction * t : corner, turned_against(normal, direction)};
}

// Meets the triangle of a polygon that the ray comes nearest to.
LitPoint meet_smooth(const Mesh& mesh, std::uint32_t first, std::uint32_t count, const Vec3d& from,
                     const Vec3d& direction) {
  std::uint32_t triangle = first;
  TrianglePoint at = on_surface(mesh, first, from, direction);
  for (std::uint32_t i = 1; i < count; ++i) {
    const TrianglePoint other = on_surface(mesh, first + i, from, direction);
    const auto distance = [&](const Vec3d& p) { return (p - from).cross(direction).length2(); };
    if (distance(other.position) < distance(at.position)) triangle = first + i, at = other;
  }
  const Vec3d against = turned_against(at.normal, direction);
  const Vec3d normal = shading_normal(mesh, triangle, at.u, at.v);
  return {at.position + rise_to_smooth(mesh, triangle, at, against),
          normal.dot(against) < 0 ? -normal : normal};
}

// `first`, `count`: the primitive's own ones in the part. `cone`: if it is one.
LitPoint meet(const ScenePart& part, std::uint32_t first, std::uint32_t count, const LitCone& cone,
              const Vec3d& from, const Vec3d& direction) {
  if (const auto* cones = std::get_if<std::vector<ConeRecord>>(&part.shape))
    return meet((*cones)[first], cone, part.faces, from, direction);
  if (const auto* spheres = std::get_if<std::vector<SphereRecord>>(&part.shape))
    return meet((*spheres)[first], part.faces, from, direction);
  const Mesh& mesh = *std::get_if<Mesh>(&part.shape);
  return part.smooth ? meet_smooth(mesh, first, count, from, direction)
                     : meet_plane(mesh, first, from, direction);
}

LitCone lit_cone(const ConeRecord& cone) {
  const double length = std::sqrt(cone.axis.dot(cone.axis)), slope = cone.radius_change / length;
  return {cone.axis * (1 / length), length, slope, 1 / std::sqrt(1 + slope * slope)};
}

// Returns the cosine from which a highlight is brighter than can be seen.
float least_cosine_of(float shine) {
  constexpr float kNotSeen = 1e-4F;
  return std::pow(kNotSeen, 1 / shine);
}

Vec3d mirrored_at(const Vec3d& direction, const Vec3d& normal) {
  return direction - normal * (2 * direction.dot(normal));
}

float4 to_float(const double4& v) {
  return __builtin_convertvector(v, float4);
}

float4 channels(const Color& c) {
  return float4{c.x, c.y, c.z, 0};
}

}  // namespace

std::vector<LitSurface> lit_surfaces(const CompiledScene::Impl& scene) {
  std::vector<LitSurface> surfaces(scene.part_of_primitive.size() + 1);
  const bool are_few = scene.lights.size() <= kNotedLights;
  for (const ScenePart& part : scene.parts) {
    const LitShape shape = !std::holds_alternative<Mesh>(part.shape) ? LitShape::kRound
                           : part.smooth                             ? LitShape::kSmooth
                                                                     : LitShape::kFlat;
    for (std::size_t i = 0; i < part.primitives.size(); ++i) {
      const ShadingMaterial& material = scene.materials[part.materials[i]];
      if (!material.lit || material.has_picture()) continue;
      const bool has_more = (scene.effects.has(Effect::kReflection) && material.specular > 0) ||
                            (scene.effects.has(Effect::kRefraction) && material.transmittance > 0);
      surfaces[part.primitives[i] + 1] = {shape, are_few && !has_more};
    }
  }
  // Which one of two faces in one plane is seen is not certain.
  for (const ScenePart& part : scene.parts) {
    for (std::size_t i = 0; i < part.coincides.size(); ++i)
      if (part.coincides[i]) surfaces[scene.surfaces[part.primitives[i] + 1]] = {};
  }
  return surfaces;
}

void UnshadowedLights::prepare(const Pose& pose) {
  kept_.fill({});
  lights_.fill({});
  const std::span<const ShadingLight> lights = pose.lights();
  count_ = static_cast<int>(std::min<std::size_t>(lights.size(), kNotedLights));
  for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i) {
    Four& four = lights_[i / kLanes];
    const std::size_t lane = i % kLanes;
    four.x[lane] = lights[i].position.x;
    four.y[lane] = lights[i].position.y;
    four.z[lane] = lights[i].position.z;
    four.colors[lane] = channels(lights[i].color);
  }
  is_ready_ = true;
}

const UnshadowedLights::Place& UnshadowedLights::place_of(const Pose& pose, std::uint32_t primitive) {
  Place& kept = kept_[primitive % kept_.size()];
  if (kept.primitive == primitive) return kept;
  kept = {};
  kept.primitive = primitive;
  const CompiledScene::Impl& scene = pose.scene();
  if (primitive - 1 >= scene.part_of_primitive.size()) return kept;
  const std::uint32_t number = scene.part_of_primitive[primitive - 1];
  if (number == kNoPart) return kept;
  const ScenePart& part = pose.part(number);
  const auto [first, end] = std::equal_range(part.primitives.begin(), part.primitives.end(), primitive - 1);
  if (first == end) return kept;
  kept.part = &part, kept.first = static_cast<std::uint32_t>(first - part.primitives.begin());
  kept.count = static_cast<std::uint32_t>(end - first);
  if (const auto* cones = std::get_if<std::vector<ConeRecord>>(&part.shape))
    kept.cone = lit_cone((*cones)[kept.first]);
  const ShadingMaterial& material = scene.materials[part.materials[kept.first]];
  if (scene.effects.has(Effect::kHighlights) && material.shine > 0)
    kept.least_cosine = least_cosine_of(material.shine);
  return kept;
}

PPRT_CLONED_FOR_WIDE_REGISTERS
void UnshadowedLights::at(const Pose& pose, std::uint32_t primitive, const Camera& camera, double x, double y,
                          UnshadowedLight& light) {
  if (!is_ready_) prepare(pose);
  const Place& place = place_of(pose, primitive);
  light.is_known = place.part != nullptr;
  if (!light.is_known) return;
  const CompiledScene::Impl& scene = pose.scene();
  const ScenePart& part = *place.part;
  const Vec3d along = unit(ray_direction(camera, x, y));
  const BodyPlace* body = pose.place_of(part);
  LitPoint point;
  if (body == nullptr) {
    point = meet(part, place.first, place.count, place.cone, camera.eye, along);
  } else {
    point = meet(part, place.first, place.count, place.cone, body->from_world.point(camera.eye),
                 unit(body->from_world.vector(along)));
    point.position = body->to_world.point(point.position);
    point.normal = unit(body->gradient(point.normal));
  }
  const ShadingMaterial& material = scene.materials[part.materials[place.first]];
  light.unlit = channels(material.unlit);
  light.count = count_;
  const Vec3d& at = point.position;
  const Vec3f n(point.normal);
  const float4 diffuse = channels(material.diffuse), specular = channels(material.specular_color);
  const bool shines = place.least_cosine < 1;
  const Vec3f mirrored = shines ? Vec3f(mirrored_at(along, point.normal)) : Vec3f(0, 0, 0);
  for (std::size_t first = 0; first < static_cast<std::size_t>(count_); first += kLanes) {
    const Four& four = lights_[first / kLanes];
    const float4 dx = to_float(four.x - at.x), dy = to_float(four.y - at.y), dz = to_float(four.z - at.z);
    const float4 inverse = 1 / square_root(dx * dx + dy * dy + dz * dz);
    const float4 cosines = max((dx * n.x + dy * n.y + dz * n.z) * inverse, float4{});
    for (std::size_t i = 0; i < kLanes; ++i) light.each[first + i] = four.colors[i] * diffuse * cosines[i];
    if (!shines) continue;
    const float4 to_light = (dx * mirrored.x + dy * mirrored.y + dz * mirrored.z) * inverse;
    for (std::size_t i = 0; i < kLanes; ++i) {
      if (!(to_light[i] > place.least_cosine) || !(cosines[i] > 0)) continue;
      light.each[first + i] += four.colors[i] * (specular * std::pow(to_light[i], material.shine));
    }
  }
}

}  // namespace pprt
