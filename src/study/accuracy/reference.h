// Converged frames: what errors are measured against.
#pragma once

#include <filesystem>
#include <string>

#include "study/accuracy/methods.h"

namespace pprt {

struct Reference {
  Image image;          // on the display scale: each sample clamped to [0, 1], then the mean over the pixel
  int samples = 0;      // a pixel
  double own_rmse = 0;  // of the image itself, estimated: half of what its two halves differ by
};

// Two independent halves of n x n samples in every pixel, one at a random place of each cell, and their mean.
// As many threads as the host has cores.
Reference converged_reference(const Subject& subject, int n);

// The same, kept in the directory for the next time under a name that stands for the scene, the camera, n,
// and what the tracer shows at some points, so that a picture of another renderer's is not taken for it. No
// directory: nothing is kept. A file that cannot be read is made anew. Throws std::runtime_error when it
// cannot be written.
Reference cached_reference(const std::string& scene_nff, const Subject& subject, int n,
                           const std::filesystem::path& directory);

// $XDG_CACHE_HOME/pprt, or ~/.cache/pprt; empty when neither variable is set.
std::filesystem::path default_cache_directory();

// Root mean square of the differences over all channels of all pixels. Both of the same size.
double rmse_of(const Image& image, const Image& reference);

}  // namespace pprt
