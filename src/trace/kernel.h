// The shading kernels: one per set of effects, chosen once per scene.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "base/ray_sample.h"
#include "base/vector.h"
#include "trace/compiled_scene.h"

namespace pprt {

class Pose;

// Traces the ray tree of an eye ray: fills the sample, adds to the counts. Origin and unit direction are in
// the compiled space. `known`: lights that need no shadow rays from the first hit.
using Kernel = void (*)(const Pose& pose, const Vec3f& origin, const Vec3f& direction,
                        std::span<const KnownLights> known, RaySample& sample, RayCounts& counts);

// Returns the kernel that simulates exactly `effects`. `published` is CompileOptions::count_as_published.
// `extended`: the kernel also knows bodies that move, textures, and materials with a colour for each term.
Kernel kernel_for(EffectSet effects, bool published, bool extended);

// The surface that an eye ray hits first, in the compiled space. Indices count from 0.
struct VisibleSurface {
  Vec3d position{0, 0, 0};
  Vec3d normal{0, 0, 1};  // unit, against the ray; interpolated if the scene's effects say so
  std::uint32_t primitive = 0;
  MaterialIndex material = 0;
  bool entering = true;   // whether the ray comes from outside
  Vec3d beyond{0, 0, 0};  // where a ray that goes on through the surface starts
};

// Returns the first hit of an eye ray, if any. Origin and unit direction are in the compiled space.
std::optional<VisibleSurface> visible_surface(const Pose& pose, const Vec3f& origin, const Vec3f& direction);

// Returns whether a ray hits anything nearer than `length`. `direction` has unit length.
bool occluded(const Pose& pose, const Vec3f& origin, const Vec3f& direction, float length);

}  // namespace pprt
