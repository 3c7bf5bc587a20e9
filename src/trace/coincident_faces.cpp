#include "trace/coincident_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include "trace/geometry/numerics.h"

namespace pprt {
namespace {

// A triangle in double.
struct Corners {
  std::array<Vec3d, 3> at;
  Vec3d across;  // along the normal; as long as twice the area

  Corners(const Mesh& mesh, std::uint32_t triangle)
      : at{Vec3d(mesh.vertices[mesh.triangles[triangle][0]]),
           Vec3d(mesh.vertices[mesh.triangles[triangle][1]]),
           Vec3d(mesh.vertices[mesh.triangles[triangle][2]])},
        across((at[1] - at[0]).cross(at[2] - at[0])) {}

  double twice_area() const { return across.length(); }
  Vec3d normal() const { return across * (1 / twice_area()); }

  double longest_edge() const {
    return std::sqrt(
        std::max({(at[1] - at[0]).length2(), (at[2] - at[1]).length2(), (at[0] - at[2]).length2()}));
  }

  // Whether all points are beyond one side, or less than `margin` within it.
  template <std::size_t kCount>
  bool excludes(const std::array<Vec3d, kCount>& points, double margin) const {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d side = at[(i + 1) % 3] - at[i], inwards = across.cross(side);
      double farthest = inwards.dot(points[0] - at[i]);
      for (std::size_t k = 1; k < kCount; ++k) farthest = std::max(farthest, inwards.dot(points[k] - at[i]));
      if (farthest < 0 && margin >= 0) return true;  // the commonest case, without the root
      if (farthest < margin * std::sqrt(across.length2() * side.length2())) return true;
    }
    return false;
  }

  bool lies_in_plane_of(const Corners& other, double bound) const {
    const Vec3d normal = other.normal();
    return std::all_of(at.begin(), at.end(), [&](const Vec3d& corner) {
      return std::abs((corner - other.at[0]).dot(normal)) <= bound;
    });
  }
};

// A triangle's place, and the direction of its normal without its sign.
struct FaceBox {
  std::array<float, 6> low, high;

  bool meets(const FaceBox& other) const {
    int apart = 0;
    for (std::size_t i = 0; i < low.size(); ++i)  // without branches: any of the six may decide
      apart |= static_cast<int>(low[i] > other.high[i]) | static_cast<int>(other.low[i] > high[i]);
    return apart == 0;
  }
  void extend(const FaceBox& other) {
    for (std::size_t i = 0; i < low.size(); ++i) {
      low[i] = std::min(low[i], other.low[i]);
      high[i] = std::max(high[i], other.high[i]);
    }
  }
  float middle(std::size_t i) const { return low[i] + high[i]; }
};

struct Face {
  FaceBox box;
  std::uint32_t part = 0, triangle = 0;
  std::uint32_t primitive = 0;  // place in the order
  float offset = 0;             // its own
};
static_assert(sizeof(Face) == 64);

// Enlarges the box by half of what two triangles may be apart, in place and in direction, and still coincide.
FaceBox face_box(const Mesh& mesh, std::uint32_t triangle) {
  const Corners corners(mesh, triangle);
  const Vec3d normal = corners.normal();
  const auto offset = static_cast<double>(mesh.facets[triangle].offset);
  const double bound = coincidence_bound(offset, offset);
  const double tilt = std::min(1.0, 2 * bound * corners.longest_edge() / corners.twice_area());
  FaceBox box;
  for (std::size_t i = 0; i < 3; ++i) {
    const int axis = static_cast<int>(i);
    const auto [least, most] = std::minmax({corners.at[0][axis], corners.at[1][axis], corners.at[2][axis]});
    box.low[i] = static_cast<float>(least - bound);
    box.high[i] = static_cast<float>(most + bound);
    box.low[3 + i] = static_cast<float>(std::abs(normal[axis]) - tilt);
    box.high[3 + i] = static_cast<float>(std::abs(normal[axis]) + tilt);
  }
  return box;
}

// Finds pairs by a hierarchy of boxes that is held against itself. Where objects overlap without end there
// are too many pairs: all triangles then count as coincident, which costs rays time.
class PairFinder {
 public:
  explicit PairFinder(std::span<ScenePart> parts) : parts_(parts) {
    std::size_t count = 0;
    for (const ScenePart& part : parts) count += part.primitives.size();
    faces_.reserve(count);
    for (std::uint32_t part = 0; part < parts.size(); ++part) {
      const auto* mesh = std::get_if<Mesh>(&parts[part].shape);
      if (mesh == nullptr) continue;
      for (std::uint32_t i = 0; i < mesh->triangles.size(); ++i)
        faces_.push_back({face_box(*mesh, i), part, i, parts[part].primitives[i], mesh->facets[i].offset});
    }
  }

