#include "scene/writers/aff_writer.h"

#include <Imath/ImathMatrix.h>
#include <Imath/ImathMatrixAlgo.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "scene/description/shading_rules.h"
#include "scene/writers/entity_output.h"

namespace pprt {
namespace {

// One "xs" of AFF: scale, then turn, then translation.
struct StaticTransform {
  Vec3d scale{1, 1, 1};
  RotationKey turn;
  Vec3d translation{0, 0, 0};
};

Affine columns(const Imath::M33d& m) {  // Imath's arrays are rows
  return {{m[0][0], m[1][0], m[2][0]}, {m[0][1], m[1][1], m[2][1]}, {m[0][2], m[1][2], m[2][2]}, {0, 0, 0}};
}

// Returns one transform for a map that stretches along its axes alone, or else two, the outer one first: by
// the singular value decomposition, a turn, a stretch and another turn.
std::vector<StaticTransform> static_transforms(const Affine& map) {
  constexpr double kRightAngle = 1e-14;
  const Vec3d lengths(map.x.length(), map.y.length(), map.z.length());
  const double askew =
      std::max({std::abs(map.x.dot(map.y)), std::abs(map.y.dot(map.z)), std::abs(map.z.dot(map.x))});
  const double largest = std::max({lengths.x, lengths.y, lengths.z});
  if (map.determinant() != 0 && askew <= kRightAngle * largest * largest) {
    const double side = map.determinant() < 0 ? -1 : 1;
    const Affine turn{map.x / lengths.x, map.y / lengths.y, map.z / (side * lengths.z), {0, 0, 0}};
    return {{{lengths.x, lengths.y, side * lengths.z}, rotation_key(0, turn), map.origin}};
  }
  const Imath::M33d m(map.x.x, map.y.x, map.z.x, map.x.y, map.y.y, map.z.y, map.x.z, map.y.z, map.z.z);
  Imath::M33d outer, inner;
  Vec3d scale;
  Imath::jacobiSVD(m, outer, scale, inner, std::numeric_limits<double>::epsilon(),
                   true);  // turns do not mirror
  return {{scale, rotation_key(0, columns(outer)), map.origin},
          {{1, 1, 1}, rotation_key(0, columns(inner.transposed())), {0, 0, 0}}};
}

// Gives each movement a name that AFF can hold.
class TrackNames {
 public:
  // Returns the same name for the same movement.
  const std::string& of(const std::string& track) {
    const auto [found, is_new] = names_.try_emplace(track);
    if (!is_new) return found->second;
    std::string name = track.substr(0, kLongest);
    for (char& c : name) {
      if (static_cast<unsigned char>(c) <= ' ' ||
          std::string_view("#%{}\"'").find(c) != std::string_view::npos)
        c = '_';
    }
    found->second = name;
    for (int i = 2; !taken_.insert(found->second).second; ++i) found->second = name + "_" + std::to_string(i);
    return found->second;
  }

 private:
  static constexpr std::size_t kLongest = 200;
  std::map<std::string, std::string> names_;
  std::set<std::string> taken_;
};

class AffWriter {
 public:
  AffWriter(const SceneDescription& scene, std::ostream& out, const std::vector<std::string>& texture_files)
      : scene_(scene), out_(out), texture_files_(texture_files) {}

  void run() {
    names_.of(kCameraTrack);  // no other movement gets this name
    if (scene_.background) out_.line("b", *scene_.background);
    if (scene_.sky) out_.line("bs", scene_.sky->up, scene_.sky->horizon, scene_.sky->zenith);
    if (scene_.view) out_.view_lines(*scene_.view);
    const double weight = scene_.ambient ? 1 : light_weight(scene_.lights.size());
    out_.line("am", scene_.ambient.value_or(Rgb(weight, weight, weight)));
    if (const auto& times = scene_.movement.times) out_.line("a", times->start, times->end, times->frames);
    for (const auto& [name, track] : scene_.movement.tracks) write_track(name, track);
    for (std::size_t i = 0; i < scene_.lights.size(); ++i) write_light(i, weight);
    std::size_t place = 0;
    while (place < scene_.order.size()) place = write_objects(place);
    go_to(0);
    out_.flush();
  }

