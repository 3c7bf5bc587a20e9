// A film at one frame rate, by the errors that a viewer sees.
#pragma once

#include <cstdint>

#include "parallel/settings/session_words.h"
#include "study/rate/held_frames.h"
#include "study/rate/moving_scene.h"

namespace pprt {

// What is judged of a film, and how finely.
struct JudgedFilm {
  double begin_s = 0;  // no frame may be seen for the first time later
  double seconds = 1;  // from there on
  double rate = 240;   // pictures a second
  int size = 192;      // pixels, square
  int cells = 3;       // true pictures have 2 n x n samples a pixel
};

// Returns the span's true pictures: none where it is shorter than one.
TrueFilm true_film_of(const MovingScene& moving, const JudgedFilm& judged);

// How frames of a film are made: under the work clock, as large as the true pictures.
struct HeldRun {
  const MovingScene& moving;
  const TrueFilm& film;
  int ranks = 1;
  double units_per_second = 1e9;  // of each rank
  std::uint64_t seed = 1;
};

// The film at one rate by one sampler.
struct RateResult {
  SamplerChoice sampler = SamplerChoice::kAuto;
  double fps = 1;
  HeldErrors held = {};
  double samples = 0;  // per pixel and frame
};

// Frame k is begun at k / fps, and seen a period later.
RateResult measure_held(SamplerChoice sampler, double fps, const HeldRun& run);

}  // namespace pprt
