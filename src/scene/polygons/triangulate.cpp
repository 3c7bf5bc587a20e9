#include "scene/polygons/triangulate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "scene/polygons/ear_ranking.h"
#include "scene/polygons/turn.h"
#include "scene/polygons/vertex_tree.h"

namespace pprt {
namespace {

// Polygons of up to so many vertices are searched vertex by vertex.
constexpr std::size_t kMostSearched = 512;

// Drops the coordinate in which the normal is largest and makes the polygon run counter-clockwise.
std::vector<Vec2d> project(std::span<const Vec3d> polygon, const Vec3d& normal) {
  const Vec3d size(std::abs(normal.x), std::abs(normal.y), std::abs(normal.z));
  const int drop = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int first = (drop + 1) % 3;
  const int second = (drop + 2) % 3;
  const double sign = normal[drop] < 0 ? -1 : 1;
  std::vector<Vec2d> flat;
  flat.reserve(polygon.size());
  for (const Vec3d& p : polygon) {
    const Vec3d q = p - polygon[0];
    flat.emplace_back(sign * q[first], q[second]);
  }
  return flat;
}

// The ring of vertices not yet clipped, with the quality of each as the tip of an ear.
//
// In a simple polygon a blocked ear stays blocked until a neighbour of its tip is clipped. For the vertex in
// it that is farthest from its base cannot be clipped before. So each clipping judges two ears anew. All are
// judged again only for polygons that intersect themselves, or touch themselves within rounding.
class EarClipper {
 public:
  explicit EarClipper(std::vector<Vec2d> points)
      : points_(std::move(points)), quality_(points_.size(), kNoEar), left_(points_.size()) {
    const std::size_t n = points_.size();
    for (std::size_t i = 0; i < n; ++i) {
      next_.push_back(static_cast<std::uint32_t>((i + 1) % n));
      previous_.push_back(static_cast<std::uint32_t>((i + n - 1) % n));
    }
    if (n > kMostSearched) plant_tree();
  }

  std::vector<TriangleIndices> run() {
    judge_all();
    while (left_ >= 3) {
      std::uint32_t tip = quality_.best(start_);
      if (quality_[tip] == kNoEar && may_judge_again()) {
        judge_all();  // a vertex that blocked an ear may be gone
        tip = quality_.best(start_);
      }
      clip(tip);
    }
    return std::move(triangles_);
  }

 private:
  static constexpr double kNoEar = -1;
  static constexpr double kClipped = -2;

  double turn_at(std::uint32_t tip) const {
    return turn(points_[previous_[tip]], points_[tip], points_[next_[tip]]);
  }

  // Only a vertex at which the polygon does not turn left can block an ear. Clipping ears only makes angles
  // smaller, so such a vertex may leave the tree and none enters it.
  void plant_tree() {
    std::vector<std::uint32_t> members;
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      if (!(turn_at(i) > 0)) members.push_back(i);
    }
    tree_.emplace(points_, std::move(members));
  }

  // Judging all ears takes long in a large ring, so that a sixteenth of it must be clipped in between.
  bool may_judge_again() const {
    return left_ < left_when_judged_ && (left_ <= kMostSearched || left_ <= left_when_judged_ / 16 * 15);
  }

  void judge_all() {
    left_when_judged_ = left_;
    std::uint32_t i = start_;
    do {
      judge(i);
      i = next_[i];
    } while (i != start_);
  }

  // Clips a vertex. When no ear is left the polygon intersects itself, and any vertex will do.
  void clip(std::uint32_t tip) {
    const std::uint32_t before = previous_[tip];
    const std::uint32_t after = next_[tip];
    if (turn_at(tip) > 0) triangles_.push_back({before, tip, after});
    next_[before] = after;
    previous_[after] = before;
    start_ = after;
    --left_;
    quality_.set(tip, kClipped);
    if (tree_) tree_->remove(tip);
    if (left_ >= 3) {
      judge(before);
      judge(after);
    }
  }

  // Sets a vertex's quality: the ear's area over its longest edge squared, in (0, 1], so that slivers come
  // last. A vertex without area (a duplicate, or on a straight line) comes first, as clipping it costs
  // nothing.
  void judge(std::uint32_t tip) {
    const Vec2d& a = points_[previous_[tip]];
    const Vec2d& b = points_[tip];
    const Vec2d& c = points_[next_[tip]];
    const double area = turn(a, b, c);
    if (area > 0 && tree_) tree_->remove(tip);
    quality_.set(tip, quality(tip, a, b, c, area));
  }

  double quality(std::uint32_t tip, const Vec2d& a, const Vec2d& b, const Vec2d& c, double area) const {
    if (!(area >= 0)) return kNoEar;
    if (area == 0) return 2;
    if (tree_ ? tree_->any_within(a, b, c) : blocked(tip, a, b, c)) return kNoEar;
    const double longest = std::max({(b - a).length2(), (c - b).length2(), (a - c).length2()});
    const double shape = area / longest;
    return shape >= 0 ? shape : kNoEar;  // not where lengths overflow
  }

  // Returns whether another vertex lies in the closed triangle. One that coincides with a corner does not
  // count.
  bool blocked(std::uint32_t tip, const Vec2d& a, const Vec2d& b, const Vec2d& c) const {
    const std::uint32_t before = previous_[tip];
    for (std::uint32_t i = next_[next_[tip]]; i != before; i = next_[i]) {
      const Vec2d& p = points_[i];
      if (p == a || p == b || p == c) continue;
      if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return true;
    }
    return false;
  }

  std::vector<Vec2d> points_;
  std::vector<std::uint32_t> next_;
  std::vector<std::uint32_t> previous_;
  EarRanking quality_;
  std::optional<VertexTree> tree_;  // of large polygons: what may block an ear
  std::vector<TriangleIndices> triangles_;
  std::uint32_t start_ = 0;
  std::size_t left_;
  std::size_t left_when_judged_ = 0;
};

}  // namespace

Vec3d newell_normal(std::span<const Vec3d> polygon) {
  Vec3d normal(0, 0, 0);
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    normal += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
  }
  return normal;
}

std::vector<TriangleIndices> triangulate(std::span<const Vec3d> polygon) {
  if (polygon.size() < 3) return {};
  const Vec3d normal = newell_normal(polygon);
  if (!(normal.dot(normal) > 0)) return {};
  if (polygon.size() == 3) return {{0, 1, 2}};
  return EarClipper(project(polygon, normal)).run();
}

}  // namespace pprt
