// What the sampler does with a thousand samples, as in the paper's figure 1.
#pragma once

#include <string>
#include <vector>

#include "study/reference.h"
#include "study/report/page.h"

namespace pprt {

inline constexpr int kFigureSamples = 1000;

// Returns complexity map (CPU time of each pixel's sample), sample pattern, triangulation and reconstruction.
// Their files are named after the scene, with "-" for all but letters and digits.
std::vector<Picture> figure_pictures(const std::string& scene, const Subject& subject, std::uint64_t seed);

}  // namespace pprt
