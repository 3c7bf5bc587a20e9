#include "convert/gltf/gltf_colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "convert/model/display_values.h"

namespace pprt {
namespace {

// A triangle takes a block of texels: its corners are the middles of the upper left texel, the upper right
// and the lower left one. Texels beyond the diagonal continue the course, for those before it to be exact.
constexpr std::size_t kSide = 4;
constexpr std::size_t kMostTriangles = 2'000'000;

using Shown = std::array<double, 3>;  // display values

std::uint8_t byte_of(double display) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(display, 0.0, 1.0)));
}

Shown shown(const GltfNumbers& colors, std::uint32_t corner) {
  return {display_value(colors.at(corner, 0)), display_value(colors.at(corner, 1)),
          display_value(colors.at(corner, 2))};
}

void fill_block(Texture& texture, std::size_t left, std::size_t top, const std::array<Shown, 3>& corners) {
  constexpr double kSpan = kSide - 1;
  for (std::size_t y = 0; y < kSide; ++y) {
    for (std::size_t x = 0; x < kSide; ++x) {
      const double u = static_cast<double>(x) / kSpan, v = static_cast<double>(y) / kSpan;
      const std::size_t texel = (top + y) * static_cast<std::size_t>(texture.width) + left + x;
      for (std::size_t c = 0; c < 3; ++c)
        texture.rgb[3 * texel + c] = byte_of(corners[0][c] + u * (corners[1][c] - corners[0][c]) +
                                             v * (corners[2][c] - corners[0][c]));
    }
  }
}

}  // namespace

std::optional<Texture> paint(ModelMesh& mesh, const GltfNumbers& colors) {
  const std::size_t triangles = mesh.corners.size() / 3,
                    vertices = std::min(colors.size(), mesh.positions.size());
  const bool is_whole =
      std::all_of(mesh.corners.begin(), mesh.corners.end(), [&](std::uint32_t c) { return c < vertices; });
  if (!is_whole || triangles == 0 || triangles > kMostTriangles) return std::nullopt;
  const auto across = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(triangles))));
  Texture texture;
  texture.name = "colours";
  texture.width = static_cast<int>(across * kSide);
  texture.height = static_cast<int>((triangles + across - 1) / across * kSide);
  texture.rgb.resize(3 * static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height));

  ModelMesh own;
  own.ends = mesh.ends;
  const Vec2d size(texture.width, texture.height);
  for (std::size_t i = 0; i < triangles; ++i) {
    const std::size_t left = i % across * kSide, top = i / across * kSide;
    std::array<Shown, 3> at{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t corner = mesh.corners[3 * i + k];
      at[k] = shown(colors, corner);
      own.positions.push_back(mesh.positions[corner]);
      if (!mesh.normals.empty()) own.normals.push_back(mesh.normals[corner]);
      const Vec2d texel(static_cast<double>(left + (k == 1 ? kSide - 1 : 0)),
                        static_cast<double>(top + (k == 2 ? kSide - 1 : 0)));
      own.texture_points.push_back((texel + Vec2d(0.5, 0.5)) / size);
      own.corners.push_back(static_cast<std::uint32_t>(3 * i + k));
    }
    fill_block(texture, left, top, at);
  }
  mesh = std::move(own);
  return texture;
}

}  // namespace pprt
