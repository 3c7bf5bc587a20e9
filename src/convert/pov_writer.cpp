#include "convert/pov_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "base/diagnostics.h"
#include "scene/shading_rules.h"
#include "scene/text_output.h"
#include "scene/triangulate.h"
#include "scene/view_frame.h"

namespace pprt {
namespace {

// POV-Ray drops hits nearer than 1e-3 to a ray's origin or beyond 1e7, and keeps mesh vertices in float. The
// scene is scaled so that its extent, eye included, is in [2^15, 2^16). Then 1e-3 is at most 2^-25 of the
// extent, the rounding of a float.
constexpr int kExtentExponent = 16;

// Largest transmittance written: it leaves POV-Ray a share of the surface to light, which is compensated.
constexpr double kLargestTransmittance = 1 - 0x1p-10;

// Returns the factor of that scaling, a power of two, which rounds nothing.
double pov_scale(const SceneDescription& scene) {
  Box3d box = bounds(scene);
  box.extendBy(scene.view->from);
  const Vec3d size = box.max - box.min;
  const double extent = std::max({size.x, size.y, size.z});
  if (!(extent > 0) || !std::isfinite(extent)) return 1;
  return std::ldexp(1.0, kExtentExponent - 1 - std::ilogb(extent));
}

class PovWriter {
 public:
  PovWriter(const SceneDescription& scene, std::ostream& stream)
      : scene_(scene), out_(stream), scale_(pov_scale(scene)) {}

  PovLosses run() {
    header();
    camera();
    lights();
    for (std::size_t i = 0; i < scene_.materials.size(); ++i) material(i);
    for (const PrimitiveRef ref : scene_.order) primitive(ref);
    close_mesh();
    out_.flush();
    return losses_;
  }

 private:
  // Writes texts and values one after the other.
  template <typename... Values>
  void put(const Values&... values) {
    (value(values), ...);
  }
  void value(std::string_view text) { out_.text(text); }
  void value(const char* text) { out_.text(text); }
  void value(double number) { out_.number(number); }
  void value(std::size_t number) { out_.number(number); }
  void value(const Vec3d& v) { put("<", v.x, ", ", v.y, ", ", v.z, ">"); }
  void value(const Rgb& c) { put("rgb <", c.x, ", ", c.y, ", ", c.z, ">"); }

  Vec3d point(const Vec3d& p) const { return p * scale_; }
  double length(double l) const { return std::abs(l) * scale_; }

  // Colours are display values and shading adds them up as they are; POV-Ray does the same when its working
  // gamma is that of its pictures.
  void header() {
    put("// Lengths are ", scale_, " times the scene's, as POV-Ray ignores hits nearer than 0.001.\n",
        "//   povray +I... +W", static_cast<std::size_t>(scene_.view->width), " +H",
        static_cast<std::size_t>(scene_.view->height), " -A\n#version 3.7;\n",
        "global_settings { assumed_gamma srgb max_trace_level 5 adc_bailout 0 ambient_light rgb 1 }\n",
        "background { ", scene_.background.value_or(Rgb(0, 0, 0)), " }\n\n");
  }

  // The view's angle spans the centres of the first and the last row, at whatever size the image is rendered.
  // Right, up and forward are given explicitly, so that POV-Ray's left-handed axes do not matter.
  void camera() {
    const ViewFrame frame = view_frame(*scene_.view, scene_.name);
    const double tangents = frame.slope_per_pixel * std::max(scene_.view->height - 1, 1);
    put("#declare Pixel = ", tangents, " / max(image_height - 1, 1);\n",
        "camera {\n  perspective\n  location ", point(scene_.view->from), "\n  direction ", frame.forward,
        "\n  right ", frame.right, " * Pixel * image_width\n  up ", frame.up,
        " * Pixel * image_height\n}\n\n");
  }

  void lights() {
    const double weight = light_weight(scene_.lights.size());
    for (const Light& light : scene_.lights) {
      put("light_source { ", point(light.position), " ", light.color.value_or(Rgb(1, 1, 1)) * weight, " }\n");
    }
    put("\n");
  }

  // POV-Ray scales the ambient and the diffuse share by the pigment's opacity, NFF does not.
  void material(std::size_t index) {
    const Material& m = scene_.materials[index];
    const double transmittance = std::clamp(m.transmittance, 0.0, kLargestTransmittance);
    const double per_opacity = 1 / (1 - transmittance);
    put("#declare Material_", index + 1, " = texture {\n  pigment { ", m.color);
    if (transmittance > 0) put(" transmit ", transmittance);
    put(" }\n  finish { ambient ", kAmbientReflectance * light_weight(scene_.lights.size()) * per_opacity,
        " diffuse ", m.diffuse * per_opacity);
    if (has_highlight(m)) put(" phong ", m.specular, " phong_size ", m.shine);
    if (m.specular > 0) put(" reflection ", m.specular);
    put(" }\n}\n");
  }

