#include <algorithm>
#include <cmath>
#include <limits>

#include "trace/compiled_scene.h"
#include "trace/geometry/numerics.h"
#include "trace/image_shape.h"
#include "trace/pose.h"
#include "trace/projected_textures.h"
#include "trace/ray_tree.h"
#include "trace/scene_impl.h"
#include "trace/shape_bounds.h"
#include "trace/textures/ray_cone.h"
#include "trace/unshadowed_lights.h"

namespace pprt {
namespace {

// Returns how far along its ray a ray may start: for an eye outside the scene, on the sphere about the scene.
// A far eye then costs no digits when the origin is rounded to float.
double distance_to_scene(const CompiledScene::Impl& scene, const Vec3d& eye, const Vec3d& direction) {
  return std::max(0.0, -eye.dot(direction) - scene.radius);
}

bool is_glass(const CompiledScene::Impl& scene, MaterialIndex material) {
  const ShadingMaterial& m = scene.materials[material];
  return scene.effects.has(Effect::kRefraction) && m.transmittance > 0 && m.refractive_index != 1;
}

// Returns how many times a line leaves glass less how many times it enters it, from `origin` on.
int times_left(const Pose& pose, Vec3d origin, const Vec3f& direction) {
  constexpr int kMostSurfaces = 1000;  // far more than what anybody looks through
  int left = 0;
  for (int i = 0; i < kMostSurfaces; ++i) {
    const std::optional<VisibleSurface> surface = visible_surface(pose, Vec3f(origin), direction);
    if (!surface) break;
    if (is_glass(pose.scene(), surface->material)) left += surface->entering ? -1 : 1;
    origin = surface->beyond;
  }
  return left;
}

// Returns the cone of an eye ray where it starts, `distance` from the eye. `footprint`: its width in pixels.
RayCone eye_cone(const Camera& camera, const Vec3d& direction, double footprint, double distance) {
  const double spread = footprint * camera.slope_per_pixel * direction.dot(camera.forward);
  return {spread * distance, spread};
}

}  // namespace

Tracer::Tracer(const CompiledScene& scene, const Camera& camera)
    : scene_(scene),
      pose_(std::make_unique<Pose>(scene.impl())),
      textures_(std::make_unique<ProjectedTextures>()),
      lights_(std::make_unique<UnshadowedLights>()),
      camera_(camera) {}
Tracer::Tracer(Tracer&&) noexcept = default;
Tracer::~Tracer() = default;

void Tracer::set_camera(const Camera& camera) {
  camera_ = camera;
  textures_->clear();
}

bool Tracer::set_time(double time) {
  textures_->clear();
  lights_->clear();
  return pose_->set_time(time);
}

Carried Tracer::carry(RaySample& sample) const {
  return pose_->carry(sample);
}

RaySample Tracer::trace(double x, double y, std::span<const KnownLights> known, double footprint) {
  const Vec3d direction = unit(ray_direction(camera_, x, y));
  const double start = distance_to_scene(scene_.impl(), camera_.eye, direction);
  const Vec3d origin = camera_.eye + direction * start;
  RayCone cone;
  if (scene_.impl().effects.has(Effect::kTextures)) cone = eye_cone(camera_, direction, footprint, start);
  return trace_ray_tree(*pose_, Vec3f(origin), Vec3f(direction), cone, known, counts_);
}

FirstHit Tracer::first_hit(double x, double y) const {
  const Vec3d direction = unit(ray_direction(camera_, x, y));
  const Vec3d origin = camera_.eye + direction * distance_to_scene(scene_.impl(), camera_.eye, direction);
  const std::optional<VisibleSurface> surface = visible_surface(*pose_, Vec3f(origin), Vec3f(direction));
  if (!surface) return {};
  constexpr double kMost = std::numeric_limits<float>::max();
  const double depth = (surface->position - camera_.eye).dot(camera_.forward);
  return {static_cast<float>(std::clamp(depth / scene_.impl().normalisation.scale, -kMost, kMost)),
          Vec3f(surface->normal), surface->primitive + 1, surface->material + 1};
}

GlassSeen Tracer::glass_seen(double x, double y) const {
  const Vec3d direction = unit(ray_direction(camera_, x, y));
  const Vec3d origin = camera_.eye + direction * distance_to_scene(scene_.impl(), camera_.eye, direction);
  const std::optional<VisibleSurface> surface = visible_surface(*pose_, Vec3f(origin), Vec3f(direction));
  if (!surface || !is_glass(scene_.impl(), surface->material)) return {};
  const bool inside_out =
      !surface->entering && 1 + times_left(*pose_, surface->beyond, Vec3f(direction)) <= 0;
  return {true, inside_out, surface->primitive + 1};
}

bool Tracer::visible(const Vec3f& hit, bool at_infinity) {
  ++counts_.visibility;
  const Vec3d to_hit = at_infinity ? Vec3d(hit) : Vec3d(hit) - camera_.eye;
  const double distance = std::sqrt(to_hit.dot(to_hit));
  const Vec3d direction = to_hit * (1 / distance);
  const double start = distance_to_scene(scene_.impl(), camera_.eye, direction);
  const Vec3d origin = camera_.eye + direction * start;
  const double reach = std::max(sum_of_coordinates(Vec3d(hit)), sum_of_coordinates(origin));
  const double gap = visibility_gap(reach) + kFlattestCosine * instance_offset(pose_->rounding(), reach);
  const double length = at_infinity ? std::numeric_limits<double>::infinity() : distance - start - gap;
  if (!(length > 0)) return true;
  return !occluded(*pose_, Vec3f(origin), Vec3f(direction), static_cast<float>(length));
}

std::uint32_t Tracer::primitive_count() const {
  const Inventory& of = scene_.impl().inventory;
  return static_cast<std::uint32_t>(of.spheres + of.cones + of.polygons + of.patches + of.triangles +
                                    of.moving_triangles);
}

std::span<const std::uint32_t> Tracer::surfaces() const {
  return scene_.impl().surfaces;
}

std::span<const std::uint8_t> Tracer::primitives_with_pictures() const {
  return scene_.impl().with_pictures;
}

std::optional<Color> Tracer::texture_over(std::uint32_t primitive, double x, double y, double side,
                                          int per_side) {
  return textures_->of(*pose_, primitive, camera_).over(x, y, side, per_side);
}

std::span<const LitSurface> Tracer::lit_surfaces() const {
  return scene_.impl().lit_surfaces;
}

void Tracer::unshadowed_light(std::uint32_t primitive, double x, double y, UnshadowedLight& light) {
  lights_->at(*pose_, primitive, camera_, x, y, light);
}

void Tracer::project(std::uint32_t primitive, ImageShape& shape) const {
  if (primitive - 1 < primitive_count()) {
    project_primitive(*pose_, primitive, camera_, shape);
  } else {
    shape.kind = ImageShape::Kind::kUnknown;
  }
}

void Tracer::bound(std::uint32_t first, std::span<ShapeBounds> bounds) const {
  bound_primitives(*pose_, first, camera_, bounds);
}

}  // namespace pprt
