// Rays by kind: what shows that only the effects a scene calls for were simulated.
#pragma once

#include <cstdint>

namespace pprt {

// Rays by kind since a Tracer was made.
struct RayCounts {
  std::uint64_t primary = 0;
  std::uint64_t eye_hits = 0;  // primary rays that hit something
  std::uint64_t shadow = 0;
  std::uint64_t reflection = 0;
  std::uint64_t refraction = 0;                 // really refracted
  std::uint64_t total_internal_reflection = 0;  // refraction asked for, none possible
  std::uint64_t visibility = 0;                 // whether a former hit point is still seen

  std::uint64_t traced() const { return primary + shadow + reflection + refraction + visibility; }
};

inline RayCounts& operator+=(RayCounts& a, const RayCounts& b) {
  a.primary += b.primary, a.eye_hits += b.eye_hits, a.shadow += b.shadow, a.reflection += b.reflection;
  a.refraction += b.refraction, a.total_internal_reflection += b.total_internal_reflection;
  a.visibility += b.visibility;
  return a;
}

inline RayCounts operator-(RayCounts a, const RayCounts& b) {
  a.primary -= b.primary, a.eye_hits -= b.eye_hits, a.shadow -= b.shadow, a.reflection -= b.reflection;
  a.refraction -= b.refraction, a.total_internal_reflection -= b.total_internal_reflection;
  a.visibility -= b.visibility;
  return a;
}

}  // namespace pprt
