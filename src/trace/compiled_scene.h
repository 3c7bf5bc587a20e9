// A scene compiled for ray tracing: Embree's BVH over normalised geometry, and the effects it calls for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "base/camera.h"
#include "base/first_hit.h"
#include "base/image_shape.h"
#include "base/ray_counts.h"
#include "base/ray_sample.h"
#include "base/unshadowed_light.h"
#include "base/vector.h"
#include "scene/description/scene_description.h"
#include "trace/survey/effects.h"

namespace pprt {

struct CompileOptions {
  int max_depth = 5;                 // an eye ray has depth 1
  bool cull = false;                 // show only the front of opaque surfaces
  std::optional<EffectSet> effects;  // effects that may be simulated; absent: all that the scene calls for
  // Count rays as Haines' tables do. Every hit on T > 0 spawns a reflection ray, even where Ks = 0. Rays are
  // followed to the full depth whatever their weight.
  bool count_as_published = false;
};

// Distance in sizes of the scene from which an eye still sees it. At 2^40 the rounding of a double, 2^-53 of
// the distance, is a 2^13th of the scene. Test: camera_test.cpp, "an eye ...".
inline constexpr double kFarthestEye = 0x1p40;

// Primitives left out of a compiled scene because each equals an earlier one, material included.
struct RepeatedPrimitives {
  std::size_t count = 0;
  std::uint32_t first = 0;  // place in SceneDescription::order, if count > 0
};

// Immutable; any number of Tracers may read it. The compiled space is the scene's, moved and scaled in double
// so that its largest extent lies in (0.5, 1] (trace/normalisation.h).
class CompiledScene {
 public:
  class Impl;

  explicit CompiledScene(std::unique_ptr<const Impl> impl);
  CompiledScene(CompiledScene&&) noexcept;
  CompiledScene& operator=(CompiledScene&&) noexcept;
  ~CompiledScene();

  // Returns the effects that are simulated: called for by the scene and allowed by the options.
  EffectSet effects() const;

  // Whether anything but the camera moves; and whether it stands elsewhere at one time than at another.
  bool moves() const;
  bool moves_between(double one, double other) const;

  // Returns the distance of a point in scene space from the compiled space's origin, in sizes of the scene.
  double distance(const Vec3d& point) const;
  RepeatedPrimitives repeated() const;

  // Converts a view in scene space to a camera in the compiled space, for view.width x view.height pixels.
  // Throws InputError when the view is degenerate: from = at, up parallel to it, angle outside (0, 180), the
  // eye beyond kFarthestEye.
  Camera camera(const View& view) const;

  // Returns a report for people: primitives by kind, materials, lights, effects with reasons, memory.
  std::string census() const;

  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<const Impl> impl_;
};

class Pose;
class ProjectedTextures;
class UnshadowedLights;

// Compiles a scene. Throws InputError when it has no visible object or a number that is not finite.
CompiledScene compile(const SceneDescription& scene, const CompileOptions& options = {});

// What an eye ray finds of glass: of surfaces that bend rays.
struct GlassSeen {
  bool glass = false;  // whether the first hit is of glass
  // Whether that glass is turned inside out: its back is hit, and yet the straight line beyond does not leave
  // glass more often than it enters it. So the eye is not in the glass, nor does it look into an open end.
  bool inside_out = false;
  std::uint32_t primitive = 0;  // as a RaySample's, if `glass`
};

// Traces rays in one thread. The CompiledScene must outlive it.
class Tracer {
 public:
  // The time is that of the movement's start.
  Tracer(const CompiledScene& scene, const Camera& camera);
  Tracer(Tracer&&) noexcept;
  ~Tracer();

  // Moves everything to its place at a time, seconds. Returns whether anything stands elsewhere than before.
  bool set_time(double time);

  // Carries a sample of the time before the last set_time() into this time: its hit point moves with its
  // object. Lights that what moves may have hidden or freed, or that move, are no more known there. A colour
  // on what has moved counts as one that changes with the eye.
  Carried carry(RaySample& sample) const;

  const CompiledScene& scene() const { return scene_; }

  void set_camera(const Camera& camera);
  const Camera& camera() const { return camera_; }

  // Traces the eye ray through image point (x, y), pixels, with its whole ray tree. From its first hit no
  // shadow rays go to lights that are `known` for that primitive. Textures are filtered over a square of the
  // image whose side is `footprint`, pixels.
  RaySample trace(double x, double y, std::span<const KnownLights> known = {}, double footprint = 1);

  // Returns the first hit at image point (x, y), pixels. The ray is not counted. Primitives are numbered as
  // in SceneDescription::order, materials as in SceneDescription::materials, both from 1.
  FirstHit first_hit(double x, double y) const;

  // Returns what the eye ray through image point (x, y), pixels, finds of glass. The ray is not counted.
  GlassSeen glass_seen(double x, double y) const;

  // Returns whether nothing lies between the eye and an earlier hit point. `hit` is a RaySample's: a point of
  // the compiled space, or a unit direction when `at_infinity`.
  bool visible(const Vec3f& hit, bool at_infinity);

  // Returns the largest primitive number that a RaySample may have.
  std::uint32_t primitive_count() const;

  // Returns the surface that each primitive is a part of, by the number of a RaySample from 0 on. Polygons
  // that go on into each other are one surface. It has the number of its first primitive.
  std::span<const std::uint32_t> surfaces() const;

  // Returns whether each primitive shows a picture, by the same numbers; empty: none does.
  std::span<const std::uint8_t> primitives_with_pictures() const;

  // Returns what PrimitiveTextures::over (base/probe.h) says.
  std::optional<Color> texture_over(std::uint32_t primitive, double x, double y, double side, int per_side);

  // As PrimitiveLights.
  std::span<const LitSurface> lit_surfaces() const;
  void unshadowed_light(std::uint32_t primitive, double x, double y, UnshadowedLight& light);

  // Projects a primitive of a RaySample to the image, into `shape`, whose storage is reused.
  void project(std::uint32_t primitive, ImageShape& shape) const;

  // Replaces `bounds` by boxes about the projections of as many primitives after the first `first` ones.
  void bound(std::uint32_t first, std::span<ShapeBounds> bounds) const;

  const RayCounts& counts() const { return counts_; }

 private:
  const CompiledScene& scene_;
  std::unique_ptr<Pose> pose_;
  std::unique_ptr<ProjectedTextures> textures_;
  std::unique_ptr<UnshadowedLights> lights_;
  Camera camera_;
  RayCounts counts_;
};

}  // namespace pprt
