#include "trace/textures/ray_cone.h"

#include <algorithm>
#include <cmath>

#include "trace/geometry/numerics.h"

namespace pprt {

// In the plane of incidence the width changes by after / before, and a spread by index_ratio * before /
// after. Across it the width stays, and a spread changes by index_ratio. The roots are the means of both. A
// normal that turns by an angle turns the ray by that times (index_ratio * before - after), divided by
// `after` in the plane of incidence.
RayCone refracted(const RayCone& cone, double curvature, double index_ratio, double cosine_before,
                  double cosine_after) {
  const double before = std::max(cosine_before, kGrazingCosine),
               after = std::max(cosine_after, kGrazingCosine);
  const double squeeze = std::sqrt(after / before);
  const double turn = curvature * cone.width * (index_ratio * before - after) / std::sqrt(before * after);
  return {cone.width * squeeze, index_ratio * cone.spread / squeeze + turn};
}

// A disc across the ray, projected along it onto the plane, is an ellipse. It is 1 / cos times longer along
// `slant`, the ray's part in the plane, whose length is the sine.
TextureFootprint footprint(double width, const Vec3d& direction, const Vec3d& normal,
                           const TextureGradients& gradients) {
  const double cosine = direction.dot(normal);
  const Vec3d slant = (direction - normal * cosine) * (1 / std::max(std::abs(cosine), kGrazingCosine));
  const double u = gradients.u.dot(slant), v = gradients.v.dot(slant);
  const double width2 = width * width;
  return {width2 * (gradients.u.dot(gradients.u) + u * u), width2 * (gradients.u.dot(gradients.v) + u * v),
          width2 * (gradients.v.dot(gradients.v) + v * v)};
}

}  // namespace pprt
