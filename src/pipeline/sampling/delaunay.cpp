#include "pipeline/sampling/delaunay.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "pipeline/sampling/predicates.h"
#include "pipeline/sampling/refinement_weight.h"
#include "pipeline/simd.h"

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

// in_circle() of points whose heights over the paraboloid are raised by as little as one likes, those that
// come later in lexicographic order by infinitely more. The heights' determinant then has the sign of what
// the last point contributes: no three points of a circle are collinear.
bool lies_inside(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d) {
  const int sign = in_circle(a, b, c, d);
  if (sign != 0) return sign > 0;
  const Vec2d& last = std::max({a, b, c, d}, is_lexicographically_less);
  if (last == a) return orientation(d, b, c) > 0;
  if (last == b) return orientation(a, d, c) > 0;
  if (last == c) return orientation(a, b, d) > 0;
  return false;
}

// Of three collinear points.
bool lies_between(const Vec2d& p, const Vec2d& a, const Vec2d& b) {
  const auto [low, high] = std::minmax(a, b, is_lexicographically_less);
  return is_lexicographically_less(low, p) && is_lexicographically_less(p, high);
}

// Of four triangles that turn to the left, each with the corners a, b and the one all is seen from.
void measure_circles(const Doubles& ax, const Doubles& ay, const Doubles& bx, const Doubles& by,
                     std::array<Circumcircle, kLanes>& circles) {
  const Doubles cross = ax * by - ay * bx;
  const Doubles a2 = ax * ax + ay * ay, b2 = bx * bx + by * by;
  const Doubles abx = bx - ax, aby = by - ay, ab2 = abx * abx + aby * aby;
  const Doubles scale = 1 / (cross > kSmallestDoubleArea ? cross : Doubles{} + kSmallestDoubleArea);
  Doubles x = (by * a2 - ay * b2) * scale, y = (ax * b2 - bx * a2) * scale;
  // Counted in docs/numerics.md: products of at most N, a cross product of parts that add up to X.
  const Doubles n = (size(ax) + size(ay)) * b2 + (size(bx) + size(by)) * a2,
                parts = size(ax * by) + size(ay * bx);
  constexpr double kCounted = 64 * 0x1p-53;
  Doubles slack = cross > kSmallestDoubleArea ? kCounted * n * parts * scale * scale
                                              : Doubles{} + std::numeric_limits<double>::infinity();
  Doubles size2 = min(0.25 * (x * x + y * y), max(ab2, max(a2, b2)));
  for (int i = 0; i < kLanes; ++i)
    circles[i] = {x[i], y[i], static_cast<float>(slack[i]), static_cast<float>(size2[i])};
}

}  // namespace

void Delaunay::clear() {
  points_.clear();
  triangles_.clear();
  created_.clear();
  around_.clear();
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
  return side != 0 ? side > 0 : surely_destroys(point, triangle);
}

// Where the circle does not tell.
bool Delaunay::surely_destroys(const Vec2d& point, const Triangle& triangle) const {
  const Vec2d &a = points_[triangle.corners[0]], &b = points_[triangle.corners[1]];
  if (triangle.is_finite()) return lies_inside(a, b, points_[triangle.corners[2]], point);
  const int side_of_hull = orientation(a, b, point);
  return side_of_hull > 0 || (side_of_hull == 0 && lies_between(point, a, b));
}

void Delaunay::insert(const Vec2d& point, Index at) {
  dig(point, at);
  points_.push_back(point);
  const auto apex = static_cast<Index>(points_.size() - 1);
  look_around(apex);
  fill(apex);
  measure();
}

// The triangles that the point destroys hang together and hold no corner inside, so the way from one to the
// next is a tree: its leaves, taken in order, go around the hole.
void Delaunay::dig(const Vec2d& point, Index at) {
  created_.clear();
  created_.push_back(at);
  rim_.clear();
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
      rim_.push_back({inner.corners[after(edge_of(s))], inner.corners[before(edge_of(s))], beyond});
    }
  }
}

// A triangle from every edge of the rim to the point, in the slots of those destroyed and two more.
void Delaunay::fill(Index point) {
  for (std::size_t more = created_.size(); more < rim_.size(); ++more) {
    created_.push_back(static_cast<Index>(triangles_.size()));
    triangles_.emplace_back();
  }
  // Where the edge's beginning stands among the corners, so that infinity comes last.
  const auto turn = [](const Edge& edge) {
    return edge.from == kInfinite ? 2u : edge.to == kInfinite ? 1u : 0u;
  };
  Side from_last = side(created_.back(), turn(rim_.back()));  // opposite the beginning: shared with the next
  for (std::size_t k = 0; k < rim_.size(); ++k) {
    const Edge& edge = rim_[k];
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

// Before fill(): what is stored number by number can be loaded four at a time only after a while.
void Delaunay::look_around(Index point) {
  const std::size_t count = rim_.size(), padded = (count + kLanes - 1) / kLanes * kLanes + 1;
  around_.resize(count);
  from_point_x_.resize(padded), from_point_y_.resize(padded);
  const Vec2d apex = points_[point];
  for (std::size_t k = 0; k < count; ++k) {
    around_[k] = rim_[k].from;
    const Vec2d offset = around_[k] == kInfinite ? Vec2d(0, 0) : points_[around_[k]] - apex;
    from_point_x_[k] = offset.x, from_point_y_[k] = offset.y;
  }
  from_point_x_[count] = from_point_x_[0], from_point_y_[count] = from_point_y_[0];
}

// The circles of the triangles around the point, four at once.
PPRT_CLONED_FOR_WIDE_REGISTERS
void Delaunay::measure() {
  std::array<Circumcircle, kLanes> circles;
  const std::size_t count = created_.size();
  for (std::size_t k = 0; k < count; k += kLanes) {
    const double *x = &from_point_x_[k], *y = &from_point_y_[k];
    measure_circles(load<Doubles>(x), load<Doubles>(y), load<Doubles>(x + 1), load<Doubles>(y + 1), circles);
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
    dig(points_[p], locate(points_[p], created_.empty() ? 0 : created_.front()));
    look_around(p);
    fill(p);
    measure();
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
  const Vec2d from_c_to_a = points_[a] - points_[c], from_c_to_b = points_[b] - points_[c];
  const auto all = [](double v) { return Doubles{} + v; };
  std::array<Circumcircle, kLanes> circles;
  measure_circles(all(from_c_to_a.x), all(from_c_to_a.y), all(from_c_to_b.x), all(from_c_to_b.y), circles);
  triangles_.front().circle = circles.front();
}

}  // namespace pprt
