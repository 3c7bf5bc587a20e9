// A scene ready for rays: Embree's BVH over normalised geometry, and the effects it calls for.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "base/camera.h"
#include "base/first_hit.h"
#include "base/image_shape.h"
#include "base/ray_counts.h"
#include "base/ray_sample.h"
#include "base/vector.h"
#include "scene/scene_description.h"
#include "trace/effects.h"

namespace pprt {

struct CompileOptions {
  int max_depth = 5;                 // an eye ray has depth 1
  bool cull = false;                 // opaque surfaces one-sided
  std::optional<EffectSet> effects;  // restricts what the scene calls for; absent: all it calls for
  // Counting as Haines' tables do: every hit on T > 0 spawns a reflection ray even where Ks = 0, and rays are
  // followed to the full depth whatever their weight.
  bool count_as_published = false;
  // Follow rays with the kernel for all effects, whatever the scene calls for: to measure what the special
  // ones gain. Pictures are the same.
  bool general_kernel = false;
};

// Immutable once compiled; any number of Tracers may read it. Coordinates inside are recentred and rescaled,
// in double, so that the scene's bounds fit the unit cube about the origin.
class CompiledScene {
 public:
  class Impl;

  explicit CompiledScene(std::unique_ptr<const Impl> impl);
  CompiledScene(CompiledScene&&) noexcept;
  CompiledScene& operator=(CompiledScene&&) noexcept;
  ~CompiledScene();

  // What is simulated: called for by the scene and not ruled out by the options.
  EffectSet effects() const;

  // A scene-space view as a camera of the compiled space, for an image of view.width x view.height pixels.
  // Throws InputError when the view is degenerate (from = at, up parallel, angle outside (0, 180)).
  Camera camera(const View& view) const;

  // For people: primitives by kind, materials, lights, effects chosen and why, kernel, memory.
  std::string census() const;

  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<const Impl> impl_;
};

// Throws InputError when nothing can be built from the scene.
CompiledScene compile(const SceneDescription& scene, const CompileOptions& options = {});

// Follows rays of one thread. The CompiledScene must outlive it.
class Tracer {
 public:
  Tracer(const CompiledScene& scene, const Camera& camera);

  void set_camera(const Camera& camera) { camera_ = camera; }
  const Camera& camera() const { return camera_; }

  // The whole ray tree of the eye ray through image point (x, y), in pixels.
  RaySample trace(double x, double y);

  // What lies behind image point (x, y), by one ray, which is not counted. Primitives have their number in
  // SceneDescription::order, materials in SceneDescription::materials, both from 1.
  FirstHit first_hit(double x, double y) const;

  // Whether nothing lies between the eye and a hit point of a former frame (compiled space).
  bool visible(const Vec3f& hit, bool at_infinity);

  // The largest number that a primitive of a RaySample may have.
  std::uint32_t primitive_count() const;

  // What a primitive of a RaySample looks like through the camera, into `shape`, whose storage is kept.
  void view(std::uint32_t primitive, ImageShape& shape) const;

  const RayCounts& counts() const { return counts_; }

 private:
  const CompiledScene& scene_;
  Camera camera_;
  RayCounts counts_;
};

}  // namespace pprt
