// How wrong a film looks whose frames are held: at any moment a viewer sees the frame delivered last, which
// shows what was there when it was begun. More frames a second are coarser, fewer are older.
//
// The idea of judging both as one error is from C. Woolley, D. Luebke, B. Watson and A. Dayal, "Interruptible
// Rendering", Proc. Symposium on Interactive 3D Graphics (2003).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "image/image.h"
#include "image/metrics.h"

namespace pprt {

// What is really there, picture by picture.
struct TrueFilm {
  double rate = 240;   // pictures a second
  double begin_s = 0;  // moment of the first, since the film began
  std::vector<Image> pictures = {};
  int flip_every = 4;                    // of so many pictures one is judged by FLIP
  std::vector<FlipReference> flip = {};  // of those

  double moment(std::size_t picture) const { return begin_s + static_cast<double>(picture) / rate; }
};

// Makes a film of pictures, prepared for FLIP.
TrueFilm true_film(double rate, double begin_s, std::vector<Image> pictures);

// Frames at a rate: frame k shows moment k / rate, and is seen from `lag_s` later on.
struct HeldFrames {
  double rate = 1;
  double lag_s = 0;
  std::span<const Image> pictures;
};

// Returns the number of the frame that is seen at a moment, below 0: none.
int frame_seen_at(double moment_s, double rate, double lag_s);

// Errors over the true film: the root of the mean squared RMSE, and the mean FLIP.
struct HeldErrors {
  double rmse = 0, flip = 0;
};

// Throws std::invalid_argument where some moment has no frame.
HeldErrors errors_of(const HeldFrames& frames, const TrueFilm& film);

}  // namespace pprt
