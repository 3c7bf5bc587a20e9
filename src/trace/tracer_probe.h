// Makes a Probe of a Tracer.
#pragma once

#include "base/probe.h"
#include "trace/compiled_scene.h"

namespace pprt {

// Returns a Probe that calls `tracer`, which must outlive it.
inline Probe probe_of(Tracer& tracer) {
  Probe probe = {[&tracer](const Camera& camera) { tracer.set_camera(camera); },
                 [&tracer](double x, double y) { return tracer.trace(x, y); },
                 [&tracer](const Vec3f& hit, bool at_infinity) { return tracer.visible(hit, at_infinity); },
                 [&tracer] { return tracer.counts(); },
                 [&tracer](std::uint32_t primitive, ImageShape& shape) { tracer.project(primitive, shape); },
                 tracer.primitive_count(),
                 [&tracer](double x, double y, std::span<const KnownLights> known, double footprint) {
                   return tracer.trace(x, y, known, footprint);
                 }};
  probe.surfaces = tracer.surfaces();
  probe.bound = [&tracer](std::uint32_t first, std::span<ShapeBounds> bounds) {
    tracer.bound(first, bounds);
  };
  probe.has_textures = tracer.scene().effects().has(Effect::kTextures);
  probe.textures = {tracer.primitives_with_pictures(),
                    [&tracer](std::uint32_t primitive, double x, double y, double side, int per_side) {
                      return tracer.texture_over(primitive, x, y, side, per_side);
                    }};
  probe.lights = {tracer.lit_surfaces(),
                  [&tracer](std::uint32_t primitive, double x, double y, UnshadowedLight& light) {
                    tracer.unshadowed_light(primitive, x, y, light);
                  }};
  if (tracer.scene().moves()) {
    probe.set_time = [&tracer](double time) { return tracer.set_time(time); };
    probe.carry = [&tracer](RaySample& sample) { return tracer.carry(sample); };
  }
  return probe;
}

}  // namespace pprt
