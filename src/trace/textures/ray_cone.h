// Ray cones: how wide a ray is, for filtering textures over what it covers. They grow with the distance, and
// change where the ray is reflected or refracted. Source: Akenine-Moeller et al., Improved Shader and Texture
// Level of Detail Using Ray Cones, JCGT 10(1), 2021.
//
// A cone has one width, so it stands for an ellipse of the same area where a surface widens it more in one
// direction.
#pragma once

#include "base/vector.h"
#include "trace/geometry/mesh.h"
#include "trace/textures/texture_image.h"

namespace pprt {

// At a point of a ray. Negative widths belong to a ray whose sides have crossed behind a lens or a hollow
// mirror.
struct RayCone {
  double width = 0;   // across the ray
  double spread = 0;  // by which the width grows in each unit of length

  RayCone after(double distance) const { return {width + spread * distance, spread}; }
};

// Returns the cone of the mirrored ray. `curvature`: mean curvature of the surface, > 0 where it bulges
// towards the ray. A normal turns by curvature * width / cos in the plane of incidence and by curvature *
// width across it. The mirrored ray turns by twice the first, and by 2 cos times the second: in the mean by 2
// curvature * width.
inline RayCone mirrored(const RayCone& cone, double curvature) {
  return {cone.width, cone.spread + 2 * curvature * cone.width};
}

// Returns the cone of the refracted ray, approximately. The cosines are those of both rays to the normal, >
// 0.
RayCone refracted(const RayCone& cone, double curvature, double index_ratio, double cosine_before,
                  double cosine_after);

// Returns what a cone of this width covers of a texture on a plane. `direction` is the ray's, `normal` the
// plane's, both unit. Flatter than kGrazingCosine the footprint grows no more.
TextureFootprint footprint(double width, const Vec3d& direction, const Vec3d& normal,
                           const TextureGradients& gradients);

}  // namespace pprt
