#include "scene/nff_writer.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

namespace pprt {
namespace {

// Writes entities and vertices, one per line.
class NffOutput : public TextOutput {
 public:
  using TextOutput::TextOutput;

  // Writes one line: the keyword, then each value after a blank.
  template <typename... Values>
  void line(std::string_view keyword, const Values&... values) {
    text(keyword);
    (value(values), ...);
    text("\n");
  }

  // Writes a line without a keyword.
  void vertex_line(const Vec3d& position) {
    number(position.x);
    for (int i = 1; i < 3; ++i) value(position[i]);
    text("\n");
  }
  void vertex_line(const PatchVertex& vertex) {
    number(vertex.position.x);
    for (int i = 1; i < 3; ++i) value(vertex.position[i]);
    value(vertex.normal);
    text("\n");
  }

 private:
  void value(double v) {
    text(" ");
    number(v);
  }
  void value(std::size_t v) {
    text(" ");
    number(v);
  }
  void value(int v) { value(static_cast<std::size_t>(v)); }  // pixels
  void value(const Vec3d& v) {
    for (int i = 0; i < 3; ++i) value(v[i]);
  }
  void value(const Rgb& c) {
    for (int i = 0; i < 3; ++i) value(c[i]);
  }
};

void write_view(const View& view, NffOutput& out) {
  out.line("v");
  out.line("from", view.from);
  out.line("at", view.at);
  out.line("up", view.up);
  out.line("angle", view.angle_degrees);
  out.line("hither", view.hither);
  out.line("resolution", view.width, view.height);
}

// With a colour for each term, Kd is the largest component of the diffuse one.
void write_material(const Material& m, NffOutput& out) {
  if (m.terms) {
    const Rgb& diffuse = m.terms->diffuse;
    const double kd = std::max({diffuse.x, diffuse.y, diffuse.z});
    return out.line("f", kd > 0 ? diffuse / kd : diffuse, kd, m.specular, m.shine, m.transmittance,
                    m.refractive_index);
  }
  out.line("f", m.color, m.diffuse, m.specular, m.shine, m.transmittance, m.refractive_index);
}

template <typename Vertices>
void write_vertices(std::string_view keyword, const Vertices& vertices, NffOutput& out) {
  out.line(keyword, vertices.size());
  for (const auto& vertex : vertices) out.vertex_line(vertex);
}

void write_triangle(const SceneDescription& scene, const Triangle& triangle, NffOutput& out) {
  const std::array<PatchVertex, 3> corners = corners_of(scene, triangle);
  if (!scene.meshes[triangle.mesh].normals.empty()) return write_vertices("pp", corners, out);
  const std::array<Vec3d, 3> flat = {corners[0].position, corners[1].position, corners[2].position};
  write_vertices("p", flat, out);
}

void write_primitive(const SceneDescription& scene, PrimitiveRef ref, NffOutput& out) {
  switch (ref.kind) {
    case PrimitiveKind::kSphere: {
      const Sphere& s = scene.spheres[ref.index];
      return out.line("s", s.center, s.radius);
    }
    case PrimitiveKind::kCone: {
      const Cone& c = scene.cones[ref.index];
      return out.line("c", c.base, c.base_radius, c.apex, c.apex_radius);
    }
    case PrimitiveKind::kPolygon:
      return write_vertices("p", scene.vertices(scene.polygons[ref.index]), out);
    case PrimitiveKind::kPatch:
      return write_vertices("pp", scene.vertices(scene.patches[ref.index]), out);
    case PrimitiveKind::kTriangle:
      return write_triangle(scene, scene.triangles[ref.index], out);
    case PrimitiveKind::kMovingTriangle:
      break;  // still_at() turns them into others
  }
}

}  // namespace

void write_nff(const SceneDescription& scene, std::ostream& stream, NumberFormat format) {
  NffOutput out(stream, format);
  if (scene.background) out.line("b", *scene.background);
  if (scene.view) write_view(*scene.view, out);
  for (const Light& light : scene.lights) {
    if (light.color) {
      out.line("l", light.position, *light.color);
    } else {
      out.line("l", light.position);
    }
  }
  std::optional<MaterialIndex> current;
  for (const PrimitiveRef ref : scene.order) {
    const MaterialIndex material = material_of(scene, ref);
    if (current != material) write_material(scene.materials[material], out);
    current = material;
    write_primitive(scene, ref, out);
  }
  out.flush();
}

}  // namespace pprt
