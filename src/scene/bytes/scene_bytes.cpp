#include "scene/bytes/scene_bytes.h"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "base/content_hash.h"
#include "base/wire.h"

namespace pprt {

template <>
inline constexpr PrimitiveKind kLast<PrimitiveKind> = PrimitiveKind::kMovingTriangle;
namespace {

// Both archives take the fields of a value in the same order; fields_of() below names them once.
template <typename Archive, typename T>
void fields_of(Archive& archive, T& value);

class Writer {
 public:
  // `origin`: whether names and places in files are written.
  explicit Writer(bool origin) : origin_(origin) {}

  template <typename... Values>
  void operator()(const Values&... values) {
    (value(values), ...);
  }
  void origin(const std::string& name) {
    if (origin_) out_.put(name);
  }
  void origin(const SourceLocation& at) {
    if (origin_) out_.put(at.line), out_.put(at.column);
  }
  Bytes take() { return out_.take(); }

 private:
  template <typename T>
  void value(const T& v) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      out_.put(v);
    } else {
      fields_of(*this, const_cast<T&>(v));  // this archive only reads
    }
  }
  void value(const std::string& text) { out_.put(text); }
  void value(const std::vector<std::uint8_t>& bytes) { out_.put_all<std::uint8_t>(bytes); }
  template <typename T>
  void value(const std::vector<T>& all) {
    out_.put(static_cast<std::uint64_t>(all.size()));
    for (const T& v : all) value(v);
  }
  template <typename T, std::size_t kSize>
  void value(const std::array<T, kSize>& all) {
    for (const T& v : all) value(v);
  }
  template <typename T>
  void value(const std::optional<T>& v) {
    out_.put(v.has_value());
    if (v) value(*v);
  }
  template <typename Key, typename T, typename Less>
  void value(const std::map<Key, T, Less>& all) {
    out_.put(static_cast<std::uint64_t>(all.size()));
    for (const auto& [key, v] : all) value(key), value(v);
  }

  bool origin_;
  WireWriter out_;
};

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : in_(bytes) {}

  template <typename... Values>
  void operator()(Values&... values) {
    (value(values), ...);
  }
  void origin(std::string& name) { in_.get(name); }
  void origin(SourceLocation& at) { in_.get(at.line), in_.get(at.column); }
  void end() const { in_.expect_end(); }

 private:
  template <typename T>
  void value(T& v) {
    if constexpr (std::is_arithmetic_v<T>) {
      in_.get(v);
    } else {
      fields_of(*this, v);
    }
  }
  void value(PrimitiveKind& kind) { in_.get(kind); }
  void value(std::string& text) { in_.get(text); }
  void value(std::vector<std::uint8_t>& bytes) { in_.get_all(bytes); }
  // A broken count ends with the bytes, before it takes the memory.
  template <typename T>
  void value(std::vector<T>& all) {
    all.clear();
    for (std::uint64_t left = count(); left > 0; --left) value(all.emplace_back());
  }
  template <typename T, std::size_t kSize>
  void value(std::array<T, kSize>& all) {
    for (T& v : all) value(v);
  }
  template <typename T>
  void value(std::optional<T>& v) {
    bool has_value = false;
    in_.get(has_value);
    if (has_value) value(v.emplace());
  }
  template <typename Key, typename T, typename Less>
  void value(std::map<Key, T, Less>& all) {
    for (std::uint64_t left = count(); left > 0; --left) {
      Key key;
      value(key), value(all[key]);
    }
  }
  std::uint64_t count() {
    std::uint64_t n = 0;
    in_.get(n);
    return n;
  }

  WireReader in_;
};

