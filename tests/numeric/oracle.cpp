#include "numeric/oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace pprt::test {
namespace {

using Real = long double;
using Vec = Imath::Vec3<Real>;

constexpr int kMaxDepth = 5;
constexpr Real kInfinity = std::numeric_limits<Real>::infinity();

// Least distance of a new hit from the surface that a ray leaves, as a share of the scene's size. Far above
// the rounding of long double (1e-19) and far below any detail.
constexpr Real kLeaving = 1e-12L;

// From NFF's conventions, Haines' reader, and the tracer's documented choices.
constexpr Real kAmbientReflectance = 0.1L;
constexpr double kNoHighlightFrom = 1e5;
constexpr Real kLeastCosine = 1 / 1024.0L;

struct Ray {
  Vec origin;
  Vec direction;  // unit
  Real nearest;   // hits count strictly between the two
  Real farthest;
};

struct Hit {
  Real t = kInfinity;
  Vec position{0, 0, 0};
  Vec normal{0, 0, 1};   // unit, of the surface: outwards, or towards a counter-clockwise winding
  Vec shading{0, 0, 1};  // unit, on any side
  Vec rise{0, 0, 0};     // from the position to the surface that a patch's normals describe
  MaterialIndex material = 0;
};

Vec unit(const Vec& v) {
  return v / std::sqrt(v.dot(v));
}

Vec at(const Ray& ray, Real t) {
  return ray.origin + ray.direction * t;
}

// A polygon or patch with the values that every ray needs.
struct Plate {
  std::vector<Vec> corners;
  std::vector<Vec> normals;  // of a patch, unit or zero
  Vec normal{0, 0, 1};
  int u = 0, v = 1;  // the coordinates in which it is largest
  MaterialIndex material = 0;
};

Plate plate_of(std::vector<Vec> corners, MaterialIndex material) {
  Plate plate;
  plate.material = material;
  Vec newell(0, 0, 0);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec &a = corners[i], &b = corners[(i + 1) % corners.size()];
    newell += Vec((a.y - b.y) * (a.z + b.z), (a.z - b.z) * (a.x + b.x), (a.x - b.x) * (a.y + b.y));
  }
  plate.corners = std::move(corners);
  plate.normal = unit(newell);
  int largest = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(newell[i]) > std::abs(newell[largest])) largest = i;
  }
  plate.u = (largest + 1) % 3;
  plate.v = (largest + 2) % 3;
  return plate;
}

// Even-odd rule: counts the edges that a line along u from the point crosses.
bool holds(const Plate& plate, const Vec& p) {
  bool inside = false;
  const auto& c = plate.corners;
  for (std::size_t i = 0, before = c.size() - 1; i < c.size(); before = i++) {
    const Real au = c[before][plate.u], av = c[before][plate.v], bu = c[i][plate.u], bv = c[i][plate.v];
    if ((av > p[plate.v]) == (bv > p[plate.v])) continue;
    if (p[plate.u] < au + (p[plate.v] - av) * ((bu - au) / (bv - av))) inside = !inside;
  }
  return inside;
}

// Returns the mean of the vertices' normals, weighted by the opposite areas.
Vec interpolated_normal(const Plate& patch, const Vec& p) {
  Vec sum(0, 0, 0);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec &b = patch.corners[(i + 1) % 3], &c = patch.corners[(i + 2) % 3];
    sum += patch.normals[i] * (b - p).cross(c - p).dot(patch.normal);
  }
  return sum.dot(sum) > 0 ? unit(sum) : patch.normal;
}

// Returns the mean of what the vertices' tangent planes lie above a point on the side that is seen, weighted
// by the opposite areas. Source: Hanika, Hacking the Shadow Terminator, in Ray Tracing Gems II, 2021.
Vec rise_above(const Plate& patch, const Vec& p, const Vec& side) {
  Vec sum(0, 0, 0);
  Real area = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec &b = patch.corners[(i + 1) % 3], &c = patch.corners[(i + 2) % 3];
    const Real weight = (b - p).cross(c - p).dot(patch.normal);
    const Vec normal = patch.normals[i] * Real(patch.normals[i].dot(side) < 0 ? -1 : 1);
    sum += normal * (weight * std::max((patch.corners[i] - p).dot(normal), Real(0)));
    area += weight;
  }
  return sum / area;
}

void meet(const Plate& plate, const Ray& ray, Hit& hit) {
  const Real slope = plate.normal.dot(ray.direction);
  if (slope == 0) return;
  const Real t = (plate.corners[0] - ray.origin).dot(plate.normal) / slope;
  if (!(t > ray.nearest && t < std::min(ray.farthest, hit.t))) return;
  const Vec p = at(ray, t);
  if (!holds(plate, p)) return;
  hit = {.t = t, .position = p, .normal = plate.normal, .shading = plate.normal, .material = plate.material};
  if (plate.normals.empty()) return;
  hit.shading = interpolated_normal(plate, p);
  hit.rise = rise_above(plate, p, slope < 0 ? plate.normal : -plate.normal);
}