 private:
  // --- Movement

  void write_track(const std::string& name, const MotionTrack& track) {
    out_.text("k ");
    out_.text(names_.of(name));
    out_.text(" {\n");
    write_keys("transl", track.translation);
    write_keys("scale", track.scale);
    if (!track.rotation.empty()) out_.line("rot", track.rotation.size());
    for (const RotationKey& k : track.rotation)
      out_.line("", k.time, k.axis, k.degrees, k.shape.tension, k.shape.continuity, k.shape.bias);
    if (!track.visibility.empty()) out_.line("visibility", track.visibility.size());
    for (const VisibilityKey& k : track.visibility) out_.line("", k.time, k.visible ? 1 : 0);
    out_.text("}\n");
  }

  void write_keys(std::string_view kind, const std::vector<VectorKey>& keys) {
    if (!keys.empty()) out_.line(kind, keys.size());
    for (const VectorKey& k : keys)
      out_.line("", k.time, k.value, k.shape.tension, k.shape.continuity, k.shape.bias);
  }

  // Closes and opens transforms until what follows stands in a node.
  void go_to(NodeIndex node) {
    std::vector<NodeIndex> path;  // from the world to the node
    for (NodeIndex n = node; n != 0; n = scene_.movement.nodes[n].parent) path.push_back(n);
    std::reverse(path.begin(), path.end());
    const auto same = static_cast<std::size_t>(
        std::mismatch(path.begin(), path.end(), open_.begin(), open_.end()).first - path.begin());
    while (open_.size() > same) close();
    while (open_.size() < path.size()) open(path[open_.size()]);
  }

  void open(NodeIndex index) {
    const SceneNode& node = scene_.movement.nodes[index];
    open_.push_back(index);
    if (!node.track.empty()) {
      out_.text("x ");
      out_.text(names_.of(node.track));
      out_.text(" {\n");
      braces_.push_back(1);
      return;
    }
    const std::vector<StaticTransform> transforms = static_transforms(node.to_parent);
    for (const StaticTransform& t : transforms) {
      out_.line("xs", t.scale, t.turn.axis, t.turn.degrees, t.translation);
      out_.text("{\n");
    }
    braces_.push_back(transforms.size());
  }

  void close() {
    for (std::size_t i = 0; i < braces_.back(); ++i) out_.text("}\n");
    braces_.pop_back();
    open_.pop_back();
  }

  // --- Lights and objects

  void write_light(std::size_t index, double weight) {
    const Light& light = scene_.lights[index];
    const LightNode at = scene_.light_nodes.empty() ? LightNode() : scene_.light_nodes[index];
    const Rgb color = light.color.value_or(Rgb(1, 1, 1)) * weight;
    go_to(at.node);
    if (scene_.movement.tracks.contains(at.track)) {
      out_.line("la", std::string_view(names_.of(at.track)), light.position, color);
    } else {
      out_.line(light.is_sun ? "ls" : "l", light.position, color);
    }
  }

  // Writes the object at a place, or several triangles of one mesh. Returns the place after them.
  std::size_t write_objects(std::size_t place) {
    const PrimitiveRef ref = scene_.order[place];
    const NodeIndex node = node_of(scene_, place);
    go_to(node);
    write_material(material_of(scene_, ref));
    switch (ref.kind) {
      case PrimitiveKind::kSphere:
        out_.shape_lines(scene_.spheres[ref.index]);
        break;
      case PrimitiveKind::kCone:
        out_.shape_lines(scene_.cones[ref.index]);
        break;
      case PrimitiveKind::kPolygon:
        out_.vertex_lines("p", scene_.vertices(scene_.polygons[ref.index]));
        break;
      case PrimitiveKind::kPatch:
        out_.vertex_lines("pp", scene_.vertices(scene_.patches[ref.index]));
        break;
      case PrimitiveKind::kMovingTriangle:
        write_moving(scene_.moving_triangles[ref.index]);
        break;
      case PrimitiveKind::kTriangle: {
        const std::size_t end = end_of_mesh(place, node);
        write_mesh(place, end);
        return end;
      }
    }
    return place + 1;
  }

