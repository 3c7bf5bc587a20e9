// A pinhole camera as plain values: image points to rays, and hit points back to image points.
//
// Image points are continuous, in pixels: x in [0, width] to the right, y in [0, height] downwards. Pixel (i,
// j) is the square [i, i+1] x [j, j+1]. Points and directions are in the compiled space
// (trace/compiled_scene.h).
#pragma once

#include <optional>

#include "base/vector.h"

namespace pprt {

// Position, axes and image of a pinhole camera.
struct Camera {
  Vec3d eye{0, 0, 0};
  Vec3d right{1, 0, 0};  // unit, orthogonal; forward x up
  Vec3d up{0, 1, 0};
  Vec3d forward{0, 0, 1};
  double slope_per_pixel = 1;  // tangent per pixel, equal in x and y
  int width = 1;
  int height = 1;

  friend bool operator==(const Camera&, const Camera&) = default;
};

// Returns the direction of the ray from the eye through image point (x, y). Its forward component is 1; it is
// not normalised.
inline Vec3d ray_direction(const Camera& camera, double x, double y) {
  const double sx = (x - 0.5 * camera.width) * camera.slope_per_pixel;
  const double sy = (0.5 * camera.height - y) * camera.slope_per_pixel;
  return camera.forward + camera.right * sx + camera.up * sy;
}

// Projects a vector from the eye to the image, pixels. `from_eye` is a hit point minus the eye, or the
// direction of a point at infinity. Empty unless it lies in front of the eye. The result may lie outside the
// image.
inline std::optional<Vec2d> project(const Camera& camera, const Vec3d& from_eye) {
  const double depth = from_eye.dot(camera.forward);
  if (!(depth > 0)) return std::nullopt;
  const double per_depth = 1 / (depth * camera.slope_per_pixel);
  return Vec2d(0.5 * camera.width + from_eye.dot(camera.right) * per_depth,
               0.5 * camera.height - from_eye.dot(camera.up) * per_depth);
}

}  // namespace pprt
