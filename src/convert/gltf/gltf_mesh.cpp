#include "convert/gltf/gltf_mesh.h"

#include <array>
#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "convert/model/closed_mesh.h"
#include "convert/model/display_values.h"
#include "convert/model/vertex_colours.h"

namespace pprt {
namespace {

std::vector<Vec3d> vectors(const GltfNumbers& from) {
  if (from.components != 3) throw std::runtime_error("a mesh has positions or normals that are no vectors");
  std::vector<Vec3d> result;
  result.reserve(from.size());
  for (std::size_t i = 0; i < from.size(); ++i)
    result.emplace_back(from.at(i, 0), from.at(i, 1), from.at(i, 2));
  return result;
}

int attribute(const tinygltf::Primitive& from, const std::string& name) {
  const auto found = from.attributes.find(name);
  return found == from.attributes.end() ? -1 : found->second;
}

// Returns the corners of triangles, three each; none for points and lines.
std::vector<std::uint32_t> triangle_corners(const tinygltf::Model& model, const tinygltf::Primitive& from,
                                            std::size_t vertices) {
  std::vector<std::uint32_t> order;
  if (from.indices >= 0) {
    for (const double index : numbers(model, from.indices).values) {
      if (!(index >= 0 && index < 4294967295.0))
        throw std::runtime_error("a face names a vertex that is not there");
      order.push_back(static_cast<std::uint32_t>(index));
    }
  } else {
    order.resize(vertices);
    std::iota(order.begin(), order.end(), 0U);
  }
  const bool is_strip = from.mode == TINYGLTF_MODE_TRIANGLE_STRIP,
             is_fan = from.mode == TINYGLTF_MODE_TRIANGLE_FAN;
  if (from.mode < 0 || from.mode == TINYGLTF_MODE_TRIANGLES) {
    order.resize(order.size() - order.size() % 3);
    return order;
  }
  std::vector<std::uint32_t> corners;
  if (!is_strip && !is_fan) return corners;
  for (std::size_t i = 2; i < order.size(); ++i) {
    const std::uint32_t first = is_fan ? order[0] : order[i - 2 + i % 2];
    const std::uint32_t second = is_fan ? order[i - 1] : order[i - 1 - i % 2];
    corners.insert(corners.end(), {first, second, order[i]});
  }
  return corners;
}

std::vector<Rgb> display_colors(const GltfNumbers& colors) {
  std::vector<Rgb> result;
  for (std::size_t i = 0; i < colors.size(); ++i)
    result.emplace_back(display_value(colors.at(i, 0)), display_value(colors.at(i, 1)),
                        display_value(colors.at(i, 2)));
  return result;
}

// Returns the mean of the colours at the corners, which are linear.
std::array<double, 3> mean_color(const GltfNumbers& colors, const std::vector<std::uint32_t>& corners) {
  std::array<double, 3> sum{};
  for (const std::uint32_t corner : corners) {
    if (corner >= colors.size()) throw std::runtime_error("a face names a vertex that is not there");
    for (std::size_t c = 0; c < 3; ++c) sum[c] += colors.at(corner, c);
  }
  for (double& v : sum) v /= static_cast<double>(corners.size());
  return sum;
}

}  // namespace

void add_gltf_primitive(const tinygltf::Model& model, const tinygltf::Primitive& from,
                        GltfMaterials& materials, ModelLosses& losses, ModelBuilder& builder,
                        const ModelSpace& space) {
  const int positions = attribute(from, "POSITION");
  if (positions < 0) return;
  ModelMesh mesh;
  mesh.positions = vectors(numbers(model, positions));
  mesh.corners = triangle_corners(model, from, mesh.positions.size());
  if (mesh.corners.empty()) return builder.skip();
  for (std::size_t end = 3; end <= mesh.corners.size(); end += 3) mesh.ends.push_back(end);
  if (const int normals = attribute(from, "NORMAL"); normals >= 0) {
    mesh.normals = vectors(numbers(model, normals));
    mesh.normals.resize(mesh.positions.size(), Vec3d(0, 0, 0));
  }
  const GltfSurface& surface = materials.surface(from.material);
  if (surface.is_hidden) return;
  Material material = surface.material;
  const GltfPicture& picture = surface.picture;
  const int places = attribute(from, "TEXCOORD_" + std::to_string(picture.coordinates));
  if (picture.texture >= 0 && places >= 0) {
    const GltfNumbers points = numbers(model, places);
    if (points.components != 2) throw std::runtime_error("a mesh has texture coordinates that are none");
    for (std::size_t i = 0; i < points.size(); ++i)
      mesh.texture_points.emplace_back(points.at(i, 0), points.at(i, 1));
    mesh.texture_points.resize(mesh.positions.size(), Vec2d(0, 0));
    materials.put_on(surface, material, mesh);
    materials.cut(surface, material, mesh);
    if (mesh.corners.empty()) return;  // all of it is a hole
  }
  if (const int color = attribute(from, "COLOR_0"); color >= 0) {
    const GltfNumbers colors = numbers(model, color);
    if (colors.components < 3) throw std::runtime_error("a mesh has colours that are none");
    std::optional<Texture> painted;
    if (!material.has_picture()) painted = paint(mesh, display_colors(colors));
    if (painted) {
      material.texture = materials.add(std::move(*painted));
    } else {
      const Material mean = GltfMaterials::recoloured(surface, mean_color(colors, mesh.corners));
      material.color = mean.color, material.terms = mean.terms;
      losses.add(ModelLoss::kVertexColours);
    }
  }
  builder.add(mesh, material, space);
}

bool is_open_behind(const tinygltf::Model& model, const tinygltf::Mesh& from, GltfMaterials& materials) {
  ModelMesh whole;
  std::map<int, std::uint32_t> first_of;  // by accessor: parts may share their positions
  bool is_one_sided = false;
  for (const tinygltf::Primitive& part : from.primitives) {
    const int place = attribute(part, "POSITION");
    if (place < 0 || materials.surface(part.material).is_hidden) continue;
    const auto [known, is_new] = first_of.emplace(place, static_cast<std::uint32_t>(whole.positions.size()));
    if (is_new) {
      const std::vector<Vec3d> positions = vectors(numbers(model, place));
      whole.positions.insert(whole.positions.end(), positions.begin(), positions.end());
    }
    const std::size_t count = model.accessors[static_cast<std::size_t>(place)].count;
    for (const std::uint32_t corner : triangle_corners(model, part, count)) {
      whole.corners.push_back(known->second + corner);
      if (whole.corners.size() % 3 == 0) whole.ends.push_back(whole.corners.size());
    }
    is_one_sided = is_one_sided || !materials.surface(part.material).is_double_sided;
  }
  return is_one_sided && !is_closed(whole);
}

}  // namespace pprt
