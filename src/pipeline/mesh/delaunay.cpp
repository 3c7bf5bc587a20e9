#include "pipeline/mesh/delaunay.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/simd.h"
#include "pipeline/mesh/predicates.h"
#include "pipeline/mesh/refinement_weight.h"

namespace pprt {
namespace {

using Index = Delaunay::Index;
using Side = Delaunay::Side;

constexpr Side side(Index triangle, unsigned edge) {
  return 4 * triangle + edge;
}
constexpr Index triangle_of(Side s) {
  return s / 4;
}
constexpr unsigned edge_of(Side s) {
  return s % 4;
}
constexpr unsigned after(unsigned corner) {
  return corner == 2 ? 0 : corner + 1;
}
constexpr unsigned before(unsigned corner) {
  return corner == 0 ? 2 : corner - 1;
}

bool is_lexicographically_less(const Vec2d& a, const Vec2d& b) {
  return a.x != b.x ? a.x < b.x : a.y < b.y;
}

// in_circle() under symbolic perturbation: the lexicographically later point dominates. Its contribution
// decides the sign of the determinant, for no three points of a circle are collinear.
bool lies_inside(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d) {
  const int sign = in_circle(a, b, c, d);
  if (sign != 0) return sign > 0;
  const Vec2d& last = std::max({a, b, c, d}, is_lexicographically_less);
  if (last == a) return orientation(d, b, c) > 0;
  if (last == b) return orientation(a, d, c) > 0;
  if (last == c) return orientation(a, b, d) > 0;
  return false;
}

// Whether p lies strictly between a and b, all collinear.
bool lies_between(const Vec2d& p, const Vec2d& a, const Vec2d& b) {
  const auto [low, high] = std::minmax(a, b, is_lexicographically_less);
  return is_lexicographically_less(low, p) && is_lexicographically_less(p, high);
}

// Computes the circles of four triangles that turn to the left. Corners a and b are relative to the third.
// Scalar twin: circumcircle() in circumcircle.h.
void circumcircles(const double4& ax, const double4& ay, const double4& bx, const double4& by,
                   std::array<Circumcircle, kLanes>& circles) {
  const double4 cross = ax * by - ay * bx;
  const double4 a2 = ax * ax + ay * ay, b2 = bx * bx + by * by;
  const double4 abx = bx - ax, aby = by - ay, ab2 = abx * abx + aby * aby;
  const double4 scale = 1 / (cross > kSmallestDoubleArea ? cross : double4{} + kSmallestDoubleArea);
  double4 x = (by * a2 - ay * b2) * scale, y = (ax * b2 - bx * a2) * scale;
  // Counted in docs/numerics.md: N is the size of the numerators, X that of the cross product's parts.
  const double4 n = (abs(ax) + abs(ay)) * b2 + (abs(bx) + abs(by)) * a2, parts = abs(ax * by) + abs(ay * bx);
  double4 slack = cross > kSmallestDoubleArea ? kCircumcircleRounding * n * parts * scale * scale
                                              : double4{} + std::numeric_limits<double>::infinity();
  double4 size2 = min(0.25 * (x * x + y * y), max(ab2, max(a2, b2)));
  for (int i = 0; i < kLanes; ++i)
    circles[i] = {x[i], y[i], static_cast<float>(slack[i]), static_cast<float>(size2[i])};
}

}  // namespace

void Delaunay::clear() {
  points_.clear();
  triangles_.clear();
  created_.clear();
  boundary_corners_.clear();
}

Index Delaunay::locate(const Vec2d& point, Index from) const {
  Index here = triangles_[from].is_finite() ? from : triangle_of(triangles_[from].across[2]);
  unsigned entered = 3;  // through this edge
  while (true) {
    const Triangle& t = triangles_[here];
    if (!t.is_finite()) return here;
    const auto corner = [&](unsigned i) -> const Vec2d& { return points_[t.corners[i]]; };
    unsigned edge = 0;
    while (edge < 3 &&
           (edge == entered || orientation(corner(after(edge)), corner(before(edge)), point) >= 0))
      ++edge;
    if (edge == 3) {
      const bool taken = point == corner(0) || point == corner(1) || point == corner(2);
      return taken ? kNowhere : here;
    }
    const Side next = t.across[edge];
    here = triangle_of(next);
    entered = edge_of(next);
  }
}

bool Delaunay::surely_holds(Index triangle, const Vec2d& point) const {
  const auto& [a, b, c] = triangles_[triangle].corners;
  if (c == kInfinite) return false;
  const int side = side_of_circle(triangles_[triangle].circle, point - points_[c]);
  return side != 0 ? side > 0 : in_circle(points_[a], points_[b], points_[c], point) > 0;
}

bool Delaunay::destroys(const Vec2d& point, const Triangle& triangle) const {
  const int side =
      triangle.is_finite() ? side_of_circle(triangle.circle, point - points_[triangle.corners[2]]) : 0;
  return side != 0 ? side > 0 : exactly_destroys(point, triangle);
}

// For points so near the circle that rounding might decide.
bool Delaunay::exactly_destroys(const Vec2d& point, const Triangle& triangle) const {
  const Vec2d &a = points_[triangle.corners[0]], &b = points_[triangle.corners[1]];
  if (triangle.is_finite()) return lies_inside(a, b, points_[triangle.corners[2]], point);
  const int side_of_hull = orientation(a, b, point);
  return side_of_hull > 0 || (side_of_hull == 0 && lies_between(point, a, b));
}

// The circles of the triangles 0, 1 and 2 hold p: they are its cavity. Its boundary is a b c d e. The three
// slots and two new ones then hold a fan, one triangle from each edge of the boundary to p.
//
//      d ------- c           d ------- c
//    / |      .' |         / `.   1  .'|
//   /  | 1  .'   |        /  0 `.  .'  |
//  e 0 |  .'     |       e ----- p   2 |
//   \  |.'  p  2 |        \  4 .' `.   |
//    \ |         |         \ .'  3  `. |
//      a ------- b           a ------- b
void Delaunay::insert(const Vec2d& point, Index at) {
  find_cavity(point, at);
  points_.push_back(point);
  const auto apex = static_cast<Index>(points_.size() - 1);
  gather_boundary(apex);
  retriangulate(apex);
  compute_circles();
}

// Fills created_ with the cavity's triangles, and boundary_ with its edges in their order around it. The
// cavity is connected and has no corner in its interior. So the ways from triangle to triangle form a tree,
// and its leaves, visited in order, are the boundary.
void Delaunay::find_cavity(const Vec2d& point, Index at) {
  created_.clear();
  created_.push_back(at);
  boundary_.clear();
  to_cross_.clear();
  for (const unsigned edge : {2u, 1u, 0u}) {
    to_cross_.push_back(side(at, edge));
    __builtin_prefetch(&triangles_[triangle_of(triangles_[at].across[edge])]);
  }
  while (!to_cross_.empty()) {
    const Side s = to_cross_.back();
    to_cross_.pop_back();
    const Triangle& inner = triangles_[triangle_of(s)];
    const Side beyond = inner.across[edge_of(s)];
    const Index neighbour = triangle_of(beyond);
    if (destroys(point, triangles_[neighbour])) {
      created_.push_back(neighbour);
      to_cross_.push_back(side(neighbour, before(edge_of(beyond))));
      to_cross_.push_back(side(neighbour, after(edge_of(beyond))));
      for (const Side next : triangles_[neighbour].across) __builtin_prefetch(&triangles_[triangle_of(next)]);
    } else {
      boundary_.push_back({inner.corners[after(edge_of(s))], inner.corners[before(edge_of(s))], beyond});
    }
  }
}

// Copies the boundary's corners, relative to the point, for compute_circles(). Done before retriangulate():
// numbers stored one by one can be loaded four at a time only after a while.
void Delaunay::gather_boundary(Index point) {
  const std::size_t count = boundary_.size(), padded = (count + kLanes - 1) / kLanes * kLanes + 1;
  boundary_corners_.resize(count);
  from_point_x_.resize(padded), from_point_y_.resize(padded);
  const Vec2d apex = points_[point];
  for (std::size_t k = 0; k < count; ++k) {
    boundary_corners_[k] = boundary_[k].from;
    const Vec2d offset =
        boundary_corners_[k] == kInfinite ? Vec2d(0, 0) : points_[boundary_corners_[k]] - apex;
    from_point_x_[k] = offset.x, from_point_y_[k] = offset.y;
  }
  from_point_x_[count] = from_point_x_[0], from_point_y_[count] = from_point_y_[0];
}

// Makes a triangle from every edge of the boundary to the point, in the slots of the cavity and two more.
void Delaunay::retriangulate(Index point) {
  for (std::size_t more = created_.size(); more < boundary_.size(); ++more) {
    created_.push_back(static_cast<Index>(triangles_.size()));
    triangles_.emplace_back();
  }
  // The edge's beginning becomes this corner, so that infinity comes last.
  const auto turn = [](const Edge& edge) {
    return edge.from == kInfinite ? 2u : edge.to == kInfinite ? 1u : 0u;
  };
  // The side opposite an edge's beginning is shared with the next triangle of the fan.
  Side from_last = side(created_.back(), turn(boundary_.back()));
  for (std::size_t k = 0; k < boundary_.size(); ++k) {
    const Edge& edge = boundary_[k];
    const unsigned first = turn(edge), second = after(first), third = after(second);
    Triangle& t = triangles_[created_[k]];
    t.corners[first] = edge.from, t.corners[second] = edge.to, t.corners[third] = point;
    t.across[third] = edge.beyond;
    triangles_[triangle_of(edge.beyond)].across[edge_of(edge.beyond)] = side(created_[k], third);
    t.across[second] = from_last;
    triangles_[triangle_of(from_last)].across[edge_of(from_last)] = side(created_[k], second);
    from_last = side(created_[k], first);
  }
}

// Computes the circles of the fan's triangles, four at a time. A circle that is not finite has no meaning.
PPRT_CLONED_FOR_WIDE_REGISTERS
void Delaunay::compute_circles() {
  std::array<Circumcircle, kLanes> circles;
  const std::size_t count = created_.size();
  for (std::size_t k = 0; k < count; k += kLanes) {
    const double *x = &from_point_x_[k], *y = &from_point_y_[k];
    circumcircles(load<double4>(x), load<double4>(y), load<double4>(x + 1), load<double4>(y + 1), circles);
    for (std::size_t i = 0; i < kLanes && k + i < count; ++i) triangles_[created_[k + i]].circle = circles[i];
  }
}

bool Delaunay::insert_before_planar(const Vec2d& point) {
  if (std::find(points_.begin(), points_.end(), point) != points_.end()) return false;
  points_.push_back(point);
  const auto apex = static_cast<Index>(points_.size() - 1);
  if (apex < 2) return true;
  const int turn = orientation(points_[0], points_[1], point);
  if (turn == 0) return true;
  span_first_triangle(turn > 0 ? 0 : 1, turn > 0 ? 1 : 0, apex);
  for (Index p = 2; p < apex; ++p) {
    find_cavity(points_[p], locate(points_[p], created_.empty() ? 0 : created_.front()));
    gather_boundary(p);
    retriangulate(p);
    compute_circles();
  }
  return true;
}

void Delaunay::span_first_triangle(Index a, Index b, Index c) {
  created_.clear();
  triangles_.assign(4, {});
  triangles_[0].corners = {a, b, c};
  triangles_[1].corners = {c, b, kInfinite}, triangles_[2].corners = {a, c, kInfinite},
  triangles_[3].corners = {b, a, kInfinite};
  const auto join = [&](Side s, Side t) {
    triangles_[triangle_of(s)].across[edge_of(s)] = t;
    triangles_[triangle_of(t)].across[edge_of(t)] = s;
  };
  for (unsigned i = 0; i < 3; ++i) join(side(0, i), side(i + 1, 2));
  join(side(1, 1), side(2, 0));  // from c to infinity
  join(side(2, 1), side(3, 0));  // from a
  join(side(3, 1), side(1, 0));  // from b
  triangles_.front().circle = circumcircle(points_[a] - points_[c], points_[b] - points_[c]);
}

}  // namespace pprt