  void primitive(PrimitiveRef ref) {
    switch (ref.kind) {
      case PrimitiveKind::kSphere:
        return sphere(scene_.spheres[ref.index]);
      case PrimitiveKind::kCone:
        return cone(scene_.cones[ref.index]);
      case PrimitiveKind::kPolygon: {
        const Polygon& polygon = scene_.polygons[ref.index];
        const std::span<const Vec3d> vertices = scene_.vertices(polygon);
        corners_.assign(vertices.begin(), vertices.end());
        return facets(polygon.material, {});
      }
      case PrimitiveKind::kPatch: {
        const Patch& patch = scene_.patches[ref.index];
        const std::span<const PatchVertex> vertices = scene_.vertices(patch);
        corners_.clear();
        for (const PatchVertex& v : vertices) corners_.push_back(v.position);
        return facets(patch.material, vertices);
      }
      case PrimitiveKind::kTriangle:
        return triangle(scene_.triangles[ref.index]);
      case PrimitiveKind::kMovingTriangle:
        break;  // still_at() leaves none
    }
  }

  void triangle(const Triangle& t) {
    const TriangleMesh& mesh = scene_.meshes[t.mesh];
    const std::array<PatchVertex, 3> corners = corners_of(scene_, t);
    corners_.clear();
    for (const PatchVertex& v : corners) corners_.push_back(v.position);
    facets(mesh.material, mesh.normals.empty() ? std::span<const PatchVertex>() : corners);
    if (mesh.texture_points.empty() || triangulate(corners_).empty()) return;
    // Written after the triangle's corners, inside its braces: see facets().
  }

  void sphere(const Sphere& s) {
    if (s.radius == 0) return drop();
    if (s.radius < 0) ++losses_.one_sided;
    begin_object(s.material);
    put("sphere { ", point(s.center), ", ", length(s.radius));
    end_object(s.material);
  }

  void cone(const Cone& c) {
    if (c.base == c.apex || (c.base_radius == 0 && c.apex_radius == 0)) return drop();
    if (c.base_radius < 0 || c.apex_radius < 0) ++losses_.one_sided;
    begin_object(c.material);
    if (std::abs(c.base_radius) == std::abs(c.apex_radius)) {
      put("cylinder { ", point(c.base), ", ", point(c.apex), ", ", length(c.base_radius), " open");
    } else {
      put("cone { ", point(c.base), ", ", length(c.base_radius), ", ", point(c.apex), ", ",
          length(c.apex_radius), " open");
    }
    end_object(c.material);
  }

  // Writes the polygon in corners_, with normals when `smooth` is not empty.
  void facets(MaterialIndex material, std::span<const PatchVertex> smooth) {
    const std::vector<TriangleIndices> triangles = triangulate(corners_);
    if (triangles.empty()) return drop();
    open_mesh(material);
    if (smooth.empty()) {
      for (const TriangleIndices& t : triangles) {
        put("\n  triangle { ", point(corners_[t[0]]), ", ", point(corners_[t[1]]), ", ",
            point(corners_[t[2]]), " }");
      }
      return;
    }
    const Vec3d flat = newell_normal(corners_).normalized();
    const auto normal = [&](std::uint32_t corner) {
      const Vec3d given = smooth[corner].normal.normalized();  // zero stays zero
      return given == Vec3d(0, 0, 0) ? flat : given;
    };
    for (const TriangleIndices& t : triangles) {
      put("\n  smooth_triangle { ", point(corners_[t[0]]), ", ", normal(t[0]), ", ", point(corners_[t[1]]),
          ", ", normal(t[1]), ", ", point(corners_[t[2]]), ", ", normal(t[2]), " }");
    }
  }

  // Polygons of one material that follow each other make one mesh. Glass needs them together: POV-Ray tells
  // entering from leaving by the interior that a ray is in, and each object has its own.
  void open_mesh(MaterialIndex material) {
    if (mesh_ == material) return;
    begin_object(material);
    mesh_ = material;
    put("mesh {");
  }

  void close_mesh() {
    if (!mesh_) return;
    const MaterialIndex material = *mesh_;
    mesh_.reset();
    end_object(material);
  }

  bool transparent(MaterialIndex material) const { return scene_.materials[material].transmittance > 0; }

  void begin_object(MaterialIndex material) {
    close_mesh();
    if (transparent(material)) put("#declare Glass = ");
  }

  // Transparent objects cast full shadows here, but let light through in POV-Ray. So the visible object casts
  // none, and an invisible copy of it does.
  void end_object(MaterialIndex material) {
    const std::size_t name = material + std::size_t{1};
    if (!transparent(material)) return put(" texture { Material_", name, " } }\n");
    put(" }\nobject { Glass texture { Material_", name, " } interior { ior ",
        effective_refractive_index(scene_.materials[material]),
        " } no_shadow }\nobject { Glass no_image no_reflection }\n");
  }

  void drop() { ++losses_.degenerate; }

  const SceneDescription& scene_;
  TextOutput out_;
  double scale_;
  std::optional<MaterialIndex> mesh_;  // the material of the mesh that is being written
  std::vector<Vec3d> corners_;
  PovLosses losses_;
};

}  // namespace

PovLosses write_pov(const SceneDescription& scene, std::ostream& out) {
  if (!scene.view) throw InputError(scene.name + ": error: the scene has no view");
  return PovWriter(scene, out).run();
}

}  // namespace pprt
