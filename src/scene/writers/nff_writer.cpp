#include "scene/writers/nff_writer.h"

#include <algorithm>
#include <array>
#include <optional>

#include "scene/writers/entity_output.h"

namespace pprt {
namespace {

// With a colour for each term, Kd is the largest component of the diffuse one.
void write_material(const Material& m, EntityOutput& out) {
  if (m.terms) {
    const Rgb& diffuse = m.terms->diffuse;
    const double kd = std::max({diffuse.x, diffuse.y, diffuse.z});
    return out.line("f", kd > 0 ? diffuse / kd : diffuse, kd, m.specular, m.shine, m.transmittance,
                    m.refractive_index);
  }
  out.line("f", m.color, m.diffuse, m.specular, m.shine, m.transmittance, m.refractive_index);
}

void write_triangle(const SceneDescription& scene, const Triangle& triangle, EntityOutput& out) {
  const std::array<PatchVertex, 3> corners = corners_of(scene, triangle);
  if (!scene.meshes[triangle.mesh].normals.empty()) return out.vertex_lines("pp", corners);
  const std::array<Vec3d, 3> flat = {corners[0].position, corners[1].position, corners[2].position};
  out.vertex_lines("p", flat);
}

void write_primitive(const SceneDescription& scene, PrimitiveRef ref, EntityOutput& out) {
  switch (ref.kind) {
    case PrimitiveKind::kSphere:
      return out.shape_lines(scene.spheres[ref.index]);
    case PrimitiveKind::kCone:
      return out.shape_lines(scene.cones[ref.index]);
    case PrimitiveKind::kPolygon:
      return out.vertex_lines("p", scene.vertices(scene.polygons[ref.index]));
    case PrimitiveKind::kPatch:
      return out.vertex_lines("pp", scene.vertices(scene.patches[ref.index]));
    case PrimitiveKind::kTriangle:
      return write_triangle(scene, scene.triangles[ref.index], out);
    case PrimitiveKind::kMovingTriangle:
      break;  // still_at() turns them into others
  }
}

}  // namespace

void write_nff(const SceneDescription& scene, std::ostream& stream, NumberFormat format) {
  EntityOutput out(stream, format);
  if (scene.background) out.line("b", *scene.background);
  if (scene.view) out.view_lines(*scene.view);
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
