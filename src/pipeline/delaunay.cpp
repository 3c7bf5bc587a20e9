#include "pipeline/delaunay.h"

#include <algorithm>
#include <utility>

#include "pipeline/predicates.h"

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

}  // namespace

void Delaunay::clear() {
  points_.clear();
  triangles_.clear();
  created_.clear();
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
  return c != kInfinite && in_circle(points_[a], points_[b], points_[c], point) > 0;
}

bool Delaunay::destroys(const Vec2d& point, const Triangle& triangle) const {
  const Vec2d &a = points_[triangle.corners[0]], &b = points_[triangle.corners[1]];
  if (triangle.is_finite()) return lies_inside(a, b, points_[triangle.corners[2]], point);
  const int side_of_hull = orientation(a, b, point);
  return side_of_hull > 0 || (side_of_hull == 0 && lies_between(point, a, b));
}

void Delaunay::insert(const Vec2d& point, Index at) {
  dig(point, at);
  points_.push_back(point);
  fill(static_cast<Index>(points_.size() - 1));
}

// The triangles that the point destroys hang together and hold no corner inside, so the way from one to the
// next is a tree: its leaves, taken in order, go around the hole.
void Delaunay::dig(const Vec2d& point, Index at) {
  created_.clear();
  created_.push_back(at);
  rim_.clear();
  to_cross_.clear();
  for (const unsigned edge : {2u, 1u, 0u}) to_cross_.push_back(side(at, edge));
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
    fill(p);
  }
  return true;
}

void Delaunay::span_first_triangle(Index a, Index b, Index c) {
  created_.clear();
  triangles_ = {{{a, b, c}, {}}, {{c, b, kInfinite}, {}}, {{a, c, kInfinite}, {}}, {{b, a, kInfinite}, {}}};
  const auto join = [&](Side s, Side t) {
    triangles_[triangle_of(s)].across[edge_of(s)] = t;
    triangles_[triangle_of(t)].across[edge_of(t)] = s;
  };
  for (unsigned i = 0; i < 3; ++i) join(side(0, i), side(i + 1, 2));
  join(side(1, 1), side(2, 0));  // from c to infinity
  join(side(2, 1), side(3, 0));  // from a
  join(side(3, 1), side(1, 0));  // from b
}

}  // namespace pprt
