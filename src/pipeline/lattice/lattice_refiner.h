// Chooses the samples of a picture on a lattice: a coarse grid first, then nodes where the picture is
// expected to be most wrong, tile by tile (docs/decisions/0021-lattice.md).
//
// Sampling goes over the picture in passes. The first ones take all nodes of the coarsest levels. Each later
// one takes the candidates above a threshold that falls from pass to pass; what a sample finds makes new
// candidates around it, which the same pass may take. So rays go in neighbouring order, and what is read and
// written stays in the caches.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/ray_sample.h"
#include "base/vector.h"
#include "pipeline/core/region_quality.h"
#include "pipeline/lattice/error_estimates.h"
#include "pipeline/lattice/lattice_painter.h"
#include "pipeline/lattice/lattice_region.h"
#include "pipeline/lattice/lattice_store.h"
#include "pipeline/lattice/local_errors.h"
#include "pipeline/lattice/node_prediction.h"
#include "pipeline/lattice/pass_growth.h"
#include "pipeline/lattice/surface_lights.h"
#include "pipeline/lattice/surface_samples.h"
#include "pipeline/lattice/surface_textures.h"
#include "pipeline/lattice/unsampled_surfaces.h"
#include "pipeline/sampling/time_forecast.h"
#include "pipeline/visibility/mixed_share.h"
#include "pipeline/visibility/seeing_gain.h"
#include "pipeline/visibility/visibility_buffer.h"

namespace pprt {

// What is sampled after the coarsest nodes.
enum class LatticeOrder : std::uint8_t {
  kAdaptive,  // what is worth most for its time
  kLevels     // all nodes of a level, then those of the next: each doubles the density
};

class LatticeRefiner {
 public:
  // For a region of an image; its tiles are whole base squares.
  LatticeRefiner(const Region& region, PrimitiveShapes shapes, LatticeOrder order = LatticeOrder::kAdaptive,
                 PrimitiveTextures textures = {}, PrimitiveLights lights = {});
  LatticeRefiner(const LatticeRefiner&) = delete;
  LatticeRefiner& operator=(const LatticeRefiner&) = delete;

  // Removes all samples, and what was learned from them.
  void clear();

  // Removes all samples, but keeps what was learned from them: for a picture much like this one.
  void restart();

  // Changes which nodes are wanted; keeps all samples.
  void set_region(const Region& region);
  const Region& region() const { return own_.region(); }

  // Projected shapes are of another camera from now on.
  void camera_changed();

  // Tells how many samples more there will be, about. Thresholds are set by it: too few or too many make the
  // picture coarser in one part than in another. Repeat the call on the way. Where it is not repeated as many
  // samples again are expected as there are.
  void expect(double samples_left) { expected_ = static_cast<double>(samples_) + samples_left; }

  // Tells what the time of a frame with a rate is good for. Comes after the base, before what follows.
  void expect_time(const TimeForecast& forecast) { forecast_ = forecast; }

  // Another frame adds to the picture.
  void carry_on() { forecast_.reset(); }

  // Returns the nodes at the corners of the region's base squares, some of which belong to other regions.
  std::vector<Vec2d> base_points() const;

  // Returns those without a sample. Squares between them are black.
  std::vector<Vec2d> missing_base() const;

  // Returns the image points of the next samples, pixels: `most` or fewer, at least one. They may lie up to
  // eight pixels beyond the right and lower border. Empty when nothing is worth a sample. Those that no
  // sample is inserted for come again. Valid until the next call.
  std::span<const Vec2d> next_points(std::size_t most);
  std::optional<Vec2d> next_point() {
    const std::span<const Vec2d> points = next_points(1);
    return points.empty() ? std::nullopt : std::optional(points.front());
  }

  // Takes in a sample. False if the lattice has no node at the point, or one that holds a sample. Compares it
  // with what was predicted at the last next_points(), if samples come in that order. Learns less of others.
  bool insert(const Vec2d& point, const RaySample& sample);

  std::size_t samples() const { return samples_; }  // other regions' included

  // Returns how many pixels show several surfaces, as far as that is known.
  std::size_t mixed_pixels() const { return visibility_.mixed_pixels(); }

  // Returns how many samples the coarsest grid has. They come first.
  std::size_t least_samples() const { return base_points().size(); }

  // Returns what a sample is worth at the candidates, their mean; 0 without any. Replaces `weights` by the
  // sums over the candidates of each tile: the square roots of their worth, whose mean falls as the
  // reciprocal of the samples. A sample's error and its area both halve with the area of a node, so its worth
  // is a quarter. Pixels of several surfaces are those of the last picture that was seen.
  double weigh(std::vector<TileWeights>& weights) const;

  // Replaces the pixels of parts of the image, within `bounds`. Each pixel is the mean over its area. Parts
  // are black while there are fewer than least_samples(). Pixels of the same bounds keep their colours
  // elsewhere. After each part asks whether time is over, and returns how many parts it has painted.
  std::size_t paint(const PixelRect& bounds, std::span<const PixelRect> parts, PixelBlock& pixels,
                    const std::function<bool()>& is_over);
  void paint(const PixelRect& bounds, PixelBlock& pixels) {
    paint(bounds, {&bounds, 1}, pixels, [] { return false; });
  }

 private:
  static constexpr std::int64_t kUnknown = -1;  // pixels of several surfaces in a tile that was never seen

  // Squared error that a sample without a prediction counts as.
  static constexpr float kUnpredicted = 1.0F / 32;

