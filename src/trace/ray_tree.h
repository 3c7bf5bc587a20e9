// Ray trees: what an eye ray sees, by NFF's model, and single rays.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "base/ray_sample.h"
#include "base/vector.h"
#include "trace/compiled_scene.h"

namespace pprt {

class Pose;
struct RayCone;

// Traces the ray tree of an eye ray, with the scene's effects and no others. Adds to the counts. Origin and
// unit direction are in the compiled space. `cone`: the ray's, if the scene has textures. `known`: lights
// that need no shadow rays from the first hit.
RaySample trace_ray_tree(const Pose& pose, const Vec3f& origin, const Vec3f& direction, const RayCone& cone,
                         std::span<const KnownLights> known, RayCounts& counts);

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