  void run() {
    if (faces_.size() < 2) return;
    nodes_.reserve(faces_.size());
    build(0, static_cast<std::uint32_t>(faces_.size()));
    pairs_left_ = kPairsPerFace * faces_.size();
    compare(0, 0);
    if (pairs_left_ > 0) return;
    for (const Face& face : faces_) mark(face, face);
  }

 private:
  static constexpr std::uint32_t kLeaf = 4;
  static constexpr std::size_t kPairsPerFace = 256;  // a mesh without coincident faces has about twelve

  // The first child follows its parent.
  struct Node {
    FaceBox box;
    std::uint32_t second = 0;          // child; 0: a leaf
    std::uint32_t first = 0, end = 0;  // a leaf's faces
  };

  // Parts the faces where the middles of some are farthest apart, halfway. Returns the first of the second
  // half. Many may have the same middle, as the faces of boxes have few directions.
  std::uint32_t divide(std::uint32_t first, std::uint32_t end) {
    const std::uint32_t step = std::max<std::uint32_t>(1, (end - first) / 32);
    std::array<float, 6> least, most;
    for (std::size_t axis = 0; axis < 6; ++axis) least[axis] = most[axis] = faces_[first].box.middle(axis);
    for (std::uint32_t i = first + step; i < end; i += step) {
      for (std::size_t axis = 0; axis < 6; ++axis) {
        const float middle = faces_[i].box.middle(axis);
        least[axis] = std::min(least[axis], middle);
        most[axis] = std::max(most[axis], middle);
      }
    }
    std::size_t axis = 0;
    for (std::size_t i = 1; i < 6; ++i) {
      if (most[i] - least[i] > most[axis] - least[axis]) axis = i;
    }
    const float halfway = (least[axis] + most[axis]) / 2;
    const auto begin = faces_.begin();
    const auto half = std::partition(begin + first, begin + end,
                                     [&](const Face& face) { return face.box.middle(axis) < halfway; });
    const auto found = static_cast<std::uint32_t>(half - begin);
    return found == first || found == end ? first + (end - first) / 2 : found;
  }

  std::uint32_t build(std::uint32_t first, std::uint32_t end) {
    const auto number = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    if (end - first <= kLeaf) {
      Node& leaf = nodes_[number];
      leaf.first = first, leaf.end = end;
      leaf.box = faces_[first].box;
      for (std::uint32_t i = first + 1; i < end; ++i) leaf.box.extend(faces_[i].box);
      return number;
    }
    const std::uint32_t half = divide(first, end);
    build(first, half);
    const std::uint32_t second = build(half, end);
    nodes_[number].second = second;
    nodes_[number].box = nodes_[number + 1].box;
    nodes_[number].box.extend(nodes_[second].box);
    return number;
  }

  void compare(std::uint32_t one, std::uint32_t other) {
    const Node &a = nodes_[one], &b = nodes_[other];
    if (pairs_left_ == 0 || !a.box.meets(b.box)) return;
    if (a.second == 0 && b.second == 0) return compare_faces(a, b);
    if (one == other) {
      compare(one + 1, one + 1);
      compare(a.second, a.second);
      compare(one + 1, a.second);
    } else if (a.second != 0) {
      compare(one + 1, other);
      compare(a.second, other);
    } else {
      compare(one, other + 1);
      compare(one, b.second);
    }
  }

  void compare_faces(const Node& a, const Node& b) {
    for (std::uint32_t i = a.first; i < a.end; ++i) {
      for (std::uint32_t k = &a == &b ? i + 1 : b.first; k < b.end; ++k) {
        if (!coincide(faces_[i], faces_[k])) continue;
        mark(faces_[i], faces_[k]);
        mark(faces_[k], faces_[i]);
      }
    }
  }

  bool coincide(const Face& a, const Face& b) {
    if (a.primitive == b.primitive || !a.box.meets(b.box)) return false;
    if (pairs_left_ == 0) return false;
    --pairs_left_;
    const Corners here(std::get<Mesh>(parts_[a.part].shape), a.triangle);
    const Corners there(std::get<Mesh>(parts_[b.part].shape), b.triangle);
    // Neighbours share a side, or parts of it, within the rounding of their corners.
    constexpr double kMargin = 4 * kOriginRounding;
    if (here.excludes(there.at, kMargin) || there.excludes(here.at, kMargin)) return false;
    const double bound = coincidence_bound(static_cast<double>(a.offset), static_cast<double>(b.offset));
    return here.lies_in_plane_of(there, bound) || there.lies_in_plane_of(here, bound);
  }

