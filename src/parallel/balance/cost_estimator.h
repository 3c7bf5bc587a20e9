// What one rank's tiles have cost, and what they will cost until they are refined to a given mean weight
// (paper s. 3.6, 4.3).
#pragma once

#include <cstdint>
#include <vector>

#include "parallel/protocol/tile_cost.h"
#include "parallel/settings/work_units.h"
#include "pipeline/core/region_quality.h"
#include "pipeline/core/sample.h"

namespace pprt {

// How much the frame before says about a frame.
enum class FrameLikeness : std::uint8_t {
  kUnknown,  // it showed something else, or there was none
  kSimilar,  // the camera has moved: its figures give way to this frame's with time
  kSame      // it showed the same
};

// Restore of s. 4.4: work units of reconstructing a tile.
double reconstruction_cost(const TileGrid& grid, int tile);

class CostEstimator {
 public:
  // `work`: what the sampler does with a sample.
  CostEstimator(const TileGrid& grid, const SampleWork& work);

  // Begins a frame. With a fresh triangulation what tiles have cost becomes what they cost last.
  // `mixed_pixel`: work units that a pixel of several surfaces takes beside its samples.
  void begin_frame(bool fresh_picture, FrameLikeness likeness, double mixed_pixel = 0);
  FrameLikeness likeness() const { return likeness_; }

  // Counts a sample that was traced or reinserted here: its rays and its insertion, for its tile.
  void add_own(const Sample& sample);

  // Counts the insertion of another rank's sample, for the region as a whole.
  void add_received();

  // Work units counted so far, in the whole sequence.
  double counted() const { return counted_; }

  // Brings the estimates up to date. `elapsed`: share of the frame's sampling time that has
  // passed, in (0, 1].
  void update(const RegionQuality& refined, double elapsed);

  // Fcost(i, Q): work units until the tile's mean weight has fallen to `target` > 0, reconstruction
  // included. The mean weight falls as the reciprocal of the samples. Negative where more has been paid than
  // needed.
  double future_cost(const RegionQuality& refined, int tile, double target) const;

  // The same for the region, with what other ranks' samples are expected to cost until the frame's end.
  double future_cost_of_region(const RegionQuality& refined, double target) const;

  // A tile's figures in this frame and the one before. Right for own tiles only.
  const TileEstimate& now(int tile) const { return now_[static_cast<std::size_t>(tile)]; }
  const TileEstimate& last(int tile) const { return last_[static_cast<std::size_t>(tile)]; }

  // A tile comes from a neighbour, with its figures.
  void accept(const TileTransfer& transfer);

  // A tile comes with a new partition: what its last owner reported.
  void expect(int tile, const TileEstimate& found) { last_[static_cast<std::size_t>(tile)] = found; }

  // Ends a frame: remembers the mean weights that it has led to, and returns a report of every own tile.
  std::vector<TileReport> report(const RegionQuality& refined);

 private:
  void learn_cost_per_triangle(const RegionQuality& refined);
  double cost_of(const RegionQuality& refined, int tile) const;
  double mixed_cost(const RegionQuality& refined, int tile) const {
    return mixed_pixel_ * static_cast<double>(refined.tile(tile).mixed_pixels);
  }

  TileGrid grid_;
  double own_sample_, received_sample_;   // work units, without rays
  std::vector<TileEstimate> now_, last_;  // per tile
  double mixed_pixel_ = 0;                // work units in this frame
  double cost_per_candidate_ = 0;         // of this region in this frame, mean
  double counted_ = 0;
  double received_now_ = 0;   // work units spent on other ranks' samples
  double received_last_ = 0;  // the same in the frame before
  FrameLikeness likeness_ = FrameLikeness::kUnknown;
  double share_of_now_ = 1;  // of this frame's figures in an estimate, against the last one's
};

}  // namespace pprt
