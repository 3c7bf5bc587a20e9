#include "trace/shape_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <variant>
#include <vector>

namespace pprt {
namespace {

// Boxes are grown by what rounding may take from them: pixels, and a part of the distance from the image's
// corner. Those of projections are grown less, so that they lie within (image_shape.cpp).
constexpr double kLeastGrowth = 0x1p-8, kGrowth = 0x1p-18;

// Relative to the distance of what a box is about: nearer to the plane of the eye it is everywhere.
constexpr double kLeastDepth = 1e-6;

bool is_nowhere(const ImageBounds& box) {
  return box.x0 > box.x1;
}

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

  // A box about a triangle.
  ImageBounds box(const std::array<Vec3d, 3>& corners) const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    double x0 = kInfinity, y0 = kInfinity, x1 = -kInfinity, y1 = -kInfinity;
    int before = 0, behind = 0;
    for (const Vec3d& corner : corners) {
      const Vec3d from_eye = corner - eye_;
      const double depth = from_eye.dot(forward_);
      const double least =
          kLeastDepth * (std::fabs(from_eye.x) + std::fabs(from_eye.y) + std::fabs(from_eye.z));
      before += depth > least ? 1 : 0, behind += depth < -least ? 1 : 0;
      const double per_depth = 1 / depth, x = from_eye.dot(right_) * per_depth;
      const double y = from_eye.dot(down_) * per_depth;
      x0 = std::min(x0, x), y0 = std::min(y0, y), x1 = std::max(x1, x), y1 = std::max(y1, y);
    }
    return before == 3 ? grown(x0, y0, x1, y1) : behind == 3 ? kNowhere : kEverywhere;
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

void add(const ImageBounds& box, ShapeBounds& bounds) {
  if (is_nowhere(box)) return;
  bounds.box = bounds.parts++ == 0 ? box : around(bounds.box, box);
}

// `body`: where the part stands; null: in the world.
void bound(const ScenePart& part, const BodyPlace* body, const Frame& frame, std::uint32_t first,
           std::span<ShapeBounds> bounds) {
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
  for (std::size_t i = number_of(first); i < end; ++i) {
    ShapeBounds& here = bounds[primitives[i] - first];
    if (const auto* spheres = std::get_if<std::vector<SphereRecord>>(&part.shape)) {
      add(frame.box(place.point((*spheres)[i].center), (*spheres)[i].radius * scale), here);
    } else if (const auto* cones = std::get_if<std::vector<ConeRecord>>(&part.shape)) {
      add(box_of((*cones)[i], frame, place, scale), here);
    } else {
      const Mesh& mesh = std::get<Mesh>(part.shape);
      std::array<Vec3d, 3> corners;
      for (std::size_t k = 0; k < 3; ++k)
        corners[k] = place.point(Vec3d(mesh.vertices[mesh.triangles[i][k]]));
      add(frame.box(corners), here);
    }
  }
}

}  // namespace

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
