// The Delaunay triangulation of points that come one by one: exact, compact, in arrays that keep their
// storage.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vector.h"
#include "pipeline/sampling/circumcircle.h"

namespace pprt {

// Points are numbered in the order of insertion, triangles by the slot that holds them. Outside every edge of
// the convex hull stands a triangle whose third corner is kInfinite, so that each triangle has three
// neighbours. Bowyer's and Watson's insertion (1981) over exact predicates. Of cocircular points the
// triangulation is the one that Devillers and Teillaud's perturbation (2003) chooses, whatever their order of
// insertion: two ranks that know the same points hold the same triangles.
class Delaunay {
 public:
  using Index = std::uint32_t;

  static constexpr Index kInfinite = ~Index{0};
  static constexpr Index kNowhere = ~Index{0};  // no triangle

  // A side is a triangle and one of its edges, 4 * triangle + edge; edge i lies opposite corner i.
  using Side = std::uint32_t;

  // What whoever owns the triangulation remembers of a triangle. It stays in the slot until the owner changes
  // it; in a new slot it is zero.
  struct Note {
    std::uint32_t stamp = 0;
    float weight = 0;
    std::int32_t tile = 0;
    std::uint32_t kind = 0;
  };

  // One line of cache.
  struct alignas(64) Triangle {
    std::array<Index, 3> corners{};  // counter-clockwise; kInfinite only as the last
    std::array<Side, 3> across{};    // the sides of the neighbours
    Circumcircle circle;             // seen from the last corner; of no meaning unless finite
    Note note;

    bool is_finite() const { return corners[2] != kInfinite; }
  };

  // Forgets all points; keeps the storage.
  void clear();

  // Whether there are triangles: three points that are not collinear.
  bool is_planar() const { return !triangles_.empty(); }

  const std::vector<Vec2d>& points() const { return points_; }

  // Every slot holds a triangle, finite or not.
  const std::vector<Triangle>& triangles() const { return triangles_; }

  Note& note(Index triangle) { return triangles_[triangle].note; }

  // Of a finite triangle.
  Vec2d circumcenter(Index triangle) const {
    return points_[triangles_[triangle].corners[2]] + triangles_[triangle].circle.to_center();
  }

  // Some triangle whose circumcircle holds the point, found by walking from slot `from`: where an insertion
  // begins. kNowhere when the point is there already. Needs is_planar().
  Index locate(const Vec2d& point, Index from) const;

  // The same, where a triangle is supposed to be the answer: true only if its circle strictly holds the
  // point, which then is no corner of any triangle.
  bool surely_holds(Index triangle, const Vec2d& point) const;

  // Adds a point that locate() or surely_holds() found new. The slots of all triangles that it destroyed are
  // among new_triangles(), which holds exactly the triangles around it.
  void insert(const Vec2d& point, Index at);
  std::span<const Index> new_triangles() const { return created_; }

  // The new triangles' corners around the point, which all of them share: triangle k lies between number k
  // and the next, the last between the last and the first. kInfinite where one of them is not finite.
  std::span<const Index> around_new() const { return around_; }

  // Adds a point while there are no triangles, false when it is there already. When it is the first off the
  // line, all triangles are new.
  bool insert_before_planar(const Vec2d& point);

 private:
  // An edge of the hole that an insertion makes, counter-clockwise around it.
  struct Edge {
    Index from, to;
    Side beyond;
  };

  bool destroys(const Vec2d& point, const Triangle& triangle) const;
  [[gnu::noinline]] bool surely_destroys(const Vec2d& point, const Triangle& triangle) const;
  void dig(const Vec2d& point, Index at);
  void fill(Index point);
  void look_around(Index point);
  void measure();
  void span_first_triangle(Index a, Index b, Index c);

  std::vector<Vec2d> points_;
  std::vector<Triangle> triangles_;
  std::vector<Side> to_cross_;  // sides of the hole that dig() has not looked across yet
  std::vector<Edge> rim_;       // of the hole
  std::vector<Index> created_, around_;
  std::vector<double> from_point_x_, from_point_y_;  // of those around it
};

}  // namespace pprt
