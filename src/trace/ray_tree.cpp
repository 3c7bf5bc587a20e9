#include "trace/ray_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "trace/coincident_faces.h"
#include "trace/geometry/numerics.h"
#include "trace/pose.h"
#include "trace/scene_impl.h"
#include "trace/textures/ray_cone.h"

namespace pprt {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

void set_ray(RTCRay& ray, const Vec3f& origin, const Vec3f& direction, float length) {
  ray.org_x = origin.x;
  ray.org_y = origin.y;
  ray.org_z = origin.z;
  ray.tnear = 0;
  ray.dir_x = direction.x;
  ray.dir_y = direction.y;
  ray.dir_z = direction.z;
  ray.time = 0;
  ray.tfar = length;
  ray.mask = ~0u;
  ray.id = 0;
  ray.flags = 0;
}

// Finds the first hit of a ray; returns whether there is one.
bool intersect(RTCScene scene, RaySender& sender, const Vec3f& origin, const Vec3f& direction, float length,
               RTCRayHit& found) {
  set_ray(found.ray, origin, direction, length);
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  sender.intersect(scene, found);
  return found.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

// Finds the surface that a ray of any length sees.
bool see(const Pose& pose, RaySender& sender, const Vec3f& origin, const Vec3f& direction, RTCRayHit& found) {
  if (!intersect(pose.embree(), sender, origin, direction, kInfinity, found)) return false;
  const ScenePart& part = pose.part(found.hit.geomID);
  if (is_coincident(part, found.hit)) {
    const BodyPlace* body = pose.place_of(part);
    choose_coincident_face(pose.scene(), part.body,
                           body ? body->from_world.point(Vec3d(origin)) : Vec3d(origin),
                           body ? body->from_world.vector(Vec3d(direction)) : Vec3d(direction), found.hit);
  }
  return true;
}

// A hit, recomputed in double from the primitive.
struct Surface {
  Vec3d position{0, 0, 0};
  Vec3d normal{0, 0, 1};   // unit, geometric, against the ray
  Vec3d shading{0, 0, 1};  // unit, on the same side as `normal`
  double offset = 0;       // distance from the surface at which a leaving ray starts
  bool entering = true;    // whether the ray comes from outside
  const ShadingMaterial* material = nullptr;
  Color unlit{0, 0, 0}, diffuse{0, 0, 0};  // of the material, times its pictures
  Vec3d rise{0, 0, 0};                     // from the position to the smooth surface, see rise_to_smooth
  // Only where the scene has textures.
  RayCone cone;          // of the ray that comes
  double curvature = 0;  // mean, > 0 where the smooth surface bulges towards the ray
};

// Takes a surface of a body's compiled space to the world's, where `direction` is the ray's.
void place(const BodyPlace& at, const Vec3d& direction, Surface& surface) {
  const Vec3d normal = at.gradient(surface.normal);
  const double per_height = std::sqrt(normal.dot(normal));  // heights above the surface shrink so
  surface.position = at.to_world.point(surface.position);
  surface.normal = normal * (1 / per_height);
  const double reach = sum_of_coordinates(surface.position);
  surface.offset = surface.offset / per_height + instance_offset(at.rounding, reach + at.distance) +
                   origin_rounding(reach);
  if (surface.normal.dot(direction) > 0) surface.normal = -surface.normal;
  surface.shading = unit(at.gradient(surface.shading));
  if (surface.shading.dot(surface.normal) < 0) surface.shading = -surface.shading;
  surface.curvature *= per_height;
}

// Returns the mean curvature at a point of a part, > 0 where it bulges to the side of the shading normal.
double curvature_of(const ScenePart& part, std::uint32_t primitive, const SurfacePoint& at,
                    const Vec3d& shading, bool is_smooth) {
  const double outwards = at.normal.dot(shading) < 0 ? -1 : 1;
  if (const auto* spheres = std::get_if<std::vector<SphereRecord>>(&part.shape))
    return outwards * mean_curvature((*spheres)[primitive], at.position);
  if (const auto* cones = std::get_if<std::vector<ConeRecord>>(&part.shape))
    return outwards * mean_curvature((*cones)[primitive], at.position);
  if (!is_smooth) return 0;
  const Mesh& mesh = std::get<Mesh>(part.shape);
  const Vec3d normal(mesh.normals[mesh.triangles[primitive][0]]);
  return mean_curvature(mesh, primitive) * (normal.dot(shading) < 0 ? -1 : 1);
}

// Multiplies a placed surface's colours by its pictures, filtered over what its cone covers.
void apply_pictures(const Mesh& mesh, std::uint32_t triangle, const TrianglePoint& at, const BodyPlace* body,
                    const Vec3d& direction, Surface& surface) {
  TextureGradients gradients = texture_gradients(mesh, triangle);
  if (body) gradients = {body->gradient(gradients.u), body->gradient(gradients.v)};
  const TextureFootprint area = footprint(surface.cone.width, direction, surface.normal, gradients);
  const auto tint = [&](const TextureImage* picture) {
    return picture == nullptr ? Color(1, 1, 1)
                              : picture->over(area, texture_point(mesh, triangle, at.u, at.v));
  };
  const ShadingMaterial& material = *surface.material;
  const Color color = tint(material.texture);
  surface.unlit = material.ambient * color + material.emission * tint(material.emission_texture);
  surface.diffuse *= color;
}

// Recomputes a hit from its primitive. `along` is the ray's direction, unit; `cone` its cone where it starts.
Surface surface_at(const Pose& pose, const RTCRayHit& found, const Vec3d& along, const RayCone& cone = {}) {
  const CompiledScene::Impl& scene = pose.scene();
  const ScenePart& part = pose.part(found.hit.geomID);
  const BodyPlace* body = pose.place_of(part);
  const std::uint32_t primitive = found.hit.primID;
  const Vec3d direction = body ? body->from_world.vector(along) : along;
  const auto start = [&] { return Vec3d(found.ray.org_x, found.ray.org_y, found.ray.org_z); };
  const auto origin = [&] { return body ? body->from_world.point(start()) : start(); };
  // A ray that Embree took into a body's space was rounded there, and not alike by all processors.
  const auto near = [&](const auto& record) {
    const Vec3d from = origin();
    const auto t = static_cast<double>(found.ray.tfar);
    return from + direction * (body ? refined(record, from, direction, t) : t);
  };

  Surface surface;
  TrianglePoint at;  // of a triangle
  SurfacePoint point;
  const Mesh* mesh = nullptr;
  const auto meet = [&](const auto& record) {
    point = on_surface(record, near(record));
    surface.offset = quadric_offset(sum_of_coordinates(point.position), extent(record));
  };
  if (const auto* spheres = std::get_if<std::vector<SphereRecord>>(&part.shape)) {
    meet((*spheres)[primitive]);
  } else if (const auto* cones = std::get_if<std::vector<ConeRecord>>(&part.shape)) {
    meet((*cones)[primitive]);
  } else {
    mesh = std::get_if<Mesh>(&part.shape);
    at = on_surface(*mesh, primitive, origin(), direction);
    point = at;
    surface.offset = mesh->facets[primitive].offset;
  }
  surface.position = point.position;
  surface.entering = point.normal.dot(direction) < 0;
  surface.normal = surface.entering ? point.normal : -point.normal;
  surface.shading = surface.normal;
  const bool is_smooth = part.smooth && scene.effects.has(Effect::kSmoothNormals);
  if (is_smooth) {
    const Vec3d normal = shading_normal(*mesh, primitive, at.u, at.v);
    surface.shading = normal.dot(surface.normal) < 0 ? -normal : normal;
    surface.rise = rise_to_smooth(*mesh, primitive, at, surface.normal);
    if (body) surface.rise = body->to_world.vector(surface.rise);
  }
  const ShadingMaterial& material = scene.materials[part.materials[primitive]];
  surface.material = &material;
  surface.unlit = material.unlit;
  surface.diffuse = material.diffuse;
  const bool has_textures = scene.effects.has(Effect::kTextures);
  if (has_textures) surface.curvature = curvature_of(part, primitive, point, surface.shading, is_smooth);
  if (body) place(*body, along, surface);
  if (!has_textures) return surface;
  surface.cone = cone.after((surface.position - start()).dot(along));
  if (material.has_picture() && mesh != nullptr && !mesh->texture_points.empty())
    apply_pictures(*mesh, primitive, at, body, along, surface);
  return surface;
}

// Returns a unit direction with at least kGrazingCosine to the normal `above`.
Vec3d lifted(const Vec3d& direction, const Vec3d& above) {
  const double cosine = direction.dot(above);
  if (cosine >= kGrazingCosine) return direction;
  return unit(direction + above * (kGrazingCosine - cosine));
}

// Mirrors a direction at the plane with the given unit normal.
Vec3d mirrored(const Vec3d& direction, const Vec3d& normal) {
  return direction - normal * (2 * direction.dot(normal));
}

// Refracts by Snell's law. Vectors are unit, the normal against the direction. Returns false on total
// internal reflection.
bool refracted(const Vec3d& direction, const Vec3d& normal, double index_ratio, Vec3d& result) {
  const double cosine = -direction.dot(normal);
  const double sine2 = index_ratio * index_ratio * (1 - cosine * cosine);
  if (!(sine2 < 1)) return false;
  // The tangential part is summed first. Otherwise an extreme ratio cancels both parts at perpendicular
  // incidence.
  result = unit((direction + normal * cosine) * index_ratio - normal * std::sqrt(1 - sine2));
  return true;
}

// The ray tree of one eye ray, with the effects that the scene calls for and no others. `published_`: rays
// are those that the SPD's tables count (CompileOptions::count_as_published): lights and mirrored rays of
// surfaces that they do not change, too.
class RayTree {
 public:
  RayTree(const Pose& pose, RayCounts& counts)
      : pose_(pose),
        scene_(pose.scene()),
        embree_(pose.embree()),
        lights_(pose.lights()),
        counts_(counts),
        effects_(scene_.effects),
        published_(scene_.options.count_as_published) {}

  void follow_eye_ray(const Vec3f& origin, const Vec3f& direction, const RayCone& cone,
                      std::span<const KnownLights> known, RaySample& sample) {
    ++counts_.primary;
    RTCRayHit found;
    if (!see(pose_, sender_, origin, direction, found)) {
      sample.color = background_along(direction);
      sample.hit = direction;
      sample.at_infinity = true;
      return;
    }
    ++counts_.eye_hits;
    const Vec3d d(direction);
    const Surface surface = surface_at(pose_, found, d, cone);
    const ShadingMaterial& material = *surface.material;
    sample.hit = Vec3f(surface.position);
    sample.primitive = scene_.parts[found.hit.geomID].primitives[found.hit.primID] + 1;
    sample.eye_dependent =
        ((has(Effect::kHighlights) || has(Effect::kReflection)) && material.specular > 0) ||
        (has(Effect::kRefraction) && material.transmittance > 0);
    const SeenLights lights = lights_known(known, sample.primitive);
    sample.color = surface.unlit + from_lights<true>(surface, d, lights, sample.lights);
    if (has_secondary_rays()) {
      if (1 < scene_.options.max_depth) sample.color += from_secondary_rays(surface, d, 2);
    }
  }

 private:
  static SeenLights lights_known(std::span<const KnownLights> known, std::uint32_t primitive) {
    for (const KnownLights& at : known) {
      if (at.primitive == primitive) return at.lights;
    }
    return {};
  }

  bool has(Effect effect) const { return effects_.has(effect); }
  bool has_secondary_rays() const { return has(Effect::kReflection) || has(Effect::kRefraction); }

  bool in_shadow(const ShadingLight& light, const Vec3f& origin, const Vec3d& direction, double length) {
    ++counts_.shadow;
    if (!light.contacts.empty()) return in_shadow_of_others(light, origin, direction, length);
    RTCRay ray;
    set_ray(ray, origin, Vec3f(direction), static_cast<float>(length));
    sender_.occluded(embree_, ray);
    return ray.tfar < 0;
  }

  // The same for a light that lies on surfaces: these do not hide it where the ray ends. What comes first on
  // the way decides.
  bool in_shadow_of_others(const ShadingLight& light, const Vec3f& origin, const Vec3d& direction,
                           double length) {
    RTCRayHit found;
    if (!intersect(embree_, sender_, origin, Vec3f(direction), static_cast<float>(length), found))
      return false;
    const double before_light = length - static_cast<double>(found.ray.tfar);
    return std::none_of(light.contacts.begin(), light.contacts.end(), [&](const LightContact& contact) {
      return contact.part == found.hit.geomID && contact.primitive == found.hit.primID &&
             before_light <= static_cast<double>(contact.reach);
    });
  }

  // Returns what a ray sees that meets nothing.
  Color background_along(const Vec3f& direction) const {
    if (!has(Effect::kSky)) return scene_.background;
    const float height = direction.dot(scene_.sky.up);
    return height < 0 ? scene_.background : scene_.sky.at(height);
  }

  // Returns the colour of a secondary ray.
  Color follow(const Vec3d& origin, const Vec3d& direction, const RayCone& cone, int depth) {
    const Vec3f d(direction);
    RTCRayHit found;
    if (!see(pose_, sender_, Vec3f(origin), d, found)) return background_along(d);
    const Vec3d exact(d);
    return shade(surface_at(pose_, found, exact, cone), exact, depth);
  }

  // Returns the colour of a surface seen along `direction`, by NFF's model: emitted, ambient and direct
  // light, and the secondary rays that `depth` allows. An eye ray has depth 1.
  Color shade(const Surface& surface, const Vec3d& direction, int depth) {
    SeenLights unused;
    Color color = surface.unlit + from_lights<false>(surface, direction, {}, unused);
    if (has_secondary_rays()) {
      if (depth < scene_.options.max_depth) color += from_secondary_rays(surface, direction, depth + 1);
    }
    return color;
  }

  // Lambert's diffuse reflection and Phong's highlight, summed over the lights that are not in shadow.
  // kNotes: lights that are `known` are not asked again, and what is found of the others is noted.
  template <bool kNotes>
  Color from_lights(const Surface& surface, const Vec3d& direction, const SeenLights& known,
                    SeenLights& found) {
    const ShadingMaterial& material = *surface.material;
    Color color(0, 0, 0);
    if (!published_ && !material.lit) return color;
    const Vec3d position = surface.position + surface.normal * surface.offset + surface.rise;
    const Vec3f origin(position);
    unsigned bit = 1;  // of the light; 0 after the first eight
    for (const ShadingLight& light : lights_) {
      const unsigned own_bit = std::exchange(bit, bit << 1 & 0xFF);
      const Vec3d to_light = light.position - position;
      const double cosine_length = surface.shading.dot(to_light);
      if (!(cosine_length > 0)) continue;
      const double length = std::sqrt(to_light.dot(to_light));
      const Vec3d unit_to_light = to_light * (1 / length);
      if (has(Effect::kShadows)) {
        const bool is_hidden = kNotes && (known.asked & own_bit) != 0
                                   ? (known.seen & own_bit) == 0
                                   : in_shadow(light, origin, unit_to_light, length);
        if constexpr (kNotes) {
          found.asked = static_cast<std::uint8_t>(found.asked | own_bit);
          if (!is_hidden) found.seen = static_cast<std::uint8_t>(found.seen | own_bit);
        }
        if (is_hidden) continue;
      }
      color += light.color * surface.diffuse * static_cast<float>(cosine_length / length);
      if (has(Effect::kHighlights) && material.shine > 0)
        color += light.color * (material.specular_color * highlight(surface, direction, unit_to_light));
    }
    return color;
  }

  // Phong: cos(angle)^shine, with the angle between the mirrored ray and the light.
  static float highlight(const Surface& surface, const Vec3d& direction, const Vec3d& unit_to_light) {
    const double cosine = mirrored(direction, surface.shading).dot(unit_to_light);
    if (!(cosine > 0)) return 0;
    return std::pow(static_cast<float>(cosine), surface.material->shine);
  }

  // The reflected ray weighted by Ks, and the refracted ray weighted by T.
  Color from_secondary_rays(const Surface& surface, const Vec3d& direction, int depth) {
    const ShadingMaterial& material = *surface.material;
    Color color(0, 0, 0);
    const bool mirrors = has(Effect::kReflection) && material.specular > 0;
    if (mirrors || (published_ && (material.specular > 0 || material.transmittance > 0))) {
      ++counts_.reflection;
      const Vec3d away = lifted(mirrored(direction, surface.shading), surface.normal);
      color += follow(surface.position + surface.normal * surface.offset, away,
                      mirrored(surface.cone, surface.curvature), depth) *
               material.specular_color;
    }
    if (has(Effect::kRefraction) && material.transmittance > 0)
      color += refraction(surface, direction, depth);
    return color;
  }

  Color refraction(const Surface& surface, const Vec3d& direction, int depth) {
    const ShadingMaterial& material = *surface.material;
    const double ratio = surface.entering ? 1 / material.refractive_index : material.refractive_index;
    Vec3d through;
    if (!refracted(direction, surface.shading, ratio, through)) {
      ++counts_.total_internal_reflection;
      if (!material.reflects_totally) return Color(0, 0, 0);
      ++counts_.reflection;
      const Vec3d inwards = lifted(mirrored(direction, surface.shading), surface.normal);
      return follow(surface.position + surface.normal * surface.offset, inwards,
                    mirrored(surface.cone, surface.curvature), depth) *
             material.transmittance;
    }
    ++counts_.refraction;
    RayCone cone;
    if (has(Effect::kTextures)) {
      cone = refracted(surface.cone, surface.curvature, ratio, -direction.dot(surface.shading),
                       -through.dot(surface.shading));
    }
    through = lifted(through, -surface.normal);
    return follow(surface.position - surface.normal * surface.offset, through, cone, depth) *
           material.transmittance;
  }

  const Pose& pose_;
  const CompiledScene::Impl& scene_;
  RTCScene embree_;
  std::span<const ShadingLight> lights_;
  RayCounts& counts_;
  EffectSet effects_;
  bool published_;
  RaySender sender_;
};

}  // namespace

RaySample trace_ray_tree(const Pose& pose, const Vec3f& origin, const Vec3f& direction, const RayCone& cone,
                         std::span<const KnownLights> known, RayCounts& counts) {
  const std::uint64_t before = counts.traced();
  RaySample sample;
  RayTree(pose, counts).follow_eye_ray(origin, direction, cone, known, sample);
  sample.rays = static_cast<std::uint32_t>(counts.traced() - before);
  return sample;
}

std::optional<VisibleSurface> visible_surface(const Pose& pose, const Vec3f& origin, const Vec3f& direction) {
  RaySender sender;
  RTCRayHit found;
  if (!see(pose, sender, origin, direction, found)) return std::nullopt;
  const Surface surface = surface_at(pose, found, Vec3d(direction));
  const ScenePart& part = pose.scene().parts[found.hit.geomID];
  return VisibleSurface{surface.position,
                        surface.shading,
                        part.primitives[found.hit.primID],
                        part.materials[found.hit.primID],
                        surface.entering,
                        surface.position - surface.normal * surface.offset};
}

bool occluded(const Pose& pose, const Vec3f& origin, const Vec3f& direction, float length) {
  RaySender sender;
  RTCRay ray;
  set_ray(ray, origin, direction, length);
  sender.occluded(pose.embree(), ray);
  return ray.tfar < 0;
}

}  // namespace pprt
