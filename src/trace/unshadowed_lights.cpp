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

// Where a ray passes beside, its point nearest the middle is moved onto the surface.
template <class Record>
LitPoint beside(const Record& record, const Vec3d& from, const Vec3d& direction) {
  const double t = (bounds(record).center() - from).dot(direction) / direction.dot(direction);
  const SurfacePoint point = on_surface(record, from + direction * t);
  return {point.position, point.normal};
}

// From the ray's point nearest the middle, as in crossings(): a far ray loses no digits.
LitPoint meet(const SphereRecord& sphere, const SeenQuadric& seen, VisibleFaces faces, const Vec3d& from,
              const Vec3d& direction) {
  const double per_square = 1 / direction.dot(direction);
  const Vec3d middle = seen.aside - direction * (seen.aside.dot(direction) * per_square);
  const double inside = sphere.radius * sphere.radius - middle.dot(middle);
  if (!(inside >= 0)) return beside(sphere, from, direction);
  const double sign = faces == VisibleFaces::kBack ? -1 : 1;
  const Vec3d outwards = (middle - direction * (sign * std::sqrt(inside * per_square))) * seen.per_slant;
  return {sphere.center + outwards * sphere.radius, outwards * sign};
}

// The equation of crossings(), along the axis and across it: with a unit axis the normal needs no root. From
// the ray's point nearest the axis.
LitPoint meet(const ConeRecord& cone, const SeenQuadric& seen, VisibleFaces faces, const Vec3d& from,
              const Vec3d& direction) {
  const double along = direction.dot(seen.axis), growth = seen.slope * along;
  const Vec3d across = direction - seen.axis * along;
  const double square = across.dot(across), to_middle = -across.dot(seen.aside) / square;
  const Vec3d aside = seen.aside + across * to_middle;
  const double at_middle = seen.height + to_middle * along, radius = seen.radius + to_middle * growth;
  const double a = square - growth * growth, b = across.dot(aside) - radius * growth,
               c = aside.dot(aside) - radius * radius;
  const double discriminant = b * b - a * c, root = std::sqrt(std::max(discriminant, 0.0));
  const double sum = b >= 0 ? -b - root : -b + root;
  const auto parameter = [&](bool enters) { return enters == (b >= 0) ? sum / a : c / sum; };
  const auto is_there = [&](double t) {
    const double height = at_middle + t * along;
    return height >= 0 && height <= seen.length;
  };
  double t = parameter(faces != VisibleFaces::kBack);
  bool is_outer = faces != VisibleFaces::kBack;
  if (is_outer && !is_there(t)) t = parameter(false), is_outer = false;
  const double radius_there = radius + t * growth;
  if (!(discriminant >= 0) || !is_there(t) || !(radius_there > 0)) return beside(cone, from, direction);
  const Vec3d radial = (aside + across * t) * (1 / radius_there);
  const Vec3d outwards = (radial - seen.axis * seen.slope) * seen.per_slant;
  return {from + direction * (to_middle + t), is_outer ? outwards : -outwards};
}

SeenQuadric seen_from(const SphereRecord& sphere, const Vec3d& eye) {
  SeenQuadric seen;
  seen.aside = eye - sphere.center;
  seen.per_slant = 1 / sphere.radius;
  return seen;
}

SeenQuadric seen_from(const ConeRecord& cone, const Vec3d& eye) {
  SeenQuadric seen;
  seen.length = std::sqrt(cone.axis.dot(cone.axis));
  seen.axis = cone.axis * (1 / seen.length);
  seen.slope = cone.radius_change / seen.length;
  seen.per_slant = 1 / std::sqrt(1 + seen.slope * seen.slope);
  const Vec3d from_base = eye - cone.base;
  seen.height = from_base.dot(seen.axis);
  seen.aside = from_base - seen.axis * seen.height;
  seen.radius = cone.base_radius + seen.slope * seen.height;
  return seen;
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

// `first`, `count`: the primitive's own ones in the part. `seen`: if it is round.
LitPoint meet(const ScenePart& part, std::uint32_t first, std::uint32_t count, const SeenQuadric& seen,
              const Vec3d& from, const Vec3d& direction) {
  if (const auto* cones = std::get_if<std::vector<ConeRecord>>(&part.shape))
    return meet((*cones)[first], seen, part.faces, from, direction);
  if (const auto* spheres = std::get_if<std::vector<SphereRecord>>(&part.shape))
    return meet((*spheres)[first], seen, part.faces, from, direction);
  const Mesh& mesh = *std::get_if<Mesh>(&part.shape);
  return part.smooth ? meet_smooth(mesh, first, count, from, direction)
                     : meet_plane(mesh, first, from, direction);
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
  const auto end = part.primitives.end();
  const auto first = std::lower_bound(part.primitives.begin(), end, primitive - 1);
  const auto is_own = [&](std::uint32_t other) { return other == primitive - 1; };
  kept.count = static_cast<std::uint32_t>(std::find_if_not(first, end, is_own) - first);
  if (kept.count == 0) return kept;
  kept.part = &part, kept.first = static_cast<std::uint32_t>(first - part.primitives.begin());
  const BodyPlace* body = pose.place_of(part);
  const Vec3d from = body == nullptr ? eye_ : body->from_world.point(eye_);
  if (const auto* cones = std::get_if<std::vector<ConeRecord>>(&part.shape)) {
    kept.seen = seen_from((*cones)[kept.first], from);
  } else if (const auto* spheres = std::get_if<std::vector<SphereRecord>>(&part.shape)) {
    kept.seen = seen_from((*spheres)[kept.first], from);
  }
  const ShadingMaterial& material = scene.materials[part.materials[kept.first]];
  if (scene.effects.has(Effect::kHighlights) && material.shine > 0)
    kept.least_cosine = least_cosine_of(material.shine);
  return kept;
}

PPRT_CLONED_FOR_WIDE_REGISTERS
void UnshadowedLights::at(const Pose& pose, std::uint32_t primitive, const Camera& camera, double x, double y,
                          UnshadowedLight& light) {
  if (!is_ready_) prepare(pose);
  if (camera.eye != eye_) kept_.fill({}), eye_ = camera.eye;
  const Place& place = place_of(pose, primitive);
  light.is_known = place.part != nullptr;
  if (!light.is_known) return;
  const CompiledScene::Impl& scene = pose.scene();
  const ScenePart& part = *place.part;
  const Vec3d along = ray_direction(camera, x, y);
  const BodyPlace* body = pose.place_of(part);
  LitPoint point;
  if (body == nullptr) {
    point = meet(part, place.first, place.count, place.seen, camera.eye, along);
  } else {
    point = meet(part, place.first, place.count, place.seen, body->from_world.point(camera.eye),
                 body->from_world.vector(along));
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
  const Vec3f mirrored = shines ? Vec3f(mirrored_at(unit(along), point.normal)) : Vec3f(0, 0, 0);
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
