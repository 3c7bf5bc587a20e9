// The Delaunay triangulation of points that are inserted one by one: exact, and in compact arrays.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vector.h"
#include "pipeline/mesh/circumcircle.h"

namespace pprt {

// What the owner of a triangulation remembers of a triangle. It stays in the slot, also when another triangle
// takes the slot, until the owner changes it. In a new slot all fields are zero.
struct TriangleRecord {
  std::uint32_t stamp = 0;  // differs between triangles of one slot; 0: not counted in the statistics
  float weight = 0;
  std::int32_t tile = 0;  // that holds the refinement point
  std::uint32_t bin = 0;  // of LearnedWeights
};

// Points are numbered in the order of insertion, triangles by the slot that holds them. Beyond every edge of
// the convex hull lies a triangle whose third corner is kInfinite, so that each triangle has three
// neighbours. The insertion is Bowyer's and Watson's (1981) over exact predicates. Among cocircular points
// the perturbation of Devillers and Teillaud (2003) chooses the triangles, independent of the order of
// insertion: two ranks with the same points have the same triangles.
class Delaunay {
 public:
  using Index = std::uint32_t;

  static constexpr Index kInfinite = ~Index{0};
  static constexpr Index kNowhere = ~Index{0};  // no triangle

  // A triangle and one of its edges, as 4 * triangle + edge. Edge i lies opposite corner i.
  using Side = std::uint32_t;

  // Fills one cache line.
  struct alignas(64) Triangle {
    std::array<Index, 3> corners{};  // counter-clockwise; kInfinite only as the last
    std::array<Side, 3> across{};    // the sides of the neighbours
    Circumcircle circle;             // relative to the last corner; without meaning unless finite
    TriangleRecord record;

    bool is_finite() const { return corners[2] != kInfinite; }
  };

  // Removes all points; keeps the storage.
  void clear();

  // Whether there are triangles: there are once three points are not collinear.
  bool is_planar() const { return !triangles_.empty(); }

  const std::vector<Vec2d>& points() const { return points_; }

  // Every slot holds a triangle, finite or not.
  const std::vector<Triangle>& triangles() const { return triangles_; }

  TriangleRecord& record(Index triangle) { return triangles_[triangle].record; }

  // Returns the circumcentre of a finite triangle.
  Vec2d circumcenter(Index triangle) const {
    return points_[triangles_[triangle].corners[2]] + triangles_[triangle].circle.to_center();
  }

  // Finds a triangle whose circumcircle holds the point, walking from slot `from`: an insertion begins there.
  // Returns kNowhere when the point is a corner already. Needs is_planar().
  Index locate(const Vec2d& point, Index from) const;

  // Whether the triangle is finite and its circle strictly holds the point, which then is no corner of any
  // triangle: a check of a guess, cheaper than locate().
  bool surely_holds(Index triangle, const Vec2d& point) const;

  // Adds a point, new by locate() or surely_holds(), which gave `at`. Afterwards new_triangles() holds the
  // slots of exactly the triangles around the point; those of all triangles that it destroyed are among them.
  void insert(const Vec2d& point, Index at);
  std::span<const Index> new_triangles() const { return created_; }

  // The corners around the newest point. New triangle k lies between corner k and the next, the last triangle
  // between the last corner and the first. kInfinite where a triangle is not finite.
  std::span<const Index> boundary_corners() const { return boundary_corners_; }

  // Adds a point while there are no triangles; returns false when it is there already. After the first point
  // off the line all triangles are new.
  bool insert_before_planar(const Vec2d& point);

 private:
  // An edge of a cavity's boundary, counter-clockwise around the cavity.
  struct Edge {
    Index from, to;
    Side beyond;  // of the triangle outside
  };

  bool destroys(const Vec2d& point, const Triangle& triangle) const;
  [[gnu::noinline]] bool exactly_destroys(const Vec2d& point, const Triangle& triangle) const;
  void find_cavity(const Vec2d& point, Index at);
  void gather_boundary(Index point);
  void retriangulate(Index point);
  void compute_circles();
  void span_first_triangle(Index a, Index b, Index c);

  std::vector<Vec2d> points_;
  std::vector<Triangle> triangles_;
  std::vector<Side> to_cross_;  // sides of the cavity that find_cavity() has still to look across
  std::vector<Edge> boundary_;  // of the cavity
  std::vector<Index> created_, boundary_corners_;
  std::vector<double> from_point_x_, from_point_y_;  // boundary corners, relative to the newest point
};

}  // namespace pprt