  // A node whose sample is wanted, and what is known of it.
  struct Wanted {
    LatticeNode node;
    LatticeLevel level;
    Prediction predicted;
    bool is_base = false;  // a corner of a base square: nothing predicts it
    float area = 0;        // if it stands for a surface that no sample lies on, square pixels
  };

  // A pass over all tiles, through some levels in each. In the first passes `takes_all` nodes of one level.
  struct Pass {
    std::size_t first_level = 0, end_level = 0;
    bool takes_base = false, takes_all = false;
    NodeState least = kLeastCandidate;  // priority taken
    float threshold = 0;                // worth taken
    double promised = 0;                // samples that its candidates were expected to lead to
  };

  void insert_wanted(const Wanted& at, const RaySample& sample);
  bool choose_next(bool may_go_on);
  bool is_open(const LatticeNode& node, bool is_base) const {
    return !store_.is_sampled(node) && (is_base ? own_.needs_base(node) : own_.owns(node));
  }
  void forget_samples();
  void note_seeing();
  void forget_visibility(const VisibilityBuffer::Fineness& fineness);
  void begin_square(const LatticeNode& corner);
  void leave_square(const LatticeNode& corner);
  double samples_left() const;

  bool next_nodes();
  void leave_nodes();
  bool next_tile();
  void learn_within_pass();
  bool leave_pass();
  bool start_pass();
  void ask_again();
  void choose_fineness();
  void add_mixed_pixels(std::vector<TileWeights>& weights) const;
  void see_in_time(double began_s);
  double expected_mixed() const {  // pixels of several surfaces
    return mixed_.expected(has_seen_) * static_cast<double>(region().pixel_count());
  }
  double samples_if_seen(double samples) const;
  double time_for_seeing(double samples) const;
  void choose_shares();
  bool start_grid_pass();
  bool start_refinement_pass();
  void start(const Pass& pass);
  void collect_base(int tile);
  NodeState& greatest_in(int tile, std::size_t level) {
    return greatest_[static_cast<std::size_t>(tile) * kLatticeLevels.size() + level];
  }
  Surroundings known_around(const LatticeNode& node, const LatticeLevel& level) const;
  bool is_wanted(const LatticeNode& node, const LatticeLevel& level);
  float worth_of(const LatticeNode& node, const LatticeLevel& level);
  float worth_around(const Wanted& at, float squared_error, float variance, Basis basis);
  void learn_share(const Wanted& at, const float4& seen);
  void learn_from_base();
  void set_sample(const LatticeNode& node, const NodeValue& value);
  void look_for_unsampled();
  void look_for_unsampled(const LatticeNode& square, int tile);
  bool next_surface();
  float worth_of_surface(const UnsampledSurface& surface);
  Surroundings base_corners(const LatticeNode& node);
  void make_candidates(const LatticeNode& node, const LatticeLevel& level, float worth_per_area);
  void look_beyond(const LatticeNode& middle, int side, float worth_per_area);
  void make_candidate(const LatticeNode& node, const LatticeLevel& level, NodeState priority);

  LatticeOrder order_;
  LatticeStore store_;
  LatticeRegion own_;
  std::vector<int> tiles_;  // in the order of passes
  VisibilityBuffer visibility_;
  SurfaceSamples surfaces_;
  UnsampledSurfaces unsampled_surfaces_;
  LocalErrors errors_;
  ErrorEstimates estimates_;
  SurfaceShare share_;
  SeeingGain gain_;
  MixedShare mixed_;
  SurfaceTextures textures_;
  SurfaceLights lights_;
  SampledSilhouettes silhouettes_;
  NodePredictor predictor_;
  LatticePainter painter_;

  std::size_t samples_ = 0, rays_ = 0;
  std::size_t learned_from_ = 0;  // samples, by the errors expected now
  double expected_ = 0;           // samples in the end

  Pass pass_;
  std::size_t grid_levels_ = 0;  // taken whole, the base not counted
  bool has_base_ = false, has_grid_ = false;
  bool has_fineness_ = false;
  std::optional<TimeForecast> forecast_;           // of the frame in which the picture begins
  double ask_again_at_ = 0;                        // samples, if nothing is seen by then
  bool was_seen_ = false;                          // this one, which is forgotten
  bool has_last_ = false;                          // a picture came before
  bool has_seen_ = false;                          // that picture
  SeeingPrice price_;                              // by the last picture that was seen
  std::vector<std::int64_t> mixed_of_tile_;        // pixels of several surfaces, when it was seen last
  double ray_s_;                                   // CPU time of one of its rays, by the last that was timed
  bool has_looked_ = false;                        // for unsampled surfaces
  std::vector<UnsampledSurface> surfaces_wanted_;  // of the tile, in this pass
  bool is_region_new_ = false;                     // its base may be missing
  PassGrowth growth_;
  float last_threshold_ = 0;
  int tile_ = 0;                     // of the pass
  std::span<const int> tiles_left_;  // for the pass after this one
  std::size_t level_ = 0;            // of the pass, in the tile
  std::vector<LatticeNode> nodes_;   // of the level in the tile
  std::size_t next_ = 0;
  std::vector<NodeState> greatest_;  // per tile and level: no candidate has a greater priority
  Wanted wanted_;                    // looked at last
  std::vector<Wanted> awaited_;      // returned by next_points()
  std::size_t arrived_ = 0;          // of them, from the front
  std::vector<Vec2d> points_;        // of those awaited
};

}  // namespace pprt
