#include "trace/shape_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <variant>
#include <vector>

#include "base/simd.h"

namespace pprt {
namespace {

// Boxes are grown by what rounding may take from them: pixels, and a part of the distance from the image's
// corner. Those of projections are grown less, so that they lie within (image_shape.cpp).
constexpr double kLeastGrowth = 0x1p-8, kGrowth = 0x1p-18;

// Relative to the distance of what a box is about: nearer to the plane of the eye it is everywhere.
constexpr double kLeastDepth = 1e-6;

double least_of(const double4& v) {
  return std::min({v[0], v[1], v[2]});
}
double most_of(const double4& v) {
  return std::max({v[0], v[1], v[2]});
}

bool is_nowhere(const ImageBounds& box) {
  return box.x0 > box.x1;
}

// What lies beyond it has normal . p + distance < 0.
struct Plane {
  Vec3d normal;
  double distance;
};
// That of the eye, and those of the image's sides, kMargin pixels outwards.
using ViewPlanes = std::array<Plane, 5>;
constexpr double kMargin = 16;  // a lattice reaches eight pixels beyond the image; more than any rounding

class Frame {
 public:
  explicit Frame(const Camera& camera)
      : eye_(camera.eye),
        right_(camera.right * (1 / camera.slope_per_pixel)),
        down_(camera.up * (-1 / camera.slope_per_pixel)),
        forward_(camera.forward),
        per_pixel_(1 / camera.slope_per_pixel),
        middle_x_(0.5 * camera.width),
        middle_y_(0.5 * camera.height) {}

  // A box about a ball. The quotients of its coordinates' least and greatest values bound it.
  ImageBounds box(const Vec3d& center, double radius) const {
    const Vec3d from_eye = center - eye_;
    const double depth = from_eye.dot(forward_), near = depth - radius, far = depth + radius;
    if (!(far > 0)) return kNowhere;
    if (!(near > kLeastDepth * far)) return kEverywhere;
    const double x = from_eye.dot(right_), y = from_eye.dot(down_), reach = radius * per_pixel_;
    const double per_near = 1 / near, per_far = 1 / far;
    const auto least = [&](double v) {
      return v - reach > 0 ? (v - reach) * per_far : (v - reach) * per_near;
    };
    const auto most = [&](double v) {
      return v + reach > 0 ? (v + reach) * per_near : (v + reach) * per_far;
    };
    return grown(least(x), least(y), most(x), most(y));
  }

  // A box about a triangle. Its corners are lanes 0 to 2; the last lane repeats one of them.
  ImageBounds box(const double4& x, const double4& y, const double4& z) const {
    const double4 dx = x - eye_.x, dy = y - eye_.y, dz = z - eye_.z;
    const auto along = [&](const Vec3d& v) { return dx * v.x + dy * v.y + dz * v.z; };
    const double4 depth = along(forward_), least = kLeastDepth * (abs(dx) + abs(dy) + abs(dz));
    const double4 per_depth = 1 / depth, across = along(right_) * per_depth, down = along(down_) * per_depth;
    const auto in_all = [](const auto& is) { return !any(~__builtin_convertvector(is, int4)); };
    if (in_all(depth > least)) return grown(least_of(across), least_of(down), most_of(across), most_of(down));
    return in_all(depth < -least) ? kNowhere : kEverywhere;
  }

  // The planes in the space that a map takes to the world.
  ViewPlanes planes_in(const Affine& place) const {
    const Vec3d aside = forward_ * (middle_x_ + kMargin), above = forward_ * (middle_y_ + kMargin);
    const auto plane = [&](const Vec3d& n) -> Plane {
      return {{n.dot(place.x), n.dot(place.y), n.dot(place.z)}, n.dot(place.origin - eye_)};
    };
    return {plane(forward_), plane(aside + right_), plane(aside - right_), plane(above + down_),
            plane(above - down_)};
  }

 private:
  // From the image's middle to its corner.
  ImageBounds grown(double x0, double y0, double x1, double y1) const {
    const auto by = [](double middle, double from_middle) {
      return kLeastGrowth + kGrowth * (middle + std::fabs(from_middle));
    };
    return {static_cast<float>(middle_x_ + x0 - by(middle_x_, x0)),
            static_cast<float>(middle_y_ + y0 - by(middle_y_, y0)),
            static_cast<float>(middle_x_ + x1 + by(middle_x_, x1)),
            static_cast<float>(middle_y_ + y1 + by(middle_y_, y1))};
  }

