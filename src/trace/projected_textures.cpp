#include "trace/projected_textures.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "trace/pose.h"
#include "trace/textures/texture_image.h"

namespace pprt {
namespace {

// The picture that a material's colours are multiplied by, or else the one that it gives off.
const TextureImage* picture_of(const ShadingMaterial& material) {
  return material.texture != nullptr ? material.texture : material.emission_texture;
}

LinearForm weighted(const LinearForm& a, double of_a, const LinearForm& b, double of_b, const LinearForm& c,
                    double of_c) {
  return {a.constant * of_a + b.constant * of_b + c.constant * of_c,
          a.per_x * of_a + b.per_x * of_b + c.per_x * of_c, a.per_y * of_a + b.per_y * of_b + c.per_y * of_c};
}

// The weights of the corners b and c at a ray e + t d are quotients of d . (ac x s) and d . (s x ab) by
// d . (ac x ab), with s from corner a to e; d is linear in the image point. Source: Moeller and Trumbore, as
// on_surface().
ProjectedTexture project_texture(const Pose& pose, std::uint32_t primitive, const Camera& camera) {
  const CompiledScene::Impl& scene = pose.scene();
  if (primitive - 1 >= scene.part_of_primitive.size()) return {};
  const std::uint32_t number = scene.part_of_primitive[primitive - 1];
  if (number == kNoPart) return {};
  const ScenePart& part = pose.part(number);
  const auto* mesh = std::get_if<Mesh>(&part.shape);
  if (mesh == nullptr || mesh->texture_points.empty()) return {};
  const auto first = std::lower_bound(part.primitives.begin(), part.primitives.end(), primitive - 1);
  if (first == part.primitives.end() || *first != primitive - 1) return {};
  const auto triangle = static_cast<std::size_t>(first - part.primitives.begin());
  const BodyPlace* body = pose.place_of(part);
  const auto direction = [&](const Vec3d& d) { return body ? body->from_world.vector(d) : d; };

  const TriangleIndices& index = mesh->triangles[triangle];
  const Vec3d a(mesh->vertices[index[0]]);
  const Vec3d ab = Vec3d(mesh->vertices[index[1]]) - a, ac = Vec3d(mesh->vertices[index[2]]) - a;
  const Vec3d from_a = (body ? body->from_world.point(camera.eye) : camera.eye) - a;
  const Vec3d at_origin = direction(ray_direction(camera, 0, 0));
  const Vec3d per_x = direction(camera.right * camera.slope_per_pixel);
  const Vec3d per_y = direction(camera.up * -camera.slope_per_pixel);
  const Vec3d normal = ac.cross(ab);
  const double side = normal.dot(from_a) < 0 ? 1 : -1;  // that of the eye: rays to the plane have w > 0
  const auto form = [&](const Vec3d& v) -> LinearForm {
    return {side * at_origin.dot(v), side * per_x.dot(v), side * per_y.dot(v)};
  };
  const LinearForm whole = form(normal), of_b = form(ac.cross(from_a)), of_c = form(from_a.cross(ab));
  const Vec2d from(mesh->texture_points[index[0]]);
  const Vec2d to_b = Vec2d(mesh->texture_points[index[1]]) - from;
  const Vec2d to_c = Vec2d(mesh->texture_points[index[2]]) - from;
  return {picture_of(scene.materials[part.materials[triangle]]),
          weighted(whole, from.x, of_b, to_b.x, of_c, to_c.x),
          weighted(whole, from.y, of_b, to_b.y, of_c, to_c.y), whole};
}

}  // namespace

std::vector<std::uint8_t> primitives_with_pictures(const CompiledScene::Impl& scene) {
  if (scene.textures.empty()) return {};
  std::vector<std::uint8_t> have(scene.part_of_primitive.size() + 1);
  for (const ScenePart& part : scene.parts) {
    const auto* mesh = std::get_if<Mesh>(&part.shape);
    if (mesh == nullptr || mesh->texture_points.empty()) continue;
    for (std::size_t i = 0; i < part.primitives.size(); ++i)
      if (scene.materials[part.materials[i]].has_picture()) have[part.primitives[i] + 1] = 1;
  }
  return have;
}

// The footprint is a square taken to the picture by the quotients' derivatives in the middle.
std::optional<Color> ProjectedTexture::over(double x, double y, double side, int per_side) const {
  const double inverse = 1 / w.at(x, y);
  if (picture == nullptr || !(inverse > 0) || !std::isfinite(inverse)) return std::nullopt;
  const Vec2d middle(u.at(x, y) * inverse, v.at(x, y) * inverse);
  const double scale = side / per_side * inverse;
  const Vec2d per_x((u.per_x - middle.x * w.per_x) * scale, (v.per_x - middle.y * w.per_x) * scale);
  const Vec2d per_y((u.per_y - middle.x * w.per_y) * scale, (v.per_y - middle.y * w.per_y) * scale);
  const TextureFootprint each = {per_x.x * per_x.x + per_y.x * per_y.x, per_x.x * per_x.y + per_y.x * per_y.y,
                                 per_x.y * per_x.y + per_y.y * per_y.y};
  if (per_side > 1 && picture->resolves(each))
    return picture->mean({per_side, middle, per_x, per_y, w.per_x * scale, w.per_y * scale});
  // A filter takes as long as many places: half as many squares in a row are filtered.
  const int filtered = std::max(per_side / 2, 1), merged = per_side / filtered;
  const double area = merged * merged;
  const TextureFootprint footprint = {area * each.uu, area * each.uv, area * each.vv};
  Color sum(0, 0, 0);
  float seen = 0;
  for (int j = 0; j < filtered; ++j) {
    for (int i = 0; i < filtered; ++i) {
      const double dx = merged * (i - 0.5 * (filtered - 1)), dy = merged * (j - 0.5 * (filtered - 1));
      const double nearer = 1 + scale * (w.per_x * dx + w.per_y * dy);
      if (!(nearer > TextureImage::kNearestHorizon)) continue;
      sum += picture->over(footprint, middle + (per_x * dx + per_y * dy) * (1 / nearer));
      ++seen;
    }
  }
  return seen > 0 ? std::optional(sum * (1 / seen)) : std::nullopt;
}

const ProjectedTexture& ProjectedTextures::of(const Pose& pose, std::uint32_t primitive,
                                              const Camera& camera) {
  Kept& kept = kept_[primitive % kept_.size()];
  if (kept.primitive != primitive) kept = {primitive, project_texture(pose, primitive, camera)};
  return kept.texture;
}

}  // namespace pprt
