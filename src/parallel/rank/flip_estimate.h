// Estimates by FLIP how far a region's picture is from the finished one, while it is sampled.
//
// Nobody knows the finished picture. But the picture changes less and less, and the change while its samples
// doubled says how wrong it still is (docs/decisions/0023-estimated-flip.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "image/flip.h"
#include "parallel/clock/frame_clock.h"
#include "parallel/rank/picture_refresh.h"
#include "parallel/rank/rank_sampling.h"

namespace pprt {

class FlipEstimate {
 public:
  // A picture begins: what was seen of others says nothing of it.
  void forget();

  // Whether the mean FLIP of the region's picture is estimated to be at most `target`. Looks at the picture
  // each time that its samples have doubled, and foretells from that in between. A look reconstructs
  // `picture`.
  bool is_at_most(double target, RankSampling& sampler, PictureRefresh& picture, FrameClock& clock);

  // Returns the number of samples that is expected to reach the last target; empty before that is known.
  std::optional<double> foretold_samples() const {
    return enough_ < kNever ? std::optional(enough_) : std::nullopt;
  }

 private:
  // A part of the image as it was at the last look.
  struct Block {
    PixelRect pixels;
    std::vector<std::uint8_t> owned;  // per pixel
    flip::Seen seen;
  };

  static std::vector<PixelRect> choose_blocks(const Region& region);
  static Block look_at(const PixelRect& pixels, const Region& region, const PixelBlock& picture);
  std::optional<double> look(const Region& region, const PixelBlock& picture, FrameClock& clock);
  void foretell(double target, double estimate, double samples);

  std::vector<Block> blocks_;    // of the last look
  std::uint64_t samples_ = 0;    // at the last look
  double estimate_ = 0;          // then; 0: none
  std::uint64_t next_look_ = 0;  // at so many samples
  double enough_ = kNever;       // samples that are expected to reach the target
  static constexpr double kNever = std::numeric_limits<double>::infinity();
};

}  // namespace pprt
