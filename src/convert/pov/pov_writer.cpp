#include "convert/pov/pov_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "base/affine.h"
#include "base/diagnostics.h"
#include "convert/pov/pov_material.h"
#include "scene/description/shading_rules.h"
#include "scene/description/view_frame.h"
#include "scene/polygons/triangulate.h"
#include "scene/writers/text_output.h"

namespace pprt {
namespace {

// POV-Ray drops hits nearer than 1e-3 to a ray's origin or beyond 1e7, and keeps mesh vertices in float. The
// scene is scaled so that its extent, eye included, is in [2^15, 2^16). Then 1e-3 is at most 2^-25 of the
// extent, the rounding of a float.
constexpr int kExtentExponent = 16;

// Returns the factor of that scaling, a power of two, which rounds nothing.
double pov_scale(const SceneDescription& scene, const std::vector<Placement>& placements) {
  Box3d box;
  for (std::size_t i = 0; i < scene.order.size(); ++i)
    box.extendBy(mapped(placements[node_of(scene, i)].to_parent, bounds(scene, scene.order[i])));
  box.extendBy(scene.view->from);
  const Vec3d size = box.max - box.min;
  const double extent = std::max({size.x, size.y, size.z});
  if (!(extent > 0) || !std::isfinite(extent)) return 1;
  return std::ldexp(1.0, kExtentExponent - 1 - std::ilogb(extent));
}

// Triangles of one kind may make one mesh.
struct MeshKind {
  MaterialIndex material = 0;
  bool textured = false;

  friend bool operator==(const MeshKind&, const MeshKind&) = default;
};

class PovWriter {
 public:
  PovWriter(const SceneDescription& scene, std::ostream& stream, const std::string& stem)
      : scene_(scene),
        out_(stream),
        placements_(placements_at(scene.movement, 0)),
        scale_(pov_scale(scene, placements_)),
        pictures_(pov_pictures(scene, stem)) {}

