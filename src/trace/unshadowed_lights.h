// Direct light where nothing hides it: known of every primitive without a ray.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/camera.h"
#include "base/unshadowed_light.h"
#include "trace/scene_impl.h"

namespace pprt {

class Pose;

// Returns how surfaces are lit, by the number of a RaySample from 0 on: that of connected_surfaces() tells
// for all of its primitives. Those with pictures count as not lit, and so do faces that coincide.
std::vector<LitSurface> lit_surfaces(const CompiledScene::Impl& scene);

// A sphere or cone as the eye sees it: what its crossings with any ray need.
struct SeenQuadric {
  Vec3d axis{0, 0, 1};   // unit
  Vec3d aside{0, 0, 0};  // the eye from the centre, or from the axis
  double height = 0;     // of the eye along the axis, from the base
  double length = 0;     // of the cone
  double radius = 0;     // at the eye's height
  double slope = 0;      // change of the radius along the axis
  double per_slant = 1;  // 1 / sqrt(1 + slope^2), or 1 / radius of the sphere
};

// Evaluates the kernel's direct light, of all lights at once. Keeps what it has found of the last primitives,
// as the eye sees them.
class UnshadowedLights {
 public:
  // Poses have changed.
  void clear() { is_ready_ = false; }

  // As PrimitiveLights::at.
  void at(const Pose& pose, std::uint32_t primitive, const Camera& camera, double x, double y,
          UnshadowedLight& light);

 private:
  // Four lights.
  struct Four {
    double4 x{}, y{}, z{};
    std::array<float4, kLanes> colors{};
  };
  struct Place {
    std::uint32_t primitive = 0;         // 0: none is kept here
    const ScenePart* part = nullptr;     // null: the primitive is not in the scene
    std::uint32_t first = 0, count = 0;  // its own ones in the part
    SeenQuadric seen;                    // if it is round
    float least_cosine = 2;              // from which a highlight counts; above 1: none does
  };

  void prepare(const Pose& pose);
  const Place& place_of(const Pose& pose, std::uint32_t primitive);

  bool is_ready_ = false;
  int count_ = 0;
  std::array<Four, kNotedLights / kLanes> lights_;
  Vec3d eye_{0, 0, 0};
  std::array<Place, 64> kept_;  // by the last bits of their numbers
};

}  // namespace pprt
