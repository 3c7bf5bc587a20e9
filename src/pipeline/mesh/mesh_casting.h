// Casting of a triangulation's samples (paper s. 4.2).
#pragma once

#include "base/camera.h"
#include "pipeline/casting/casting.h"
#include "pipeline/mesh/sample_mesh.h"

namespace pprt {

// Casts the samples of the mesh's region into the next camera's image, for the frame numbered `next_frame`.
CastResult cast_samples(const SampleMesh& mesh, const Camera& next, int next_frame,
                        const CastSettings& settings);

}  // namespace pprt
