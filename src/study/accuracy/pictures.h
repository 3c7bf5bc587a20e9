// What the sampler does with a thousand samples, as in the paper's figure 1.
#pragma once

#include <string>
#include <vector>

#include "study/accuracy/methods.h"

namespace pprt {

struct NamedPicture {
  std::string name;  // of its file
  std::string caption;
  std::string png;
};

// The letters and digits of a scene's name, "-" for all else.
std::string file_word(const std::string& scene);

inline constexpr int kFigureSamples = 1000;

// Complexity map (CPU time of each pixel's sample), sample pattern, triangulation and reconstruction, of a
// picture of `camera`. `word` begins the files' names.
std::vector<NamedPicture> figure_pictures(const std::string& scene, const std::string& word,
                                          const Subject& subject, std::uint64_t seed,
                                          const SecondsClock& clock);

}  // namespace pprt
