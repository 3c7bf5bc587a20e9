#include "convert/model/vertex_colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "scene/polygons/triangulate.h"

namespace pprt {
namespace {

// A triangle takes a block of texels: its corners are the middles of the upper left texel, the upper right
// and the lower left one. Texels beyond the diagonal continue the course, for those before it to be exact.
constexpr std::size_t kSide = 4;
constexpr std::size_t kMostTriangles = 2'000'000;

std::uint8_t byte_of(double display) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(display, 0.0, 1.0)));
}

// Returns the corners of the faces' triangles. A face without extent leaves one triangle without extent.
std::vector<std::uint32_t> triangle_corners(const ModelMesh& mesh) {
  std::vector<std::uint32_t> corners;
  std::vector<Vec3d> face;
  std::size_t begin = 0;
  for (const std::size_t end : mesh.ends) {
    face.clear();
    for (std::size_t k = begin; k < end; ++k) face.push_back(mesh.positions[mesh.corners[k]]);
    std::vector<TriangleIndices> cut;
    if (face.size() > 3) cut = triangulate(face);
    const auto last = static_cast<std::uint32_t>(face.size()) - 1;
    if (cut.empty() && !face.empty()) cut.push_back({0, std::min(1U, last), last});
    for (const TriangleIndices& triangle : cut)
      for (const std::uint32_t k : triangle) corners.push_back(mesh.corners[begin + k]);
    begin = end;
  }
  return corners;
}

void fill_block(Texture& texture, std::size_t left, std::size_t top, const std::array<Rgb, 3>& corners) {
  constexpr double kSpan = kSide - 1;
  for (std::size_t y = 0; y < kSide; ++y) {
    for (std::size_t x = 0; x < kSide; ++x) {
      const double u = static_cast<double>(x) / kSpan, v = static_cast<double>(y) / kSpan;
      const std::size_t texel = (top + y) * static_cast<std::size_t>(texture.width) + left + x;
      const Rgb color = corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
      for (int c = 0; c < 3; ++c) texture.rgb[3 * texel + static_cast<std::size_t>(c)] = byte_of(color[c]);
    }
  }
}

}  // namespace

std::optional<Texture> paint(ModelMesh& mesh, const std::vector<Rgb>& colors) {
  const std::size_t vertices = std::min(colors.size(), mesh.positions.size());
  const bool is_whole =
      std::all_of(mesh.corners.begin(), mesh.corners.end(), [&](std::uint32_t c) { return c < vertices; });
  if (!is_whole) return std::nullopt;
  const std::vector<std::uint32_t> corners = triangle_corners(mesh);
  const std::size_t triangles = corners.size() / 3;
  if (triangles == 0 || triangles > kMostTriangles) return std::nullopt;
  const auto across = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(triangles))));
  Texture texture;
  texture.name = "colours";
  texture.width = static_cast<int>(across * kSide);
  texture.height = static_cast<int>((triangles + across - 1) / across * kSide);
  texture.rgb.resize(3 * static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height));

  ModelMesh own;
  const Vec2d size(texture.width, texture.height);
  for (std::size_t i = 0; i < triangles; ++i) {
    const std::size_t left = i % across * kSide, top = i / across * kSide;
    std::array<Rgb, 3> at;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t corner = corners[3 * i + k];
      at[k] = colors[corner];
      own.positions.push_back(mesh.positions[corner]);
      if (!mesh.normals.empty()) own.normals.push_back(mesh.normals[corner]);
      const Vec2d texel(static_cast<double>(left + (k == 1 ? kSide - 1 : 0)),
                        static_cast<double>(top + (k == 2 ? kSide - 1 : 0)));
      own.texture_points.push_back((texel + Vec2d(0.5, 0.5)) / size);
      own.corners.push_back(static_cast<std::uint32_t>(3 * i + k));
    }
    own.ends.push_back(own.corners.size());
    fill_block(texture, left, top, at);
  }
  mesh = std::move(own);
  return texture;
}

}  // namespace pprt