  PovLosses run() {
    header();
    camera();
    lights();
    for (std::size_t i = 0; i < scene_.materials.size(); ++i) material(i);
    for (std::size_t place = 0; place < scene_.order.size(); ++place) {
      map_ = placements_[node_of(scene_, place)].to_parent;
      primitive(scene_.order[place]);
    }
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
  void value(const Vec2d& v) { put("<", v.x, ", ", v.y, ">"); }
  void value(const Rgb& c) { put("rgb <", c.x, ", ", c.y, ", ", c.z, ">"); }

  // Writes one number for three equal ones.
  void amount(const Rgb& c) {
    if (c.x == c.y && c.y == c.z) return put(c.x);
    put(c);
  }

  // Writes a file's name as a text of POV-Ray's language.
  void quoted(std::string_view name) {
    std::string escaped;
    for (const char c : name) {
      if (c == '"' || c == '\\') escaped += '\\';
      escaped += c;
    }
    put("\"", escaped, "\"");
  }

  Vec3d point(const Vec3d& p) const { return p * scale_; }
  double length(double l) const { return std::abs(l) * scale_; }

  // Colours are display values and shading adds them up as they are; POV-Ray does the same when its working
  // gamma is that of its pictures.
  void header() {
    put("// Lengths are ", scale_, " times the scene's, as POV-Ray ignores hits nearer than 0.001.\n",
        "//   povray +I... +W", static_cast<std::size_t>(scene_.view->width), " +H",
        static_cast<std::size_t>(scene_.view->height), " -A\n#version 3.7;\n",
        "global_settings { assumed_gamma srgb max_trace_level 5 adc_bailout 0 ambient_light rgb 1 }\n",
        "background { ", ground_color(scene_), " }\n");
    if (scene_.sky) sky(*scene_.sky);
    put("\n");
  }

  // The gradient runs from the nadir to the zenith. There it would begin anew, so it is a little longer.
  void sky(const Sky& sky) {
    constexpr double kLonger = 1 + 0x1p-20;
    const Vec3d up = sky.up.normalized();
    const Rgb ground = ground_color(scene_);
    put("sky_sphere { pigment { gradient ", up, " color_map { [0 ", ground, "] [0.5 ", ground, "] [0.5 ",
        sky.horizon, "] [1 ", sky.zenith, "] } scale ", 2 * kLonger, " translate ", -up * kLonger, " } }\n");
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
    const double weight = scene_.ambient ? 1 : light_weight(scene_.lights.size());
    for (const Light& light : scene_.lights) {
      const Rgb color = light.color.value_or(Rgb(1, 1, 1)) * weight;
      if (light.is_sun) {
        sun(light, color);
      } else {
        put("light_source { ", point(light.position), " ", color, " }\n");
      }
    }
    put("\n");
  }

  // Nothing is farther away than its place. POV-Ray ignores hits beyond ten times that.
  void sun(const Light& light, const Rgb& color) {
    constexpr double kFar = 1e6;
    const Vec3d at = point(scene_.view->from);
    put("light_source { ", at + light.position.normalized() * kFar, " ", color, " parallel point_at ", at,
        " }\n");
  }

  // A material with a picture also gets a texture that shows it, for triangles with texture points.
  void material(std::size_t index) {
    const Material& m = scene_.materials[index];
    const PovMaterial pov = pov_material(scene_, m);
    losses_.lost_highlights += pov.lost_highlight;
    losses_.lost_ambient += pov.lost_ambient;
    put("#declare Material_", index + 1, " = ");
    layers(m, pov, std::nullopt, std::nullopt);
    if (!m.has_picture()) return;
    put("#declare Textured_", index + 1, " = ");
    layers(m, pov, pictures_.materials[index], pictures_.emissions[index]);
  }

  // Files of the colour and of the emission, where there are any.
  void layers(const Material& m, const PovMaterial& pov, std::optional<std::size_t> color,
              std::optional<std::size_t> emission) {
    pigment(color, pov.pigment, pov.transmit);
    finish(m, pov);
    if (pov.filter)
      put("texture {\n  pigment { ", *pov.filter, " filter 1 }\n  finish { ambient 0 diffuse 0 }\n}\n");
    if (!pov.emission) return;
    pigment(emission, Rgb(1, 1, 1), kLargestTransmittance);
    put("  finish { ambient 0 diffuse 0 emission ");
    amount(*pov.emission);
    put(" }\n}\n");
  }

  // A picture is that of the pigment alone: layers of textures that are mapped as a whole are refused.
  void pigment(std::optional<std::size_t> file, const Rgb& color, double transmit) {
    put("texture {\n");
    if (!file) {
      put("  pigment { ", color);
      if (transmit > 0) put(" transmit ", transmit);
      return put(" }\n");
    }
    put("  pigment { uv_mapping image_map { png ");
    quoted(pictures_.files[*file].name);
    put(" gamma srgb interpolate 2");
    if (transmit > 0) put(" transmit all ", transmit);
    put(" } }\n");
  }

  void finish(const Material& m, const PovMaterial& pov) {
    put("  finish { ambient ");
    amount(pov.ambient);
    put(" diffuse ", pov.diffuse);
    if (pov.phong > 0) put(" phong ", pov.phong, " phong_size ", m.shine);
    if (m.specular > 0) {
      put(" reflection ");
      amount(pov.reflection);
    }
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
        texture_points_.clear();
        return facets(polygon.material, {});
      }
      case PrimitiveKind::kPatch: {
        const Patch& patch = scene_.patches[ref.index];
        const std::span<const PatchVertex> vertices = scene_.vertices(patch);
        corners_.clear();
        texture_points_.clear();
        for (const PatchVertex& v : vertices) corners_.push_back(v.position);
        return facets(patch.material, vertices);
      }
      case PrimitiveKind::kTriangle:
        return triangle(scene_.triangles[ref.index]);
      case PrimitiveKind::kMovingTriangle:
        break;  // still_at() leaves none
    }
  }

  // POV-Ray's v runs up from a picture's lower edge.
  void triangle(const Triangle& t) {
    const TriangleMesh& mesh = scene_.meshes[t.mesh];
    const std::array<PatchVertex, 3> corners = corners_of(scene_, t);
    corners_.clear();
    texture_points_.clear();
    for (const PatchVertex& v : corners) corners_.push_back(v.position);
    if (scene_.materials[mesh.material].has_picture() && !mesh.texture_points.empty()) {
      for (const std::uint32_t at : t.corners.texture_point) {
        const Vec2d& p = mesh.texture_points[at];
        texture_points_.emplace_back(p.x, 1 - p.y);
      }
    }
    facets(mesh.material, mesh.normals.empty() ? std::span<const PatchVertex>() : corners);
  }

