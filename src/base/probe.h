// The tracer's interface towards the pipeline and the ranks: what lies behind an image point.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "base/camera.h"
#include "base/image_shape.h"
#include "base/ray_counts.h"
#include "base/ray_sample.h"
#include "base/unshadowed_light.h"

namespace pprt {

// What the pictures of primitives show in the image.
struct PrimitiveTextures {
  // By primitive number, 0 included: whether it shows a picture. Empty: none does.
  std::span<const std::uint8_t> are_there = {};
  // Returns the factor of a primitive's colours over a square of the image about (x, y). It is that of the
  // primitive's plane, and the mean of per_side x per_side smaller squares. Coordinates and `side`, the whole
  // square's, are pixels; per_side is 1 or a greater power of two. Empty where there is none.
  std::function<std::optional<Color>(std::uint32_t primitive, double x, double y, double side, int per_side)>
      over = {};
};

// Functions that a Tracer, or a substitute in a test, provides.
struct Probe {
  // Sets the camera of all later calls.
  std::function<void(const Camera&)> set_camera;
  // Traces the eye ray through image point (x, y), pixels.
  std::function<RaySample(double x, double y)> trace;
  // Returns whether nothing hides a hit point from the eye. `hit` is a RaySample's: a point of the compiled
  // space, or a unit direction when `at_infinity`.
  std::function<bool(const Vec3f& hit, bool at_infinity)> visible;
  // Returns the rays traced since the beginning.
  std::function<RayCounts()> counts;
  // Projects a primitive of a RaySample into `shape`; empty: not available.
  std::function<void(std::uint32_t primitive, ImageShape& shape)> project = {};
  // Largest primitive number in a RaySample; 0: not known.
  std::uint32_t primitives = 0;
  // Traces the eye ray through image point (x, y), pixels, but sends no shadow rays from its first hit to
  // lights that are known there. Textures are filtered over a square of the image whose side is `footprint`,
  // pixels; trace() takes a pixel's. Empty: not available.
  std::function<RaySample(double x, double y, std::span<const KnownLights> known, double footprint)>
      trace_knowing = {};
  // Moves everything to its place at a time, seconds. Returns whether anything stands elsewhere than before.
  // Empty: nothing moves.
  std::function<bool(double time)> set_time = {};
  // Carries a sample of the time before the last set_time() into this time: its hit point moves with its
  // object, and lights that may have changed are no more known.
  std::function<Carried(RaySample& sample)> carry = {};
  // By primitive number, 0 included: the surface that it is a part of. Empty: each is one of its own.
  std::span<const std::uint32_t> surfaces = {};
  // Replaces `bounds` by boxes about the projections of primitives: of as many after the first `first` ones.
  // Empty: not available.
  std::function<void(std::uint32_t first, std::span<ShapeBounds> bounds)> bound = {};
  // Whether samples depend on `footprint`: the scene has textures.
  bool has_textures = false;
  PrimitiveTextures textures = {};
  PrimitiveLights lights = {};
};

}  // namespace pprt
