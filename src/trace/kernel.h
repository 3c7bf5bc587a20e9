// The shading kernels: one per set of effects, chosen once per scene.
#pragma once

#include <cstdint>
#include <optional>

#include "base/ray_sample.h"
#include "base/vector.h"
#include "trace/compiled_scene.h"

namespace pprt {

// Follows the ray tree of an eye ray: fills the sample, adds to the counts. `direction` has unit length.
using Kernel = void (*)(const CompiledScene::Impl& scene, const Vec3f& origin, const Vec3f& direction,
                        RaySample& sample, RayCounts& counts);

// The kernel that simulates exactly `effects`; `published` as CompileOptions::count_as_published.
Kernel kernel_for(EffectSet effects, bool published);

// The surface that an eye ray meets first.
struct VisibleSurface {
  Vec3d position{0, 0, 0};
  Vec3d normal{0, 0, 1};  // unit, against the ray; interpolated where the scene's effects have it so
  std::uint32_t primitive = 0;
  MaterialIndex material = 0;
};
std::optional<VisibleSurface> visible_surface(const CompiledScene::Impl& scene, const Vec3f& origin,
                                              const Vec3f& direction);

// Whether a ray hits anything before `length` (in units of its direction's length, which is 1).
bool occluded(const CompiledScene::Impl& scene, const Vec3f& origin, const Vec3f& direction, float length);

}  // namespace pprt
