// Triangles that lie in one another: which of them is seen.
//
// Embree cannot tell which of two triangles a ray meets first if they are closer than its rounding. Its
// choice differs from ray to ray. Such triangles are found once, and a ray that meets one asks for the others
// there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "base/vector.h"
#include "trace/scene_impl.h"

namespace pprt {

// Marks triangles of a body that overlap another object's in nearly the same plane (ScenePart::coincides),
// and raises their offsets so that a leaving ray is clear of both. Takes n log n time. Returns their number.
std::size_t mark_coincident_faces(std::span<ScenePart> parts);

// Returns whether the hit is on such a triangle.
inline bool is_coincident(const ScenePart& part, const RTCHit& hit) {
  return !part.coincides.empty() && part.coincides[hit.primID];
}

// Replaces a hit on such a triangle by that on the face which is seen there. The nearest is. Faces count as
// equally near within the rounding of their vertices: of these the first in the description is seen. Opaque
// ones come before others, so that a glass does not hide what it stands on. Origin and direction are in the
// space of `body`.
void choose_coincident_face(const CompiledScene::Impl& scene, std::uint32_t body, const Vec3d& origin,
                            const Vec3d& direction, RTCHit& hit);

}  // namespace pprt
