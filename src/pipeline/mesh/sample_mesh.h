// The samples of one frame, their Delaunay triangulation, and the queue of triangles to refine (paper
// s. 2.1).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/core/region.h"
#include "pipeline/core/region_quality.h"
#include "pipeline/core/sample.h"
#include "pipeline/mesh/bucket_queue.h"
#include "pipeline/mesh/delaunay.h"
#include "pipeline/mesh/fan_weights.h"
#include "pipeline/mesh/learned_weights.h"
#include "pipeline/mesh/mesh_corner.h"
#include "pipeline/mesh/refinement_weight.h"

namespace pprt {

// Where pictures show edges (PixelRule::kEdges), the share of a point's colour that comes from the corners on
// the primitive seen there. The rest comes from all three corners: a primitive that no corner is on may hide
// what lies between them.
inline constexpr float kEdgeShare = 0.75F;

// A Delaunay triangle. Corners index SampleMesh::samples().
struct MeshTriangle {
  Circle circumcircle;
  std::array<std::uint32_t, 3> corners;
};

// A triangle that other regions may have to know.
struct BorderTriangle : MeshTriangle {
  std::array<bool, 3> own;  // per corner: whether it lies in the region
};

// A triangle to refine next, as SampleMesh::next_point() found it. Valid until the mesh changes.
class Refinement {
 public:
  // Where the sample is wanted, pixels.
  Vec2d point;

 private:
  friend class SampleMesh;
  Refinement(const Vec2d& wanted, Delaunay::Index refined) : point(wanted), triangle_(refined) {}

  Delaunay::Index triangle_;
};

// Invariants: the triangulation is Delaunay over all samples. Every finite triangle with positive weight
// whose refinement point lies in the region is in the queue exactly once, unless next_point() took it and no
// sample was inserted there since. Samples outside the image are refused.
class SampleMesh {
 public:
  explicit SampleMesh(const Region& region, const WeightTerms& terms = {});

  // Removes all samples, and what refinement has learned from them.
  void clear();

  // Removes all samples, but keeps what was learned from them: for a picture much like this one.
  void restart();

  // Changes which triangles are refined here; keeps all samples. O(triangles).
  void set_region(const Region& region);
  const Region& region() const { return region_; }

  // Adds a sample. Returns false, and changes nothing, when its point already holds one or lies outside the
  // image. Expected O(1) near the samples inserted last and at the point of next_point().
  bool insert(const Sample& sample);

  // Adds samples in their order, and computes weights once at the end, only of the triangles that are left.
  // Calls done(sample, whether it was inserted) after each one. `done` must neither change the mesh nor ask
  // it for weights or points.
  using Inserted = std::function<void(const Sample& sample, bool is_new)>;
  void insert_all(std::span<const Sample> samples, const Inserted& done = {});

  // Takes the heaviest triangle of the region from the queue. The next sample is wanted at its circumcentre
  // or, when that lies outside the image, where the way to it leaves the image. Empty when nothing is worth
  // refining. The caller inserts a sample there before it asks again.
  std::optional<Refinement> next_point();

  // Hint: the frame will end with `factor` times the current samples. Triangles certain to be refined are
  // popped one octave of weight at a time, in spatial order, which is faster than the heaviest first. Repeat
  // the call on the way, so that the end is exact. Holds until the samples are removed.
  void expect_growth(double factor);

  // What the picture shows in a triangle before a sample refines it.
  struct Guess {
    Color color;
    double area;  // of the triangle, square pixels
  };

  // Returns the guess for a sample on this primitive: the mean colour of the corners or, where pictures show
  // edges, mostly of those on the same primitive.
  Guess guess(const Refinement& at, std::uint32_t primitive) const;

  std::span<const Sample> samples() const { return samples_; }

  // What reconstruction reads. Points and corners have the same numbers as samples().
  const Delaunay& triangulation() const { return delaunay_; }
  const std::vector<MeshCorner>& corners() const { return corners_; }

  // Replaces `triangles` by those that were made since the last call and still exist, have a corner in the
  // region, and whose circumcircle may reach beyond the region.
  void take_new_at_border(std::vector<BorderTriangle>& triangles);

  // Includes triangles without such a corner from now on, until the samples are removed.
  void note_foreign() { notes_foreign_ = true; }

  // One entry per tile of the grid; zero outside the region.
  std::span<const TileWeights> tile_weights() const { return tile_weights_; }

  // Returns Q_k of the region: the mean weight of its triangles (paper s. 3.6), 0 without any. Smaller
  // is better.
  double mean_weight() const;
  RegionQuality quality() const { return {region_, tile_weights_, mean_weight()}; }

  // Whether that is at most `weight`. O(1) unless they are nearly equal.
  bool is_refined_to(double weight) const;

 private:
  using Index = Delaunay::Index;
  using Points = std::array<Vec2d, 3>;

  // A triangle in a slot. It exists while the slot's record has the same stamp.
  struct StampedTriangle {
    Index triangle;
    std::uint32_t stamp;
  };
  struct StampedBorderTriangle {
    StampedTriangle stamped;
    BorderTriangle triangle;
  };

  bool exists(const StampedTriangle& t) const {
    return delaunay_.triangles()[t.triangle].record.stamp == t.stamp;
  }

  // Adds a sample and retires the triangles it destroys. Weighs the new ones only if `enqueues`.
  bool add(const Sample& sample, bool enqueues);
  Index find(const Vec2d& point, int tile, const Refinement* wanted);
  std::size_t cell_of(const Vec2d& point) const;

  float error_found(Index triangle, const Sample& sample) const;
  void learn(Index triangle, float squared_error, std::uint32_t rays);
  float4 color_shown(Index triangle, std::uint32_t primitive) const;

  void enqueue_new();
  void enqueue(Index triangle);
  void enqueue(Index triangle, float weight, Bin bin);
  void retire(TriangleRecord& record);
  void count(const TriangleRecord& record, int sign);
  void enqueue_all_again();
  void note_at_border(Index triangle);

  Vec2d refinement_point(Index triangle) const;
  Points points_of(Index triangle) const;
  double area_of(Index triangle) const;

  Region region_;
  WeightTerms terms_;
  Delaunay delaunay_;
  std::vector<Sample> samples_;
  std::vector<MeshCorner> corners_;  // one per sample
  BucketQueue<StampedTriangle> queue_;
  std::vector<TileWeights> tile_weights_;
  TileWeights all_weights_;  // their sum, up to the rounding of a running sum
  LearnedWeights learned_;
  FanWeights fan_weights_;  // of the triangles that the last insertion made
  std::uint32_t next_stamp_ = 1;
  std::optional<Refinement> wanted_;  // the answer of next_point(), until anything is inserted

  // Triangles to start a walk from, by tile and by cell of kCellPixels; kNowhere before the first.
  std::vector<Index> latest_in_tile_, latest_in_cell_;

  std::vector<StampedBorderTriangle> new_at_border_;
  bool notes_foreign_ = false;
};

// Returns every finite triangle as indices into mesh.samples(). Corners are counter-clockwise in the sense of
// x, y: clockwise on the screen, whose y grows downwards.
std::vector<std::array<std::uint32_t, 3>> triangles(const SampleMesh& mesh);

}  // namespace pprt
