// The samples of one frame, their Delaunay triangulation, and the queue of triangles to refine (paper
// s. 2.1).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/region.h"
#include "pipeline/sample.h"
#include "pipeline/sampling/refinement_weight.h"

namespace pprt {

// Where a picture shows primitives' edges (PixelRule::kEdges), how much of the colour of what belongs to a
// primitive is that of the corners on it; the rest is of all corners, for what lies between them may be
// hidden by a primitive that no corner is on.
inline constexpr float kEdgeShare = 0.75F;

// A Delaunay triangle. Corners index SampleMesh::samples().
struct MeshTriangle {
  Circle circumcircle;
  std::array<std::uint32_t, 3> corners;
};

// One that other regions may have to know.
struct BorderTriangle : MeshTriangle {
  std::array<bool, 3> own;  // per corner: whether it lies in the region
};

// Per tile of the region, over the triangles whose refinement point lies in it (paper s. 4.4:
// LastTotalWeight, LastTotalNum).
struct TileWeights {
  double total_weight = 0;
  std::int64_t triangles = 0;
};

// Invariants: the triangulation is Delaunay over all samples; every finite triangle with positive weight
// whose refinement point lies in the region is in the queue exactly once, unless next_point() took it and
// nothing was inserted there since. Samples outside the image are refused.
class SampleMesh {
 public:
  class Impl;

  explicit SampleMesh(const Region& region, const WeightTerms& terms = {});
  SampleMesh(SampleMesh&&) noexcept;
  SampleMesh& operator=(SampleMesh&&) noexcept;
  ~SampleMesh();

  // Forgets all samples, and what refinement has learned from them.
  void clear();

  // Forgets all samples, but not what was learned from them: for a picture much like this one.
  void restart();

  // Moves the border of what is refined here; keeps all samples. O(triangles).
  void set_region(const Region& region);
  const Region& region() const;

  // Adds a sample. False, and nothing changes, when its point already holds one or lies outside the image.
  // Expected O(1) near the samples inserted last or near the point next_point() gave.
  bool insert(const Sample& sample);

  // Between these, insert() only triangulates, and nothing else is asked: the triangles that are left are
  // weighed at the end. For many samples at once.
  void begin_many();
  void end_many();

  // Where the next sample is wanted most: the circumcentre of the heaviest triangle of the region or, when
  // that lies outside the image, the point where the way to it leaves the image. Empty when nothing is worth
  // refining. The caller inserts a sample there before it asks again.
  std::optional<Vec2d> next_point();

  // There are going to be so many times as many samples as now: what that many surely refine is refined an
  // octave of weight at a time, one neighbourhood after the other, which is faster than the heaviest first.
  // To be told again and again on the way, so that the end is fine. Holds until the samples are
  // forgotten.
  void expect_growth(double factor);

  // Of the triangle that next_point() refines, before the sample is inserted: what the picture shows there,
  // and its area in square pixels. That is the mean colour of its corners or, where pictures show edges,
  // mostly of those on the primitive that the sample has found.
  struct Guess {
    Color color;
    double area;
  };
  Guess guess(std::uint32_t primitive) const;

  std::span<const Sample> samples() const;

  // Replaces `triangles` by those that were inserted since the last call, still are, have a corner in the
  // region, and may not lie wholly in it by their circumcircle.
  void take_new_at_border(std::vector<BorderTriangle>& triangles);

  // From now on until the samples are forgotten, those without such a corner as well.
  void note_foreign();

  // One entry per tile of the grid; zero outside the region.
  std::span<const TileWeights> tile_weights() const;

  // Quality of the region, Q_k: mean weight of its triangles (paper s. 3.6); smaller is better. 0 without
  // any.
  double refinement() const;

  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

// Every finite triangle, corners counter-clockwise in the sense of x, y (clockwise on the screen, whose y
// grows downwards), as indices into mesh.samples().
std::vector<std::array<std::uint32_t, 3>> triangles(const SampleMesh& mesh);

}  // namespace pprt