  // A material is in force until the next, whatever braces are between.
  void write_material(MaterialIndex index) {
    Material m = scene_.materials[index];
    m.texture.reset();  // a mesh tells its own
    if (material_ == m) return;
    material_ = m;
    if (m.terms) {
      out_.line("fm", m.terms->ambient, m.terms->diffuse, m.terms->specular, m.shine, m.transmittance,
                m.refractive_index);
    } else {
      out_.line("f", m.color, m.diffuse, m.specular, m.shine, m.transmittance, m.refractive_index);
    }
    if (m.emission_texture) {
      out_.line("fet", std::string_view(texture_files_.at(*m.emission_texture)), m.emission);
    } else if (m.emission != Rgb(0, 0, 0)) {
      out_.line("fe", m.emission);
    }
  }

  void write_moving(const MovingTriangle& triangle) {
    out_.line("tpa", triangle.keys.size());
    for (const MovingTriangle::Key& key : triangle.keys) {
      out_.line("", key.time);
      for (std::size_t i = 0; i < 3; ++i) out_.vertex_line(PatchVertex{key.positions[i], key.normals[i]});
    }
  }

  std::size_t end_of_mesh(std::size_t place, NodeIndex node) const {
    const std::uint32_t mesh = scene_.triangles[scene_.order[place].index].mesh;
    const auto belongs = [&](std::size_t at) {
      const PrimitiveRef ref = scene_.order[at];
      return ref.kind == PrimitiveKind::kTriangle && scene_.triangles[ref.index].mesh == mesh &&
             node_of(scene_, at) == node;
    };
    while (place < scene_.order.size() && belongs(place)) ++place;
    return place;
  }

  void write_mesh(std::size_t begin, std::size_t end) {
    const TriangleMesh& mesh = scene_.meshes[scene_.triangles[scene_.order[begin].index].mesh];
    const Material& material = scene_.materials[mesh.material];
    const std::optional<TextureIndex> texture = material.texture;
    const bool is_textured = material.has_picture() && !mesh.texture_points.empty();
    out_.text("m\n");
    out_.vertex_lines("vertices", mesh.positions);
    if (!mesh.normals.empty()) out_.vertex_lines("normals", mesh.normals);
    if (is_textured) {
      out_.line("texturecoords", mesh.texture_points.size(),
                texture ? std::string_view(texture_files_.at(*texture)) : kNoTexture);
      for (const Vec2d& p : mesh.texture_points) out_.line("", p);
    }
    out_.line("triangles", end - begin);
    for (std::size_t place = begin; place < end; ++place) {
      const TriangleCorners& corners = scene_.triangles[scene_.order[place].index].corners;
      write_indices(corners.position);
      if (!mesh.normals.empty()) write_indices(corners.normal);
      if (is_textured) write_indices(corners.texture_point);
      out_.text("\n");
    }
  }

  void write_indices(const std::array<std::uint32_t, 3>& indices) {
    for (const std::uint32_t i : indices) {
      out_.text(" ");
      out_.number(static_cast<std::size_t>(i));
    }
  }

  const SceneDescription& scene_;
  EntityOutput out_;
  const std::vector<std::string>& texture_files_;
  TrackNames names_;
  std::vector<NodeIndex> open_;       // the path to where the output stands
  std::vector<std::size_t> braces_;   // of each
  std::optional<Material> material_;  // in force
};

}  // namespace

void write_aff(const SceneDescription& scene, std::ostream& out,
               const std::vector<std::string>& texture_files) {
  AffWriter(scene, out, texture_files).run();
}

}  // namespace pprt
