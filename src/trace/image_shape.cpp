#include "trace/image_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "trace/pose.h"

namespace pprt {
namespace {

// Least clearance of the eye from a quadric, |c| / size as in `solve`. Below it the eye is so near that
// rounding decides. Counted from: c errs by some 2^-50 of `size`. Test: image_shape_test.cpp.
constexpr double kLeastClearance = 1e-9;

// Least volume of a facet and the eye, relative to the product of the vertices' distances. Below it rounding
// decides which face is visible. Counted from: the volume errs by some 2^-50 of that product. Test:
// image_shape_test.cpp.
constexpr double kLeastVolume = 1e-14;

// The direction d of the eye ray (base/camera.h) as a linear function of the image point.
class EyeRay {
 public:
  explicit EyeRay(const Camera& camera)
      : origin_(ray_direction(camera, 0, 0)),
        per_x_(camera.right * camera.slope_per_pixel),
        per_y_(camera.up * -camera.slope_per_pixel) {}

  LinearForm dot(const Vec3d& v) const { return {origin_.dot(v), per_x_.dot(v), per_y_.dot(v)}; }

  QuadraticForm squared() const { return squared(origin_, per_x_, per_y_); }

  // Returns |d x v|^2.
  QuadraticForm cross_squared(const Vec3d& v) const {
    return squared(origin_.cross(v), per_x_.cross(v), per_y_.cross(v));
  }

 private:
  static QuadraticForm squared(const Vec3d& origin, const Vec3d& per_x, const Vec3d& per_y) {
    return {origin.dot(origin), 2 * origin.dot(per_x), 2 * origin.dot(per_y),
            per_x.dot(per_x),   2 * per_x.dot(per_y),  per_y.dot(per_y)};
  }