  void mark(const Face& face, const Face& other) const {
    ScenePart& part = parts_[face.part];
    auto& mesh = std::get<Mesh>(part.shape);
    if (part.coincides.empty()) part.coincides.resize(mesh.triangles.size());
    part.coincides[face.triangle] = true;
    float& offset = mesh.facets[face.triangle].offset;
    offset = std::max(offset, static_cast<float>(coincidence_bound(static_cast<double>(face.offset),
                                                                   static_cast<double>(other.offset))));
  }

  std::span<ScenePart> parts_;
  std::vector<Face> faces_;
  std::vector<Node> nodes_;
  std::size_t pairs_left_ = 0;
};

// What a ray may see at a point where faces coincide.
struct SeenFace {
  unsigned part = 0, triangle = 0;
  std::tuple<bool, std::uint32_t> rank;  // the least is seen
  double ahead = 0;                      // how much nearer than the hit it is, along the normal
  double rounding = 0;                   // of its vertices
};

class FacesAtPoint {
 public:
  FacesAtPoint(const CompiledScene::Impl& scene, const Vec3d& point, const Vec3d& direction, double bound)
      : scene_(scene), point_(point), direction_(direction), bound_(bound) {}

  void add(unsigned part_number, unsigned triangle) {
    const ScenePart& part = scene_.parts[part_number];
    if (part.coincides.empty() || !part.coincides[triangle]) return;
    const Corners corners(std::get<Mesh>(part.shape), triangle);
    const Vec3d normal = corners.normal();
    const double cosine = normal.dot(direction_);
    if ((part.faces == VisibleFaces::kFront && cosine >= 0) ||
        (part.faces == VisibleFaces::kBack && cosine <= 0))
      return;
    const double height = (point_ - corners.at[0]).dot(normal);
    if (std::abs(height) > bound_) return;
    if (corners.excludes(std::array{point_ - normal * height}, -2 * kOriginRounding)) return;
    const auto reach = [](const Vec3d& corner) { return origin_rounding(sum_of_coordinates(corner)); };
    const bool is_glass = scene_.materials[part.materials[triangle]].transmittance > 0;
    faces_.push_back({part_number,
                      triangle,
                      {is_glass, part.primitives[triangle]},
                      cosine < 0 ? -height : height,
                      std::max({reach(corners.at[0]), reach(corners.at[1]), reach(corners.at[2])})});
  }

  // Faces within the rounding of the nearest are as near as that.
  const SeenFace* seen() const {
    const auto nearest = std::max_element(
        faces_.begin(), faces_.end(), [](const SeenFace& a, const SeenFace& b) { return a.ahead < b.ahead; });
    const SeenFace* best = nullptr;
    for (const SeenFace& face : faces_) {
      if (face.ahead + face.rounding + nearest->rounding < nearest->ahead) continue;
      if (best == nullptr || face.rank < best->rank) best = &face;
    }
    return best;
  }

 private:
  const CompiledScene::Impl& scene_;
  Vec3d point_, direction_;
  double bound_;
  std::vector<SeenFace> faces_;
};

}  // namespace

std::size_t mark_coincident_faces(std::span<ScenePart> parts) {
  PairFinder(parts).run();
  std::size_t count = 0;
  for (const ScenePart& part : parts)
    count += static_cast<std::size_t>(std::count(part.coincides.begin(), part.coincides.end(), true));
  return count;
}

void choose_coincident_face(const CompiledScene::Impl& scene, std::uint32_t body, const Vec3d& origin,
                            const Vec3d& direction, RTCHit& hit) {
  const auto& mesh = std::get<Mesh>(scene.parts[hit.geomID].shape);
  const Vec3d point = on_surface(mesh, hit.primID, origin, direction).position;
  const float bound = mesh.facets[hit.primID].offset;
  FacesAtPoint faces(scene, point, direction, static_cast<double>(bound));
  visit_primitives_near(scene.bodies[body].embree.get(), Vec3f(point), bound,
                        [&](unsigned part, unsigned triangle) { faces.add(part, triangle); });
  if (const SeenFace* seen = faces.seen()) hit.geomID = seen->part, hit.primID = seen->triangle;
}

}  // namespace pprt
