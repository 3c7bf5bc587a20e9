#include "scene/triangulate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pprt {
namespace {

// Returns twice the signed area; positive when a, b, c run counter-clockwise.
double cross(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

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
class EarClipper {
 public:
  explicit EarClipper(std::vector<Vec2d> points) : points_(std::move(points)) {
    const std::size_t n = points_.size();
    for (std::size_t i = 0; i < n; ++i) {
      next_.push_back(static_cast<std::uint32_t>((i + 1) % n));
      previous_.push_back(static_cast<std::uint32_t>((i + n - 1) % n));
    }
    left_ = n;
    quality_.assign(n, kNoEar);
  }

  std::vector<TriangleIndices> run() {
    judge_all();
    while (left_ >= 3) {
      std::uint32_t tip = best();
      if (quality_[tip] == kNoEar) {
        judge_all();  // a vertex that blocked an ear may be gone
        tip = best();
      }
      clip(tip);
    }
    return std::move(triangles_);
  }

 private:
  static constexpr double kNoEar = -1;

  std::uint32_t best() const {
    std::uint32_t best = start_;
    for (std::uint32_t i = next_[start_]; i != start_; i = next_[i]) {
      if (quality_[i] > quality_[best]) best = i;
    }
    return best;
  }

  void judge_all() {
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
    if (cross(points_[before], points_[tip], points_[after]) > 0) triangles_.push_back({before, tip, after});
    next_[before] = after;
    previous_[after] = before;
    start_ = after;
    --left_;
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
    const double area = cross(a, b, c);
    quality_[tip] = kNoEar;
    if (area < 0) return;
    if (area == 0) {
      quality_[tip] = 2;
      return;
    }
    if (blocked(tip, a, b, c)) return;
    const double longest = std::max({(b - a).length2(), (c - b).length2(), (a - c).length2()});
    quality_[tip] = area / longest;
  }

  // Returns whether another vertex lies in the closed triangle. One that coincides with a corner does not
  // count.
  bool blocked(std::uint32_t tip, const Vec2d& a, const Vec2d& b, const Vec2d& c) const {
    const std::uint32_t before = previous_[tip];
    for (std::uint32_t i = next_[next_[tip]]; i != before; i = next_[i]) {
      const Vec2d& p = points_[i];
      if (p == a || p == b || p == c) continue;
      if (cross(a, b, p) >= 0 && cross(b, c, p) >= 0 && cross(c, a, p) >= 0) return true;
    }
    return false;
  }

  std::vector<Vec2d> points_;
  std::vector<std::uint32_t> next_;
  std::vector<std::uint32_t> previous_;
  std::vector<double> quality_;
  std::vector<TriangleIndices> triangles_;
  std::uint32_t start_ = 0;
  std::size_t left_ = 0;
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