  Vec3d origin_, per_x_, per_y_;
};

LinearForm scaled(const LinearForm& f, double by) {
  return {f.constant * by, f.per_x * by, f.per_y * by};
}

QuadraticForm scaled(const QuadraticForm& f, double by) {
  return {f.constant * by, f.per_x * by, f.per_y * by, f.per_xx * by, f.per_xy * by, f.per_yy * by};
}

QuadraticForm difference(const QuadraticForm& f, const QuadraticForm& g) {
  return {f.constant - g.constant, f.per_x - g.per_x,   f.per_y - g.per_y,
          f.per_xx - g.per_xx,     f.per_xy - g.per_xy, f.per_yy - g.per_yy};
}

QuadraticForm square(const LinearForm& f) {
  return {f.constant * f.constant, 2 * f.constant * f.per_x, 2 * f.constant * f.per_y,
          f.per_x * f.per_x,       2 * f.per_x * f.per_y,    f.per_y * f.per_y};
}

// Solves c n^2 + 2 b n + a = 0 for the nearness n. `c` is positive when the eye is outside of the body, which
// is infinite for a cone, `size` the magnitude of the terms whose difference it is. From inside, a ray leaves
// the body first: its faces change places. Returns false when the eye is too near to the surface.
bool solve(const QuadraticForm& a, const LinearForm& b, double c, double size, ImageQuadric& seen) {
  if (!(std::fabs(c) > kLeastClearance * size)) return false;
  if (c < 0) std::swap(seen.front, seen.back);
  seen.middle = scaled(b, 1 / c);
  seen.discriminant = difference(square(seen.middle), scaled(a, 1 / c));
  return true;
}

// Returns the box about a sphere's ellipse, discriminant >= 0. Over all y the discriminant is at most
// (by + axy x)^2 / (-4 ayy) more than at y = 0. That maximum is a quadratic in x, whose roots are the ends in
// x. The ends in y are found alike. The box is grown by what rounding may take from it: a 2^-20th of its
// distance from the image's corner.
ImageBounds bounds_of(const ImageQuadric& sphere) {
  const QuadraticForm& q = sphere.discriminant;
  const double determinant = 4 * q.per_xx * q.per_yy - q.per_xy * q.per_xy;
  if (!(q.per_xx < 0 && q.per_yy < 0 && determinant > 0)) return kEverywhere;
  struct Interval {
    double middle, reach;
  };
  const auto ends = [&](double by, double other, double ayy) -> Interval {
    const double half = 2 * by * ayy - other * q.per_xy, rest = 4 * q.constant * ayy - other * other;
    return {-half / determinant, std::sqrt(std::max(half * half - determinant * rest, 0.0)) / determinant};
  };
  const Interval x = ends(q.per_x, q.per_y, q.per_yy), y = ends(q.per_y, q.per_x, q.per_xx);
  if (!(sphere.middle.at(x.middle, y.middle) < 0)) return kNowhere;  // behind the eye
  constexpr double kGrowth = 0x1p-20, kLeast = 0x1p-10;
  const auto grown = [](const Interval& i) { return i.reach + kGrowth * std::fabs(i.middle) + kLeast; };
  return {static_cast<float>(x.middle - grown(x)), static_cast<float>(y.middle - grown(y)),
          static_cast<float>(x.middle + grown(x)), static_cast<float>(y.middle + grown(y))};
}

// Returns an upper bound of a sphere's nearness within its bounds. The discriminant is greatest in the middle
// of the ellipse, and what is linear at a corner of the box.
float nearest_of(const ImageQuadric& sphere) {
  const ImageBounds& b = sphere.bounds;
  if (b.x0 > b.x1) return 0;
  if (b.x0 == kEverywhere.x0) return std::numeric_limits<float>::infinity();
  const double x = 0.5 * (static_cast<double>(b.x0) + b.x1), y = 0.5 * (static_cast<double>(b.y0) + b.y1);
  const double discriminant = std::max(sphere.discriminant.at(x, y), 0.0), middle = sphere.middle.at(x, y);
  const double slope =
      std::fabs(sphere.middle.per_x) * (b.x1 - x) + std::fabs(sphere.middle.per_y) * (b.y1 - y);
  constexpr double kGrowth = 1 + 0x1p-16;  // float's rounding, and that of the middle
  return static_cast<float>((std::sqrt(discriminant) - middle + slope) * kGrowth);
}

// These equations are those of quadrics.h for the ray d / n from the eye, multiplied by n^2.
bool project(const SphereRecord& sphere, const Camera& camera, const EyeRay& ray, ImageQuadric& seen) {
  const Vec3d from_center = camera.eye - sphere.center;
  const double distance2 = from_center.dot(from_center);
  seen.has_ends = false;
  if (!solve(ray.squared(), ray.dot(from_center), distance2 - sphere.radius * sphere.radius, distance2, seen))
    return false;
  seen.bounds = bounds_of(seen);
  seen.nearest = nearest_of(seen);
  return true;
}

// The box about a cone is that about spheres of its ends: it lies in their convex hull. Where one of them is
// not wholly before the eye it is unknown.
void bound(const ConeRecord& cone, const Camera& camera, const EyeRay& ray, ImageQuadric& seen) {
  constexpr double kLeastRadius = 0x1p-40;  // of an apex, to the distance of the eye
  ImageBounds box = kNowhere;
  float nearest = 0;
  for (const double end : {0.0, 1.0}) {
    const Vec3d center = cone.base + cone.axis * end, from_center = camera.eye - center;
    const double radius = std::max(cone.base_radius + cone.radius_change * end,
                                   kLeastRadius * std::sqrt(from_center.dot(from_center)));
    ImageQuadric sphere;
    if (!project(SphereRecord{center, radius}, camera, ray, sphere)) return;
    if (sphere.bounds.x0 > sphere.bounds.x1 || sphere.bounds.x0 == kEverywhere.x0) return;
    box = end == 0 ? sphere.bounds : around(box, sphere.bounds);
    nearest = std::max(nearest, sphere.nearest);
  }
  seen.bounds = box, seen.nearest = nearest;
}

bool project(const ConeRecord& cone, const Camera& camera, const EyeRay& ray, ImageQuadric& seen) {
  const Vec3d from_base = camera.eye - cone.base;
  const Vec3d aside = from_base.cross(cone.axis);
  const double length2 = cone.axis.dot(cone.axis), height = from_base.dot(cone.axis);
  const double radius = cone.base_radius * length2 + cone.radius_change * height;
  const double aside2 = length2 * aside.dot(aside);
  const LinearForm growth = ray.dot(cone.axis * cone.radius_change);
  seen.has_ends = true;
  seen.along = ray.dot(cone.axis);
  seen.height = height;
  seen.top = length2;
  seen.bounds = kEverywhere, seen.nearest = std::numeric_limits<float>::infinity();
  bound(cone, camera, ray, seen);
  // (d x axis) . aside = d . (axis x aside)
  const Vec3d b = cone.axis.cross(aside) * length2 - cone.axis * (cone.radius_change * radius);
  return solve(difference(scaled(ray.cross_squared(cone.axis), length2), square(growth)), ray.dot(b),
               aside2 - radius * radius, aside2 + radius * radius, seen);
}

// An edge function is the plane through the eye and two vertices. It needs no division, so vertices may lie
// behind the eye. Returns nothing when the facet is seen edge-on.
std::optional<ImageFacet> project(const std::array<Vec3d, 3>& vertices, const Camera& camera,
                                  const EyeRay& ray) {
  const Vec3d a = vertices[0] - camera.eye, b = vertices[1] - camera.eye, c = vertices[2] - camera.eye;
  const double volume = a.dot(b.cross(c)), size = std::fabs(volume);
  const double largest2 = a.dot(a) * b.dot(b) * c.dot(c);
  if (!(size * size > kLeastVolume * kLeastVolume * largest2)) return std::nullopt;
  const double side = volume < 0 ? -1 : 1;
  ImageFacet facet;
  facet.edges = {ray.dot(b.cross(c) * side), ray.dot(c.cross(a) * side), ray.dot(a.cross(b) * side)};
  // The normal, scaled so that the facet's plane is normal . p = 1.
  facet.nearness = ray.dot((b.cross(c) + c.cross(a) + a.cross(b)) * (side / size));
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  ImageBounds& box = facet.bounds;
  box = {kInfinity, kInfinity, -kInfinity, -kInfinity};
  for (const Vec3d& vertex : {a, b, c}) {
    const std::optional<Vec2d> point = pprt::project(camera, vertex);
    if (!point) {
      box = {-kInfinity, -kInfinity, kInfinity, kInfinity};
      break;
    }
    const auto x = static_cast<float>(point->x), y = static_cast<float>(point->y);
    box = {std::min(box.x0, x), std::min(box.y0, y), std::max(box.x1, x), std::max(box.y1, y)};
  }
  return facet;
}

bool is_seen(const Facet& facet, const Vec3d& from_eye, VisibleFaces faces) {
  if (faces == VisibleFaces::kBoth) return true;
  const bool front = Vec3d(facet.normal).dot(from_eye) < 0;
  return front == (faces == VisibleFaces::kFront);
}

// Returns the camera in a body's space: with the same rays, whose parameters are the same.
Camera seen_from(const BodyPlace& body, Camera camera) {
  const Affine& map = body.from_world;
  camera.eye = map.point(camera.eye);
  camera.right = map.vector(camera.right), camera.up = map.vector(camera.up);
  camera.forward = map.vector(camera.forward);
  return camera;
}

// `body`: where the part stands; null: in the world.
void project(const ScenePart& part, const BodyPlace* body, std::size_t first, std::size_t last,
             const Camera& camera, ImageShape& shape) {
  shape.quadric.front = part.faces != VisibleFaces::kBack;
  shape.quadric.back = part.faces != VisibleFaces::kFront;
  bool known = true;
  const auto* spheres = std::get_if<std::vector<SphereRecord>>(&part.shape);
  const auto* cones = std::get_if<std::vector<ConeRecord>>(&part.shape);
  if (spheres || cones) {
    shape.kind = ImageShape::Kind::kQuadric;
    const Camera own = body ? seen_from(*body, camera) : camera;
    const EyeRay ray(own);
    known = spheres ? project((*spheres)[first], own, ray, shape.quadric)
                    : project((*cones)[first], own, ray, shape.quadric);
  } else {
    shape.kind = ImageShape::Kind::kFacets;
    const Mesh& mesh = std::get<Mesh>(part.shape);
    const Vec3d eye = body ? body->from_world.point(camera.eye) : camera.eye;
    const EyeRay ray(camera);
    for (std::size_t i = first; i < last; ++i) {
      std::array<Vec3d, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) corners[k] = Vec3d(mesh.vertices[mesh.triangles[i][k]]);
      if (!is_seen(mesh.facets[i], corners[0] - eye, part.faces)) continue;
      if (body) {
        for (Vec3d& corner : corners) corner = body->to_world.point(corner);
      }
      if (const auto facet = project(corners, camera, ray)) {
        shape.facets.push_back(*facet);
      }
    }
  }
  if (!known) shape.kind = ImageShape::Kind::kUnknown;
}

}  // namespace

void project_primitive(const Pose& pose, std::uint32_t primitive, const Camera& camera, ImageShape& shape) {
  shape.kind = ImageShape::Kind::kFacets;
  shape.facets.clear();
  const CompiledScene::Impl& scene = pose.scene();
  if (primitive - 1 >= scene.part_of_primitive.size()) return;
  const std::uint32_t number = scene.part_of_primitive[primitive - 1];
  if (number == kNoPart) return;
  const ScenePart& part = pose.part(number);
  const BodyPlace* body = pose.place_of(part);
  if (body && !body->is_shown) return;
  // Within a part, primitives are in the description's order.
  const auto first = std::lower_bound(part.primitives.begin(), part.primitives.end(), primitive - 1);
  const auto last =
      std::find_if(first, part.primitives.end(), [&](std::uint32_t other) { return other != primitive - 1; });
  project(part, body, static_cast<std::size_t>(first - part.primitives.begin()),
          static_cast<std::size_t>(last - part.primitives.begin()), camera, shape);
}

}  // namespace pprt