template <typename Archive, typename T>
void fields_of(Archive& archive, T& v) {
  if constexpr (std::is_same_v<T, Vec3d> || std::is_same_v<T, Rgb>) {
    archive(v.x, v.y, v.z);
  } else if constexpr (std::is_same_v<T, Vec2d>) {
    archive(v.x, v.y);
  } else if constexpr (std::is_same_v<T, SourceLocation>) {
    archive.origin(v);
  } else if constexpr (std::is_same_v<T, Affine>) {
    archive(v.x, v.y, v.z, v.origin);
  } else if constexpr (std::is_same_v<T, KeyShape>) {
    archive(v.tension, v.continuity, v.bias);
  } else if constexpr (std::is_same_v<T, VectorKey>) {
    archive(v.time, v.value, v.shape);
  } else if constexpr (std::is_same_v<T, RotationKey>) {
    archive(v.time, v.axis, v.degrees, v.shape);
  } else if constexpr (std::is_same_v<T, VisibilityKey>) {
    archive(v.time, v.visible);
  } else if constexpr (std::is_same_v<T, MotionTrack>) {
    archive(v.translation, v.scale, v.rotation, v.visibility, v.is_in_order);
  } else if constexpr (std::is_same_v<T, SceneNode>) {
    archive(v.parent, v.to_parent, v.track, v.location);
  } else if constexpr (std::is_same_v<T, FrameTimes>) {
    archive(v.start, v.end, v.frames);
  } else if constexpr (std::is_same_v<T, Movement>) {
    archive(v.nodes, v.tracks, v.times);
  } else if constexpr (std::is_same_v<T, LightNode>) {
    archive(v.node, v.track);
  } else if constexpr (std::is_same_v<T, Texture>) {
    archive.origin(v.name);
    archive(v.width, v.height, v.rgb);
  } else if constexpr (std::is_same_v<T, TermColors>) {
    archive(v.ambient, v.diffuse, v.specular);
  } else if constexpr (std::is_same_v<T, Material>) {
    archive(v.color, v.diffuse, v.specular, v.shine, v.transmittance, v.refractive_index, v.terms, v.texture,
            v.emission, v.emission_texture);
  } else if constexpr (std::is_same_v<T, Light>) {
    archive(v.position, v.color, v.location, v.is_sun);
  } else if constexpr (std::is_same_v<T, Sky>) {
    archive(v.up, v.horizon, v.zenith);
  } else if constexpr (std::is_same_v<T, View>) {
    archive(v.from, v.at, v.up, v.angle_degrees, v.hither, v.width, v.height, v.location);
  } else if constexpr (std::is_same_v<T, Sphere>) {
    archive(v.center, v.radius, v.material, v.location);
  } else if constexpr (std::is_same_v<T, Cone>) {
    archive(v.base, v.base_radius, v.apex, v.apex_radius, v.material, v.location);
  } else if constexpr (std::is_same_v<T, Polygon> || std::is_same_v<T, Patch>) {
    archive(v.first_vertex, v.vertex_count, v.material, v.location);
  } else if constexpr (std::is_same_v<T, PatchVertex>) {
    archive(v.position, v.normal);
  } else if constexpr (std::is_same_v<T, TriangleMesh>) {
    archive(v.positions, v.normals, v.texture_points, v.material, v.location);
  } else if constexpr (std::is_same_v<T, TriangleCorners>) {
    archive(v.position, v.normal, v.texture_point);
  } else if constexpr (std::is_same_v<T, Triangle>) {
    archive(v.mesh, v.corners);
  } else if constexpr (std::is_same_v<T, MovingTriangle::Key>) {
    archive(v.time, v.positions, v.normals);
  } else if constexpr (std::is_same_v<T, MovingTriangle>) {
    archive(v.keys, v.material, v.location);
  } else if constexpr (std::is_same_v<T, PrimitiveRef>) {
    archive(v.kind, v.index);
  } else {
    static_assert(std::is_same_v<T, SceneDescription>);
    archive.origin(v.name);
    archive(v.background, v.view, v.lights, v.materials);
    archive(v.spheres, v.cones, v.polygons, v.patches, v.polygon_vertices, v.patch_vertices);
    archive(v.meshes, v.triangles, v.moving_triangles, v.order);
    archive(v.ambient, v.sky, v.textures, v.movement, v.nodes, v.light_nodes);
  }
}

}  // namespace

Bytes encode(const SceneDescription& scene) {
  Writer writer(true);
  writer(scene);
  return writer.take();
}

std::string hash_of(const SceneDescription& scene) {
  Writer writer(false);
  writer(scene);
  const Bytes bytes = writer.take();
  return content_hash({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

SceneDescription decode_scene(std::span<const std::byte> bytes) {
  Reader reader(bytes);
  SceneDescription scene;
  reader(scene);
  reader.end();
  return scene;
}

}  // namespace pprt
