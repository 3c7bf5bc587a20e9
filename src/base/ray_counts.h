// Ray counters. They show that only the effects a scene calls for were simulated.
#pragma once

#include <cstdint>

namespace pprt {

// Number of rays by kind since a Tracer was made.
struct RayCounts {
  std::uint64_t primary = 0;
  std::uint64_t eye_hits = 0;  // primary rays that hit something
  std::uint64_t shadow = 0;
  std::uint64_t reflection = 0;
  std::uint64_t refraction = 0;                 // rays that were refracted
  std::uint64_t total_internal_reflection = 0;  // hits that asked for a refracted ray and got none
  std::uint64_t visibility = 0;                 // rays that ask whether an earlier hit point is still visible

  // Returns the number of rays traced, of all kinds.
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