// Considers a crossing with a curved surface. Its outward normal decides which face is seen.
void consider(const Ray& ray, Real t, const Vec& outwards, bool inside_only, MaterialIndex material,
              Hit& hit) {
  if (!(t > ray.nearest && t < std::min(ray.farthest, hit.t))) return;
  if (inside_only && outwards.dot(ray.direction) < 0) return;
  hit = {.t = t, .position = at(ray, t), .normal = outwards, .shading = outwards, .material = material};
}

// Starts where the ray passes the centre; the hits are half the chord away on both sides.
void meet(const Sphere& sphere, const Ray& ray, Hit& hit) {
  const Vec center(sphere.center);
  const Real middle = (center - ray.origin).dot(ray.direction);
  const Vec aside = at(ray, middle) - center;
  const Real radius = std::abs(static_cast<Real>(sphere.radius));
  const Real half_chord2 = (radius - std::sqrt(aside.dot(aside))) * (radius + std::sqrt(aside.dot(aside)));
  if (!(half_chord2 >= 0)) return;
  for (const Real sign : {-1, 1}) {
    const Real t = middle + sign * std::sqrt(half_chord2);
    consider(ray, t, unit(at(ray, t) - center), sphere.radius < 0, sphere.material, hit);
  }
}

// In cylindrical coordinates the distance from the axis is linear in the height. Squares would cancel far
// from the cone, and far above a flat one, so the ray starts near it.
void meet(const Cone& cone, const Ray& ray, Hit& hit) {
  const Vec base(cone.base), apex(cone.apex);
  const Real length = std::sqrt((apex - base).dot(apex - base));
  const Vec axis = unit(apex - base);
  const Real r0 = std::abs(static_cast<Real>(cone.base_radius));
  const Real growth = (std::abs(static_cast<Real>(cone.apex_radius)) - r0) / length;

  const Real rise = ray.direction.dot(axis);
  const bool flat = std::abs(growth) > 1 && std::abs(rise) > 1e-3L;
  const Real start = flat ? (base - ray.origin).dot(axis) / rise : (base - ray.origin).dot(ray.direction);
  const Vec from_base = at(ray, start) - base;
  const Real height = flat ? 0 : from_base.dot(axis);
  const Vec across = ray.direction - axis * rise, aside = from_base - axis * height;
  const Real radius = r0 + growth * height, widening = growth * rise;
  const Real a = across.dot(across) - widening * widening;
  const Real half_b = across.dot(aside) - widening * radius;
  const Real c = aside.dot(aside) - radius * radius;
  const Real discriminant = half_b * half_b - a * c;
  if (!(discriminant >= 0)) return;
  const Real sum = -half_b - std::copysign(std::sqrt(discriminant), half_b);
  for (const Real t : {sum / a, c / sum}) {
    const Real h = height + t * rise;
    if (!(h >= 0 && h <= length)) continue;  // also where a or sum is 0
    const Vec from_axis = aside + across * t;
    consider(ray, start + t, unit(unit(from_axis) - axis * growth), cone.base_radius < 0, cone.material, hit);
  }
}

class Oracle {
 public:
  explicit Oracle(const SceneDescription& scene) : scene_(scene) {
    const Box3d box = bounds(scene);
    leaving_ = kLeaving * static_cast<Real>((box.max - box.min).length());
    light_weight_ = 0.5L / std::sqrt(static_cast<Real>(std::max<std::size_t>(scene.lights.size(), 1)));
    for (const Polygon& p : scene.polygons) {
      std::vector<Vec> corners;
      for (const Vec3d& v : scene.vertices(p)) corners.emplace_back(v);
      plates_.push_back(plate_of(std::move(corners), p.material));
    }
    for (const Patch& p : scene.patches) {
      if (p.vertex_count != 3) throw std::invalid_argument("the oracle knows triangular patches only");
      std::vector<Vec> corners, normals;
      for (const PatchVertex& v : scene.vertices(p)) {
        corners.emplace_back(v.position);
        normals.push_back(v.normal == Vec3d(0, 0, 0) ? Vec(0, 0, 0) : unit(Vec(v.normal)));
      }
      plates_.push_back(plate_of(std::move(corners), p.material));
      plates_.back().normals = std::move(normals);
    }
  }

  Vec eye_ray_color(const Vec& eye, const Vec& direction) const {
    return color_of({eye, direction, 0, kInfinity}, 1);
  }

 private:
  std::optional<Hit> first_hit(const Ray& ray) const {
    Hit hit;
    for (const Sphere& s : scene_.spheres) meet(s, ray, hit);
    for (const Cone& c : scene_.cones) meet(c, ray, hit);
    for (const Plate& p : plates_) meet(p, ray, hit);
    return hit.t < kInfinity ? std::optional(hit) : std::nullopt;
  }

