// Converged frames, which errors are measured against. Values are on the display scale: each sample is
// clamped to [0, 1] before the mean over the pixel.
#pragma once

#include <filesystem>
#include <string>

#include "base/camera.h"
#include "image/image.h"
#include "trace/compiled_scene.h"

namespace pprt {

// What is pictured. The scene must outlive it.
struct Subject {
  const CompiledScene& scene;
  Camera camera;
  double time = 0;  // of what moves, seconds
};

// Returns a tracer of the subject at its time.
Tracer tracer_of(const Subject& subject);

struct Reference {
  Image image;
  int samples = 0;      // per pixel
  double own_rmse = 0;  // estimate of the image's own error: half the difference of its two halves
};

// Returns the mean of n x n samples per pixel, at the centres of the pixel's cells. One thread.
Image supersampled(const Subject& subject, int n);

// Returns the mean of two independent halves. Each has n x n samples per pixel, one at a random place of each
// cell. Uses all cores.
Reference converged_reference(const Subject& subject, int n);

// Returns the same from a file in the directory, or makes it and the file. The file's name stands for the
// scene (`scene` is its text or hash), the camera, the time, n and what the tracer shows at some points, so
// that another version's frame is not taken. An unreadable file is replaced; an empty directory name keeps
// nothing. Throws std::runtime_error when the file cannot be written.
Reference cached_reference(const std::string& scene, const Subject& subject, int n,
                           const std::filesystem::path& directory);

// Returns $XDG_CACHE_HOME/pprt, or ~/.cache/pprt; empty when neither variable is set.
std::filesystem::path default_cache_directory();

// Returns the root mean square difference over all channels of all pixels, on the display scale. Both have
// the same size.
double rmse_of(const Image& image, const Image& reference);

}  // namespace pprt
