// A tree over some vertices of a polygon: does any of them lie in a triangle?
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vector.h"

namespace pprt {

// A k-d tree whose axes turn from node to node, so that its boxes fit thin spikes of any direction. A query
// for a triangle between two neighbouring spikes then meets few boxes.
class VertexTree {
 public:
  // Holds the `members`, which are indices of the polygon's points. The points must outlive the tree.
  VertexTree(std::span<const Vec2d> points, std::vector<std::uint32_t> members);

  // Removes a vertex, if the tree holds it.
  void remove(std::uint32_t vertex);

  // Returns whether any vertex of the tree lies in the closed triangle, which runs counter-clockwise. One
  // that coincides with a corner does not count.
  bool any_within(const Vec2d& a, const Vec2d& b, const Vec2d& c) const;

 private:
  struct Node {
    Vec2d axis{1, 0};                   // unit; the other axis is a quarter turn to the left
    Imath::Box2d box;                   // of all members that it ever held, along its axes
    std::uint32_t first = 0, last = 0;  // in members_
    std::uint32_t left = 0;             // members that are not yet removed
  };

  void build(std::size_t node, std::uint32_t first, std::uint32_t last);
  std::span<std::uint32_t> members(const Node& node);
  Vec2d axis_of(std::span<const std::uint32_t> members) const;
  std::size_t edges_cut(std::span<const std::uint32_t> sample, const Vec2d& axis) const;
  const Vec2d& next_point(std::uint32_t vertex) const;

  std::span<const Vec2d> points_;
  std::vector<std::uint32_t> members_;   // by node
  std::vector<bool> removed_;            // by place in members_
  std::vector<std::uint32_t> place_of_;  // in members_, by vertex
  std::vector<Node> nodes_;              // the children of node k are 2k and 2k + 1; the root is 1
  std::size_t first_leaf_ = 1;
  double slack_ = 0;  // more than the rounding of a coordinate along an axis
};

}  // namespace pprt