  void sphere(const Sphere& s) {
    if (s.radius == 0) return drop();
    if (s.radius < 0) ++losses_.one_sided;
    begin_object(s.material);
    put("sphere { ", point(s.center), ", ", length(s.radius));
    stretch();
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
    stretch();
    end_object(c.material);
  }

  // Writes how a sphere or cone stands in the world that is of another shape there.
  void stretch() {
    if (map_ == Affine()) return;
    put(" matrix <");
    for (const Vec3d& v : {map_.x, map_.y, map_.z}) put(v.x, ", ", v.y, ", ", v.z, ", ");
    const Vec3d origin = point(map_.origin);
    put(origin.x, ", ", origin.y, ", ", origin.z, ">");
  }

  // Writes the polygon in corners_, with normals when `smooth` is not empty, and with texture_points_ if any.
  void facets(MaterialIndex material, std::span<const PatchVertex> smooth) {
    const std::vector<TriangleIndices> triangles = triangulate(corners_);
    if (triangles.empty()) return drop();
    open_mesh({material, !texture_points_.empty()});
    if (smooth.empty()) {
      for (const TriangleIndices& t : triangles) {
        put("\n  triangle { ", point(corners_[t[0]]), ", ", point(corners_[t[1]]), ", ",
            point(corners_[t[2]]));
        end_triangle(t);
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
          ", ", normal(t[1]), ", ", point(corners_[t[2]]), ", ", normal(t[2]));
      end_triangle(t);
    }
  }

  void end_triangle(const TriangleIndices& t) {
    if (!texture_points_.empty()) {
      put(" uv_vectors ", texture_points_[t[0]], ", ", texture_points_[t[1]], ", ", texture_points_[t[2]]);
    }
    put(" }");
  }

  // Polygons of one material that follow each other make one mesh. Glass needs them together: POV-Ray tells
  // entering from leaving by the interior that a ray is in, and each object has its own.
  void open_mesh(const MeshKind& kind) {
    if (mesh_ == kind) return;
    begin_object(kind.material);
    mesh_ = kind;
    put("mesh {");
  }

  void close_mesh() {
    if (!mesh_) return;
    const MeshKind kind = *mesh_;
    mesh_.reset();
    end_object(kind.material, kind.textured ? "Textured_" : "Material_");
  }

  bool transparent(MaterialIndex material) const { return scene_.materials[material].transmittance > 0; }

  void begin_object(MaterialIndex material) {
    close_mesh();
    if (transparent(material)) put("#declare Glass = ");
  }

  // Transparent objects cast full shadows here, but let light through in POV-Ray. So the visible object casts
  // none, and an invisible copy of it does.
  void end_object(MaterialIndex material, const char* texture = "Material_") {
    const std::size_t name = material + std::size_t{1};
    if (!transparent(material)) return put(" texture { ", texture, name, " } }\n");
    put(" }\nobject { Glass texture { ", texture, name, " } interior { ior ",
        effective_refractive_index(scene_.materials[material]),
        " } no_shadow }\nobject { Glass no_image no_reflection }\n");
  }

  void drop() { ++losses_.degenerate; }

  const SceneDescription& scene_;
  TextOutput out_;
  std::vector<Placement> placements_;  // of the nodes in which stretched spheres and cones stand
  double scale_;
  PovPictures pictures_;
  Affine map_;                    // of the primitive at hand
  std::optional<MeshKind> mesh_;  // of the mesh that is being written
  std::vector<Vec3d> corners_;
  std::vector<Vec2d> texture_points_;  // of the corners; empty: none
  PovLosses losses_;
};

}  // namespace

PovLosses write_pov(const SceneDescription& scene, std::ostream& out, const std::string& stem) {
  if (!scene.view) throw InputError(scene.name + ": error: the scene has no view");
  return PovWriter(scene, out, stem).run();
}

}  // namespace pprt
