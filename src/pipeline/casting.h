// Samples carried to the next frame (paper s. 4.1, 4.2; Badt 1988).
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "base/camera.h"
#include "pipeline/sample_mesh.h"

namespace pprt {

enum class CastMethod {
  kPaper,     // hidden samples guessed by the orientation test
  kVerified,  // hidden samples found by a visibility ray each
};

struct CastSettings {
  CastMethod method = CastMethod::kPaper;
  // Frames that a sample may live: those older are the oldest share that each frame drops.
  int max_age = 8;
  // The same for colour that depends on the eye (highlight, reflection, refraction): stale when the eye
  // moves.
  int max_age_eye_dependent = 2;
};

struct CastResult {
  std::vector<Sample> survivors;  // at their points in the next image, time stamps kept
  std::size_t out_of_view = 0;    // behind the eye or outside the image
  std::size_t hidden = 0;         // by the method's test
  std::size_t too_old = 0;
};

// Whether nothing lies between the next eye and a hit point; asked by kVerified only.
using Visibility = std::function<bool(const Vec3f& hit, bool at_infinity)>;

// Casts the samples of the mesh's region into the next camera's image, for the frame numbered `next_frame`.
CastResult cast_samples(const SampleMesh& mesh, const Camera& next, int next_frame,
                        const CastSettings& settings, const Visibility& visible);

// Drops the oldest samples beyond `limit`; of equal age those with the greatest id. The rest keep their
// order.
void keep_youngest(std::vector<Sample>& samples, std::size_t limit);

}  // namespace pprt
