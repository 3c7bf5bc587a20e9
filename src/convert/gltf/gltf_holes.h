// Holes that a picture's alpha cuts into a mesh.
#pragma once

#include <cstddef>
#include <vector>

#include "convert/model/model_builder.h"

namespace pprt {

// The alpha of a picture, repeated without end, rows from the top. Empty: 1 everywhere.
struct AlphaPicture {
  int width = 0, height = 0;
  std::vector<float> alpha;

  // Returns it between texels, as the colours of textures are.
  double at(const Vec2d& point) const;
  double mean() const;
};

// Cuts out of a mesh of triangles what has less alpha than `cutoff`. Triangles that lie across a hole's edge
// are divided down to texels, and then along a straight line. Returns false where they would have become too
// many: then edges are coarse.
bool cut_holes(ModelMesh& mesh, const AlphaPicture& picture, double cutoff);

}  // namespace pprt
