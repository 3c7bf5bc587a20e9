// Samples carried to the next frame (paper s. 4.1, 4.2; Badt 1988).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "base/camera.h"
#include "pipeline/sampling/sample_mesh.h"

namespace pprt {

enum class CastMethod {
  kPaper,    // hidden samples are guessed, by the orientation test
  kVerified  // nothing is guessed: drop_hidden() finds them
};

struct CastSettings {
  CastMethod method = CastMethod::kPaper;
  // Frames that a sample may live: those older are the oldest share that each frame drops.
  int max_age = 8;
  // The same for colour that depends on the eye (highlight, reflection, refraction): stale when the eye
  // moves.
  int max_age_eye_dependent = 2;
  // kVerified: of the samples one in so many, drawn by is_one_of(). The orientation test needs them all.
  std::uint64_t one_of = 1;
};

// Of samples that are verified, how old they may be: outlines have moved, and older ones tell little of them
// (docs/decisions/0013-casting.md).
inline constexpr int kVerifiedMaxAge = 2;

struct CastResult {
  std::vector<Sample> survivors;  // at their points in the next image, time stamps kept
  std::size_t out_of_view = 0;    // behind the eye or outside the image
  std::size_t hidden = 0;         // by the orientation test
  std::size_t too_old = 0;
  double moved = 0;  // by how much the survivors have moved, mean, pixels
};

// Whether nothing lies between the next eye and a hit point.
using Visibility = std::function<bool(const Vec3f& hit, bool at_infinity)>;

// Casts the samples of the mesh's region into the next camera's image, for the frame numbered `next_frame`.
CastResult cast_samples(const SampleMesh& mesh, const Camera& next, int next_frame,
                        const CastSettings& settings);

// Drops the samples that are hidden and tells how many they were; asks for each of them.
std::size_t drop_hidden(std::vector<Sample>& samples, const Visibility& visible);

// One of so many samples, whatever their order and age: by their id alone.
bool is_one_of(const Sample& sample, std::uint64_t many);

// Drops the oldest samples beyond `limit`; of equal age a choice that prefers neither a frame's first samples
// nor its last. The rest keep their order.
void keep_youngest(std::vector<Sample>& samples, std::size_t limit);

// Of the samples that lie in one pixel keeps the youngest, in the same sense. The rest keep their order.
void keep_youngest_of_pixels(std::vector<Sample>& samples);

}  // namespace pprt
