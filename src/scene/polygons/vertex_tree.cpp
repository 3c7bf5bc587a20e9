#include "scene/polygons/vertex_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "scene/polygons/turn.h"

namespace pprt {
namespace {

constexpr std::size_t kMembersOfLeaf = 8;
constexpr std::size_t kSample = 64;  // members of a node that choose how it is split
constexpr std::uint32_t kNoPlace = std::numeric_limits<std::uint32_t>::max();

Vec2d quarter_turn(const Vec2d& v) {
  return {-v.y, v.x};
}

Vec2d along(const Vec2d& axis, const Vec2d& p) {
  return {axis.x * p.x + axis.y * p.y, axis.x * p.y - axis.y * p.x};
}

// Whether the whole box lies to the right of the line from a to b. Its corner farthest to the left decides.
bool right_of(const Vec2d& a, const Vec2d& b, const Imath::Box2d& box) {
  const Vec2d corner(b.y > a.y ? box.min.x : box.max.x, b.x > a.x ? box.max.y : box.min.y);
  return turn(a, b, corner) < 0;
}

// Whether a box has no point in common with a triangle. Near a sharp corner it may be missed.
bool apart(const Imath::Box2d& box, const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return std::max({a.x, b.x, c.x}) < box.min.x || std::min({a.x, b.x, c.x}) > box.max.x ||
         std::max({a.y, b.y, c.y}) < box.min.y || std::min({a.y, b.y, c.y}) > box.max.y ||
         right_of(a, b, box) || right_of(b, c, box) || right_of(c, a, box);
}

}  // namespace

VertexTree::VertexTree(std::span<const Vec2d> points, std::vector<std::uint32_t> members)
    : points_(points),
      members_(std::move(members)),
      removed_(members_.size(), false),
      place_of_(points.size(), kNoPlace),
      first_leaf_(std::bit_ceil(members_.size() / kMembersOfLeaf + 1)) {
  double largest = 0;
  for (const Vec2d& p : points) largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
  slack_ = 0x1p-50 * largest;
  nodes_.resize(2 * first_leaf_);
  build(1, 0, static_cast<std::uint32_t>(members_.size()));
  for (std::uint32_t i = 0; i < members_.size(); ++i) place_of_[members_[i]] = i;
}

const Vec2d& VertexTree::next_point(std::uint32_t vertex) const {
  return points_[vertex + 1 < points_.size() ? vertex + 1 : 0];
}

std::span<std::uint32_t> VertexTree::members(const Node& node) {
  return std::span(members_).subspan(node.first, node.last - node.first);
}

// Returns the direction in which most of the polygon's edges run at these vertices: the first principal axis
// of the edges, each as long as it is.
Vec2d VertexTree::axis_of(std::span<const std::uint32_t> members) const {
  double xx_yy = 0, xy = 0;
  for (const std::uint32_t i : members) {
    const Vec2d edge = next_point(i) - points_[i];
    xx_yy += edge.x * edge.x - edge.y * edge.y;
    xy += edge.x * edge.y;
  }
  const double angle = 0.5 * std::atan2(2 * xy, xx_yy);
  return {std::cos(angle), std::sin(angle)};
}

// Returns how many edges at these vertices cross the line that halves the sample across `axis`.
std::size_t VertexTree::edges_cut(std::span<const std::uint32_t> sample, const Vec2d& axis) const {
  std::array<double, kSample> places{};
  const auto end = std::transform(sample.begin(), sample.end(), places.begin(),
                                  [&](std::uint32_t i) { return points_[i].dot(axis); });
  const auto middle = places.begin() + (end - places.begin()) / 2;
  std::nth_element(places.begin(), middle, end);
  return static_cast<std::size_t>(std::count_if(sample.begin(), sample.end(), [&](std::uint32_t i) {
    return (points_[i].dot(axis) < *middle) != (next_point(i).dot(axis) < *middle);
  }));
}

void VertexTree::build(std::size_t k, std::uint32_t first, std::uint32_t last) {
  std::vector<std::uint32_t> sample;
  const std::uint32_t step = (last - first) / kSample + 1;
  for (std::uint32_t i = first; i < last; i += step) sample.push_back(members_[i]);
  Node& node = nodes_[k];
  node.axis = axis_of(sample);
  node.first = first, node.last = last, node.left = last - first;
  for (const std::uint32_t i : members(node)) node.box.extendBy(along(node.axis, points_[i]));
  node.box.min -= Vec2d(slack_), node.box.max += Vec2d(slack_);
  if (k >= first_leaf_) return;

  // Splits where fewer edges are cut; if they are as many, the longer side.
  const Vec2d across = quarter_turn(node.axis), size = node.box.size();
  const std::size_t cut_along = edges_cut(sample, node.axis), cut_across = edges_cut(sample, across);
  const bool lengthwise = cut_along != cut_across ? cut_along < cut_across : size.x >= size.y;
  const Vec2d split = lengthwise ? node.axis : across;
  const std::uint32_t middle = first + (last - first) / 2;
  std::nth_element(
      members_.begin() + first, members_.begin() + middle, members_.begin() + last,
      [&](std::uint32_t i, std::uint32_t j) { return points_[i].dot(split) < points_[j].dot(split); });
  build(2 * k, first, middle);
  build(2 * k + 1, middle, last);
}

void VertexTree::remove(std::uint32_t vertex) {
  const std::uint32_t place = place_of_[vertex];
  if (place == kNoPlace || removed_[place]) return;
  removed_[place] = true;
  for (std::size_t k = 1;;) {
    --nodes_[k].left;
    if (k >= first_leaf_) return;
    k = place < nodes_[2 * k].last ? 2 * k : 2 * k + 1;
  }
}

bool VertexTree::any_within(const Vec2d& a, const Vec2d& b, const Vec2d& c) const {
  const auto within = [&](const Vec2d& p) {
    if (p == a || p == b || p == c) return false;
    return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
  };
  std::array<std::size_t, 64> stack;  // a tree of 2^32 members is less deep
  std::size_t height = 0;
  stack[height++] = 1;
  while (height > 0) {
    const std::size_t k = stack[--height];
    const Node& node = nodes_[k];
    if (node.left == 0) continue;
    if (apart(node.box, along(node.axis, a), along(node.axis, b), along(node.axis, c))) continue;
    if (k < first_leaf_) {
      stack[height++] = 2 * k;
      stack[height++] = 2 * k + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.last; ++i) {
      if (!removed_[i] && within(points_[members_[i]])) return true;
    }
  }
  return false;
}

}  // namespace pprt