  Vec color_of(const Ray& ray, int depth) const {
    std::optional<Hit> hit = first_hit(ray);
    if (!hit) return Vec(scene_.background.value_or(Rgb(0, 0, 0)));
    const bool entering = hit->normal.dot(ray.direction) < 0;
    if (!entering) hit->normal = -hit->normal;
    if (hit->shading.dot(hit->normal) < 0) hit->shading = -hit->shading;
    const Material& material = scene_.materials[hit->material];

    Vec color = Vec(material.color) * (kAmbientReflectance * light_weight_);
    for (const Light& light : scene_.lights) color += lit_by(light, *hit, ray, material);
    if (depth == kMaxDepth) return color;
    if (material.specular > 0) {
      const Vec away = lifted(mirrored(ray.direction, hit->shading), hit->normal);
      color += leave(*hit, away, depth) * static_cast<Real>(material.specular);
    }
    if (material.transmittance > 0) {
      if (const std::optional<Vec> through = refracted(ray.direction, hit->shading, material, entering)) {
        color +=
            leave(*hit, lifted(*through, -hit->normal), depth) * static_cast<Real>(material.transmittance);
      }
    }
    return color;
  }

  Vec leave(const Hit& hit, const Vec& direction, int depth) const {
    return color_of({hit.position, direction, leaving_, kInfinity}, depth + 1);
  }

  Vec lit_by(const Light& light, const Hit& hit, const Ray& ray, const Material& material) const {
    const Vec from = hit.position + hit.rise;
    const Vec way = Vec(light.position) - from;
    const Real length = std::sqrt(way.dot(way));
    const Vec direction = way / length;
    const Real cosine = hit.shading.dot(direction);
    if (!(cosine > 0)) return Vec(0, 0, 0);
    // A patch shadows itself where a light is behind it, whatever its interpolated normal. Above it, its
    // plate does.
    const bool behind = !(hit.normal.dot(direction) > 0) && !(hit.rise.dot(hit.normal) > leaving_);
    if (behind || first_hit({from, direction, leaving_, length})) return Vec(0, 0, 0);
    const Vec color = Vec(light.color.value_or(Rgb(1, 1, 1))) * light_weight_;
    Vec sum = color * Vec(material.color) * (static_cast<Real>(material.diffuse) * cosine);
    if (material.shine > 0 && material.shine < kNoHighlightFrom) {
      const Real along = std::max(mirrored(ray.direction, hit.shading).dot(direction), Real(0));
      const Real shine = std::pow(along, static_cast<Real>(material.shine));
      sum += color * (static_cast<Real>(material.specular) * shine);
    }
    return sum;
  }

  static Vec mirrored(const Vec& direction, const Vec& normal) {
    return direction - normal * (2 * direction.dot(normal));
  }

  // Refracts by Snell's law, with components along and across the normal. Empty for total internal
  // reflection.
  static std::optional<Vec> refracted(const Vec& direction, const Vec& normal, const Material& material,
                                      bool entering) {
    const Real index = material.refractive_index > 0 ? static_cast<Real>(material.refractive_index) : 1;
    const Vec across = (direction - normal * direction.dot(normal)) * (entering ? 1 / index : index);
    const Real sine2 = across.dot(across);
    if (sine2 >= 1) return std::nullopt;
    return across - normal * std::sqrt(1 - sine2);
  }

  // An interpolated normal may send a ray through the surface that it should leave.
  static Vec lifted(const Vec& direction, const Vec& above) {
    const Real missing = kLeastCosine - direction.dot(above);
    return missing > 0 ? unit(direction + above * missing) : direction;
  }

  const SceneDescription& scene_;
  std::vector<Plate> plates_;
  Real leaving_ = 0;
  Real light_weight_ = 1;
};

}  // namespace

std::vector<Rgb> oracle_picture(const SceneDescription& scene, int size) {
  const Oracle oracle(scene);
  const View& view = scene.view.value();
  const Vec eye(view.from);
  const Vec forward = unit(Vec(view.at) - eye);
  const Vec right = unit(forward.cross(Vec(view.up)));
  const Vec up = right.cross(forward);
  const Real half = std::tan(static_cast<Real>(view.angle_degrees) * std::numbers::pi_v<Real> / 360);
  // The angle spans the centres of the first and last pixel.
  const auto offset = [&](int i) { return half * (2 * static_cast<Real>(i) / (size - 1) - 1); };
  std::vector<Rgb> picture;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const Vec direction = unit(forward + right * offset(x) - up * offset(y));
      const Vec color = oracle.eye_ray_color(eye, direction);
      picture.emplace_back(static_cast<double>(color.x), static_cast<double>(color.y),
                           static_cast<double>(color.z));
    }
  }
  return picture;
}

}  // namespace pprt::test