  Vec3d eye_, right_, down_, forward_;
  double per_pixel_, middle_x_, middle_y_;
};

// A cone lies in the convex hull of balls at its ends. If one of them is behind the eye, a part may reach
// before it.
ImageBounds box_of(const ConeRecord& cone, const Frame& frame, const Affine& place, double scale) {
  const ImageBounds base = frame.box(place.point(cone.base), cone.base_radius * scale);
  const ImageBounds apex =
      frame.box(place.point(cone.base + cone.axis), (cone.base_radius + cone.radius_change) * scale);
  if (is_nowhere(base) && is_nowhere(apex)) return kNowhere;
  return is_nowhere(base) || is_nowhere(apex) ? kEverywhere : around(base, apex);
}

// Whether a box lies beyond one of the planes.
bool is_outside(const Box3d& box, const ViewPlanes& planes) {
  const Vec3d middle = (box.min + box.max) * 0.5, half = (box.max - box.min) * 0.5;
  return std::any_of(planes.begin(), planes.end(), [&](const Plane& plane) {
    const double reach = std::fabs(plane.normal.x) * half.x + std::fabs(plane.normal.y) * half.y +
                         std::fabs(plane.normal.z) * half.z;
    return plane.normal.dot(middle) + plane.distance + reach < 0;
  });
}

void add(const ImageBounds& box, ShapeBounds& bounds) {
  if (is_nowhere(box)) return;
  bounds.box = bounds.parts++ == 0 ? box : around(bounds.box, box);
}

// `body`: where the part stands; null: in the world.
PPRT_CLONED_FOR_WIDE_REGISTERS void bound(const ScenePart& part, const BodyPlace* body, const Frame& frame,
                                          std::uint32_t first, std::span<ShapeBounds> bounds) {
  const Affine place = body ? body->to_world : Affine();
  // No vector gets longer by more than this.
  const double scale =
      body ? std::sqrt(place.x.dot(place.x) + place.y.dot(place.y) + place.z.dot(place.z)) : 1;
  const std::vector<std::uint32_t>& primitives = part.primitives;
  const auto number_of = [&](std::uint32_t primitive) {
    const auto at = std::lower_bound(primitives.begin(), primitives.end(), primitive);
    return static_cast<std::size_t>(at - primitives.begin());
  };
  const std::size_t end = number_of(first + static_cast<std::uint32_t>(bounds.size()));
  const ViewPlanes planes = frame.planes_in(place);
  for (std::size_t i = number_of(first), seen_to = i; i < end; ++i) {
    if (!part.boxes.empty() && i >= seen_to) {
      seen_to = (i / kTrianglesInBox + 1) * kTrianglesInBox;
      if (is_outside(part.boxes[i / kTrianglesInBox], planes)) {
        i = seen_to - 1;
        continue;
      }
    }
    ShapeBounds& here = bounds[primitives[i] - first];
    if (const auto* spheres = std::get_if<std::vector<SphereRecord>>(&part.shape)) {
      add(frame.box(place.point((*spheres)[i].center), (*spheres)[i].radius * scale), here);
    } else if (const auto* cones = std::get_if<std::vector<ConeRecord>>(&part.shape)) {
      add(box_of((*cones)[i], frame, place, scale), here);
    } else {
      const Mesh& mesh = std::get<Mesh>(part.shape);
      const TriangleIndices& index = mesh.triangles[i];
      const Vec3f &a = mesh.vertices[index[0]], &b = mesh.vertices[index[1]], &c = mesh.vertices[index[2]];
      const double4 x = {a.x, b.x, c.x, a.x}, y = {a.y, b.y, c.y, a.y}, z = {a.z, b.z, c.z, a.z};
      if (body == nullptr) {
        add(frame.box(x, y, z), here);
        continue;
      }
      const auto placed = [&](int k) {
        return x * place.x[k] + y * place.y[k] + z * place.z[k] + place.origin[k];
      };
      add(frame.box(placed(0), placed(1), placed(2)), here);
    }
  }
}

}  // namespace

std::vector<Box3d> boxes_of(const Mesh& mesh) {
  std::vector<Box3d> boxes;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (i % kTrianglesInBox == 0) boxes.emplace_back();
    for (const std::uint32_t vertex : mesh.triangles[i]) boxes.back().extendBy(Vec3d(mesh.vertices[vertex]));
  }
  return boxes;
}

void bound_primitives(const Pose& pose, std::uint32_t first, const Camera& camera,
                      std::span<ShapeBounds> bounds) {
  std::fill(bounds.begin(), bounds.end(), ShapeBounds());
  const Frame frame(camera);
  for (std::uint32_t i = 0; i < pose.scene().parts.size(); ++i) {
    const ScenePart& part = pose.part(i);
    const BodyPlace* body = pose.place_of(part);
    if (!body || body->is_shown) bound(part, body, frame, first, bounds);
  }
}

}  // namespace pprt
