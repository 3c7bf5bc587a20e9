#include "convert/gltf/gltf_holes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace pprt {
namespace {

using Corners = std::array<std::uint32_t, 3>;

constexpr double kLeast = 0.5;                   // texels, of a triangle that is cut and not divided
constexpr int kDeepest = 9;                      // halvings of a triangle
constexpr std::size_t kMostCorners = 6'000'000;  // of a mesh that is cut

struct AlphaRange {
  double least = 1, most = 0;
};

int wrapped(std::int64_t place, int size) {
  return static_cast<int>(((place % size) + size) % size);
}

class HoleCutter {
 public:
  HoleCutter(ModelMesh& mesh, const AlphaPicture& picture, double cutoff)
      : mesh_(mesh), picture_(picture), cutoff_(cutoff) {}

  bool run() {
    const std::vector<std::uint32_t> whole = std::exchange(mesh_.corners, {});
    for (std::size_t i = 0; i + 2 < whole.size(); i += 3) divide({whole[i], whole[i + 1], whole[i + 2]}, 0);
    mesh_.ends.clear();
    for (std::size_t end = 3; end <= mesh_.corners.size(); end += 3) mesh_.ends.push_back(end);
    return !is_coarse_;
  }

 private:
  const Vec2d& place(std::uint32_t corner) const { return mesh_.texture_points[corner]; }

  // Returns texels that lie in the box of a triangle, or beside it.
  std::pair<Vec2d, Vec2d> texels(const Corners& t) const {
    const Vec2d size(picture_.width, picture_.height);
    Vec2d low = place(t[0]) * size, high = low;
    for (const std::uint32_t corner : t) {
      for (int i = 0; i < 2; ++i) {
        low[i] = std::min(low[i], place(corner)[i] * size[i]);
        high[i] = std::max(high[i], place(corner)[i] * size[i]);
      }
    }
    return {low - Vec2d(0.5, 0.5), high - Vec2d(0.5, 0.5)};
  }

  AlphaRange range(const Vec2d& low, const Vec2d& high) const {
    AlphaRange result;
    const auto last = [](double from, double to, int size) {
      return static_cast<std::int64_t>(std::floor(std::min(to, from + size))) + 1;
    };
    for (auto y = static_cast<std::int64_t>(std::floor(low.y)); y <= last(low.y, high.y, picture_.height);
         ++y) {
      for (auto x = static_cast<std::int64_t>(std::floor(low.x)); x <= last(low.x, high.x, picture_.width);
           ++x) {
        const auto row = static_cast<std::size_t>(wrapped(y, picture_.height));
        const auto column = static_cast<std::size_t>(wrapped(x, picture_.width));
        const auto v =
            static_cast<double>(picture_.alpha[row * static_cast<std::size_t>(picture_.width) + column]);
        result = {std::min(result.least, v), std::max(result.most, v)};
      }
    }
    return result;
  }

  void divide(const Corners& t, int depth) {
    const auto [low, high] = texels(t);
    const AlphaRange alpha = range(low, high);
    if (alpha.least >= cutoff_) return add(t);
    if (alpha.most < cutoff_) return;
    const Vec2d size = high - low;
    if (std::max(size.x, size.y) <= kLeast) return cut(t);
    if (depth == kDeepest || mesh_.corners.size() > kMostCorners) {
      is_coarse_ = true;
      return cut(t);
    }
    const std::uint32_t a = between(t[0], t[1], 0.5), b = between(t[1], t[2], 0.5),
                        c = between(t[2], t[0], 0.5);
    for (const Corners& part :
         {Corners{t[0], a, c}, Corners{a, t[1], b}, Corners{c, b, t[2]}, Corners{a, b, c}})
      divide(part, depth + 1);
  }

  void add(const Corners& t) { mesh_.corners.insert(mesh_.corners.end(), t.begin(), t.end()); }

  // Keeps the part of a triangle where a straight course between its corners' alpha reaches the cutoff.
  // Between corners of one kind the middle decides: corners between four texels of a checkerboard tell
  // nothing.
  void cut(const Corners& t) {
    const auto is_there = [&](const Vec2d& point) { return picture_.at(point) >= cutoff_; };
    const Vec2d middle = (place(t[0]) + place(t[1]) + place(t[2])) / 3.0;
    const auto corners =
        std::count_if(t.begin(), t.end(), [&](std::uint32_t c) { return is_there(place(c)); });
    if (corners % 3 == 0) return is_there(middle) ? add(t) : void();
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = t[i], to = t[(i + 1) % 3];
      const double a = picture_.at(place(from)) - cutoff_, b = picture_.at(place(to)) - cutoff_;
      if (a >= 0) kept.push_back(from);
      if ((a > 0 && b < 0) || (a < 0 && b > 0)) kept.push_back(between(from, to, a / (a - b)));
    }
    for (std::size_t i = 2; i < kept.size(); ++i) add({kept[0], kept[i - 1], kept[i]});
  }

  std::uint32_t between(std::uint32_t from, std::uint32_t to, double share) {
    const auto mix = [&](auto& list) {
      const auto a = list[from], b = list[to];  // copies: the list grows
      list.push_back(a + (b - a) * share);
    };
    mix(mesh_.positions);
    if (!mesh_.normals.empty()) mix(mesh_.normals);
    mix(mesh_.texture_points);
    return static_cast<std::uint32_t>(mesh_.positions.size() - 1);
  }

  ModelMesh& mesh_;
  const AlphaPicture& picture_;
  double cutoff_;
  bool is_coarse_ = false;
};

}  // namespace

double AlphaPicture::at(const Vec2d& point) const {
  if (alpha.empty()) return 1;
  const double x = point.x * width - 0.5, y = point.y * height - 0.5;
  const double column = std::floor(x), row = std::floor(y);
  const auto texel = [&](double right, double down) {
    const auto i = static_cast<std::size_t>(wrapped(static_cast<std::int64_t>(row + down), height));
    const auto k = static_cast<std::size_t>(wrapped(static_cast<std::int64_t>(column + right), width));
    return static_cast<double>(alpha[i * static_cast<std::size_t>(width) + k]);
  };
  const double u = x - column, v = y - row;
  return (texel(0, 0) * (1 - u) + texel(1, 0) * u) * (1 - v) + (texel(0, 1) * (1 - u) + texel(1, 1) * u) * v;
}

double AlphaPicture::mean() const {
  if (alpha.empty()) return 1;
  return std::accumulate(alpha.begin(), alpha.end(), 0.0) / static_cast<double>(alpha.size());
}

bool cut_holes(ModelMesh& mesh, const AlphaPicture& picture, double cutoff) {
  if (picture.alpha.empty()) return true;
  for (const std::uint32_t corner : mesh.corners) {
    if (corner >= mesh.positions.size()) return true;  // is told when the mesh is added
    for (int i = 0; i < 2; ++i) {
      if (std::abs(mesh.texture_points[corner][i]) > 1e6) return false;
    }
  }
  return HoleCutter(mesh, picture, cutoff).run();
}

}  // namespace pprt
