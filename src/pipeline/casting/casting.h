// Casting: projects a frame's samples into the next camera's image (paper s. 4.1, 4.2; Badt 1988).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/camera.h"
#include "pipeline/core/region.h"
#include "pipeline/core/sample.h"

namespace pprt {

enum class CastMethod {
  kPaper,    // hidden samples are guessed by the orientation test
  kVerified  // nothing is guessed: drop_hidden() finds them
};

struct CastSettings {
  CastMethod method = CastMethod::kPaper;
  int max_age = 8;  // frames; those that are older are the oldest share that each frame drops
  // The same for colour that depends on the eye (highlight, reflection, refraction): it goes stale when the
  // eye moves.
  int max_age_eye_dependent = 2;
  // kVerified: casts one sample in so many, drawn by is_one_of(). The orientation test needs all samples.
  std::uint64_t one_of = 1;
  bool lit_only = false;  // kVerified: only samples that shadow rays were sent from
  // Carries a sample to where its object is now, see Probe::carry. Empty: nothing has moved. What is relit is
  // cast only for what it knows of lights, with lit_only.
  std::function<Carried(RaySample& sample)> carry = {};
};

// Largest age of verified samples, frames. Outlines have moved by then, and older samples tell little of them
// (docs/decisions/0013-casting.md).
inline constexpr int kVerifiedMaxAge = 2;

struct CastResult {
  std::vector<Sample> samples;  // at their points in the next image, with their old time stamps
  // Counts of the others.
  std::size_t out_of_view = 0;  // behind the eye or outside the image
  std::size_t hidden = 0;       // by the orientation test
  std::size_t too_old = 0;
  double moved = 0;  // mean distance of `samples` from their old points, pixels
};

// Whether nothing lies between the next eye and a hit point, or in its direction if that is at infinity.
using Visibility = std::function<bool(const Vec3f& hit, bool at_infinity)>;

// Casts the region's samples into the next camera's image, for the frame numbered `next_frame`. Nothing is
// guessed of what is hidden: the method must be kVerified.
CastResult cast_samples(std::span<const Sample> samples, const Region& region, const Camera& next,
                        int next_frame, const CastSettings& settings);

// Removes the samples that are hidden and returns their number. Calls visible() once for each sample.
std::size_t drop_hidden(std::vector<Sample>& samples, const Visibility& visible);

// Whether a sample is drawn when one in `many` is. Depends on its id alone, not on its order and age.
bool is_one_of(const Sample& sample, std::uint64_t many);

// Removes the oldest samples beyond `limit`. Among those of equal age the choice prefers neither a frame's
// first samples nor its last. The others keep their order.
void keep_youngest(std::vector<Sample>& samples, std::size_t limit);

// Removes all but the youngest sample of each pixel, in the same sense. The others keep their order.
void keep_youngest_of_pixels(std::vector<Sample>& samples);

}  // namespace pprt
