#include "convert/mesh/mesh_reader.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/camera.h>
#include <assimp/light.h>
#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <fstream>
#include <limits>
#include <map>
#include <new>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/diagnostics.h"
#include "base/printable.h"
#include "convert/mesh/assimp_values.h"
#include "convert/mesh/gltf_document.h"
#include "convert/mesh/mesh_animation.h"
#include "convert/mesh/mesh_materials.h"
#include "convert/mesh/mesh_textures.h"
#include "convert/mesh/model_files.h"
#include "convert/mesh/model_folder.h"
#include "convert/names/extension.h"
#include "parser/text/text_input.h"
#include "scene/animation/animation.h"
#include "scene/animation/resting_nodes.h"
#include "scene/movement/movement_limits.h"
#include "scene/movement/straight_track.h"
#include "scene/polygons/triangulate.h"

namespace pprt {
namespace {

constexpr std::size_t kMaxPolygons = 20'000'000;
constexpr std::size_t kMaxBytes = std::numeric_limits<std::uint32_t>::max();  // of a .glb or a .gltf

// The transforms of a node that moves: one that stretches askew is written as two.
static_assert(3 * kMaxNodeDepth <= kMostTransforms);

// Cosine from which on a vertex' normal is taken for the polygon's: half a degree.
constexpr double kSameDirection = 0.99996;

// Scales the brightest channel to 1, as the intensity of lights follows from a rule of NFF.
std::optional<Rgb> light_color(const aiColor3D& c) {
  const double largest = std::max({c.r, c.g, c.b});
  if (!(largest > 0) || !std::isfinite(largest)) return std::nullopt;
  const auto share = [&](double v) { return std::isfinite(v) ? std::clamp(v / largest, 0.0, 1.0) : 0; };
  const Rgb color(share(c.r), share(c.g), share(c.b));
  if (color == Rgb(1, 1, 1)) return std::nullopt;
  return color;
}

// Where the contents of a file's node stand: in a node of the scene that moves, or in the world.
struct Space {
  NodeIndex node = 0;
  Affine map;
};

class SceneReader {
 public:
  // `gltf`: of a file in glTF.
  // `gltf`: of a file in glTF. `max_memory`: bytes that its pictures may take.
  SceneReader(const aiScene& from, const std::string& path, std::optional<GltfFacts> gltf,
              std::uint64_t max_memory)
      : from_(from), gltf_(std::move(gltf)), textures_(from, path, max_memory) {
    scene_.name = path;
  }

  ReadMesh run() {
    read_movement();
    node(*from_.mRootNode, {});
    note(skipped_, "points, lines and faces without extent left out");
    note(namesakes_, "nodes have the name of another: movements, cameras and lights may be mixed up");
    note(skins_, "meshes with a skin stand in the pose that they are bound in");
    move_camera();
    drop_unused_tracks();
    return {without_resting_nodes(std::move(scene_)), std::move(notes_), textures_.files()};
  }

 private:
  [[noreturn]] void reject(const std::string& problem) const {
    throw InputError(scene_.name + ": error: " + problem);
  }

  void note(std::size_t count, const std::string& what) {
    if (count > 0) notes_.push_back(std::to_string(count) + " " + what);
  }

  void read_movement() {
    try {
      MeshAnimation animation = read_animation(from_);
      scene_.movement.times = animation.times;
      notes_ = std::move(animation.notes);
      for (auto& [name, track] : animation.tracks)
        scene_.movement.tracks[name == kCameraTrack ? kNodeCalledCamera : name] = std::move(track);
    } catch (const std::runtime_error& e) {
      reject(e.what());
    }
  }

  void node(const aiNode& from, const Space& parent) {
    if (++depth_ > kMaxNodeDepth)
      reject("its nodes lie more than " + std::to_string(kMaxNodeDepth) + " deep in each other");
    namesakes_ += !names_.insert(from.mName.C_Str()).second;
    const Space space = space_of(from, parent);
    for (unsigned i = 0; i < from.mNumMeshes; ++i) {
      if (from.mMeshes[i] >= from_.mNumMeshes) reject("a node names a mesh that is not there");
      mesh(*from_.mMeshes[from.mMeshes[i]], space);
      scene_.nodes.resize(scene_.order.size(), space.node);
    }
    camera(from, space);
    lights(from, space);
    for (unsigned i = 0; i < from.mNumChildren; ++i) node(*from.mChildren[i], space);
    --depth_;
  }

  Space space_of(const aiNode& from, const Space& parent) {
    std::string name = from.mName.C_Str();
    if (name == kCameraTrack) name = kNodeCalledCamera;
    const Affine map = parent.map * to_affine(from.mTransformation);
    if (!is_in_range(map.x) || !is_in_range(map.y) || !is_in_range(map.z) || !is_in_range(map.origin))
      reject("a transform is not finite, or beyond 1e100");
    if (!scene_.movement.tracks.contains(name)) return {parent.node, map};
    const NodeIndex around = add_node({.parent = parent.node, .to_parent = parent.map});
    return {add_node({.parent = around, .track = std::move(name)}), {}};
  }

  NodeIndex add_node(SceneNode node) {
    scene_.movement.nodes.push_back(std::move(node));
    return static_cast<NodeIndex>(scene_.movement.nodes.size() - 1);
  }

  void mesh(const aiMesh& from, const Space& space) {
    check_indices(from);
    skins_ += from.mNumBones > 0;
    const aiMaterial& material = *from_.mMaterials[from.mMaterialIndex];
    Material own = to_material(material);
    if (const std::string path = picture_path(material); !path.empty() && from.mTextureCoords[0] != nullptr)
      own.texture = textures_.intern(path, scene_.textures, notes_);
    const MaterialIndex index = table_.intern(scene_.materials, own);
    own.texture ? textured_mesh(from, space, index) : polygons(from, space, index);
  }

  // Not every reader of Assimp's does.
  void check_indices(const aiMesh& from) const {
    if (from.mMaterialIndex >= from_.mNumMaterials) reject("a mesh names a material that is not there");
    for (const aiFace& face : std::span(from.mFaces, from.mNumFaces)) {
      for (const unsigned index : std::span(face.mIndices, face.mNumIndices)) {
        if (index >= from.mNumVertices) reject("a face names a vertex that is not there");
      }
    }
  }

  Vec3d normal_of(const aiMesh& from, unsigned vertex, const Space& space) const {
    if (from.mNormals == nullptr) return {0, 0, 0};
    const Vec3d normal = space.map.outward(to_vector(from.mNormals[vertex])).normalized();
    return is_in_range(normal) ? normal : Vec3d(0, 0, 0);
  }

  Vec3d position_of(const aiMesh& from, unsigned vertex, const Space& space) const {
    const Vec3d position = space.map.point(to_vector(from.mVertices[vertex]));
    if (!is_in_range(position)) reject("a coordinate is not finite, or beyond 1e100");
    return position;
  }

  void polygons(const aiMesh& from, const Space& space, MaterialIndex material) {
    const bool mirrored = space.map.determinant() < 0;
    for (unsigned i = 0; i < from.mNumFaces; ++i) {
      const aiFace& face = from.mFaces[i];
      positions_.clear();
      vertices_.clear();
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        const unsigned at = face.mIndices[mirrored ? face.mNumIndices - 1 - k : k];
        positions_.push_back(position_of(from, at, space));
        vertices_.push_back({positions_.back(), normal_of(from, at, space)});
      }
      polygon(material);
    }
  }

  void polygon(MaterialIndex material) {
    const Vec3d plane = newell_normal(positions_).normalized();
    if (plane == Vec3d(0, 0, 0)) {
      ++skipped_;
      return;
    }
    count_polygons(1);
    const bool flat = std::all_of(vertices_.begin(), vertices_.end(), [&](const PatchVertex& v) {
      return v.normal == Vec3d(0, 0, 0) || v.normal.dot(plane) > kSameDirection;
    });
    if (flat) {
      add_polygon(scene_, positions_, material);
    } else {
      add_patch(scene_, vertices_, material);
    }
  }

  void count_polygons(std::size_t more) const {
    if (scene_.primitive_count() + more > kMaxPolygons) reject("it has more than 20 million polygons");
  }

  // Triangles that share their corners, which have a place in the texture. Assimp's second coordinate runs
  // upwards.
  void textured_mesh(const aiMesh& from, const Space& space, MaterialIndex material) {
    TriangleMesh mesh;
    mesh.material = material;
    for (unsigned i = 0; i < from.mNumVertices; ++i) {
      mesh.positions.push_back(position_of(from, i, space));
      if (from.mNormals != nullptr) mesh.normals.push_back(normal_of(from, i, space));
      const Vec3d place = to_vector(from.mTextureCoords[0][i]);
      mesh.texture_points.push_back(is_in_range(place) ? Vec2d(place.x, 1 - place.y) : Vec2d(0, 0));
    }
    const bool mirrored = space.map.determinant() < 0;
    std::vector<TriangleCorners> triangles;
    for (unsigned i = 0; i < from.mNumFaces; ++i) {
      const aiFace& face = from.mFaces[i];
      positions_.clear();
      for (unsigned k = 0; k < face.mNumIndices; ++k) positions_.push_back(mesh.positions[face.mIndices[k]]);
      const std::vector<TriangleIndices> cut = triangulate(positions_);
      skipped_ += cut.empty();
      for (const TriangleIndices& t : cut) {
        std::array<std::uint32_t, 3> at = {face.mIndices[t[0]], face.mIndices[t[1]], face.mIndices[t[2]]};
        if (mirrored) std::swap(at[1], at[2]);
        triangles.push_back({.position = at, .normal = at, .texture_point = at});
      }
    }
    count_polygons(triangles.size());
    if (!triangles.empty()) add_mesh(scene_, std::move(mesh), triangles);
  }

  // Takes the first camera as the view. The angle of modelling programs spans the picture, that of NFF the
  // centres of its rows.
  void camera(const aiNode& node, const Space& space) {
    for (unsigned i = 0; i < from_.mNumCameras && !scene_.view; ++i) {
      const aiCamera& from = *from_.mCameras[i];
      if (std::string_view(from.mName.C_Str()) != node.mName.C_Str()) continue;
      View view;
      const double aspect = from.mAspect > 0 ? from.mAspect : 1;
      view.width = static_cast<int>(std::lround(std::clamp(view.height * aspect, 1.0, 32768.0)));
      const double rows = view.height;
      view.angle_degrees =
          2 * std::atan(half_height(from, aspect) * (rows - 1) / rows) * (180 / std::numbers::pi);
      if (std::isfinite(from.mClipPlaneNear)) view.hither = std::max(from.mClipPlaneNear, 0.F);
      from_camera_ = &from;
      aim(view, space.map);
      if (!is_usable(view)) {
        notes_.push_back("the camera '" + printable(from.mName.C_Str()) + "' has no perspective: left out");
        continue;
      }
      camera_ = space;
      scene_.view = view;
    }
  }

  // Returns half the picture's height at a distance of 1.
  double half_height(const aiCamera& from, double aspect) const {
    if (gltf_) {
      const auto found = gltf_->camera_angles.find(from.mName.C_Str());
      if (found != gltf_->camera_angles.end()) return std::tan(0.5 * found->second);
    }
    return std::tan(0.5 * from.mHorizontalFOV) / aspect;
  }

  static bool is_usable(const View& view) {
    return view.angle_degrees > 0 && view.angle_degrees < 180 &&
           camera_defect(view.from, view.at, view.up).empty();
  }

  // `map`: from the camera's node to the world.
  void aim(View& view, const Affine& map) const {
    // One of glTF stands in its node's origin; versions of Assimp differ in what they say.
    view.from = gltf_ ? map.origin : map.point(to_vector(from_camera_->mPosition));
    view.at = view.from + map.vector(to_vector(from_camera_->mLookAt)).normalized();
    view.up = map.vector(to_vector(from_camera_->mUp)).normalized();
  }

  // Gives the camera a track in the world where its node moves.
  void move_camera() {
    if (camera_.node == 0) return;
    const auto view_at = [&](double time) {
      View view = *scene_.view;
      aim(view, placements_at(scene_.movement, time)[camera_.node].to_parent * camera_.map);
      return view;
    };
    const auto values_at = [&](double time) {
      const View view = view_at(time);
      const Vec3d back = view.from - view.at;
      const Vec3d right = view.up.cross(back).normalized();
      const Affine turn{right, back.cross(right).normalized(), back.normalized(), {0, 0, 0}};
      return TrackValues{.rotation = turn, .translation = view.from};
    };
    std::vector<double> times;
    for (NodeIndex n = camera_.node; n != 0; n = scene_.movement.nodes[n].parent) {
      const auto track = scene_.movement.tracks.find(scene_.movement.nodes[n].track);
      if (track == scene_.movement.tracks.end()) continue;
      const std::vector<double> own = key_times(track->second);
      times.insert(times.end(), own.begin(), own.end());
    }
    if (times.empty()) times.push_back(0);
    MotionTrack track = straight_track(straight_times(std::move(times), values_at), values_at);
    track.scale.clear();  // means nothing
    scene_.view = view_at(start_time(scene_.movement));
    scene_.movement.tracks[kCameraTrack] = std::move(track);
  }

  // A file may move nodes that hold nothing but a camera, or that it does not have.
  void drop_unused_tracks() {
    std::set<std::string> used = {kCameraTrack};
    for (const SceneNode& node : scene_.movement.nodes) used.insert(node.track);
    std::erase_if(scene_.movement.tracks, [&](const auto& track) { return !used.contains(track.first); });
    if (scene_.movement.tracks.empty()) scene_.movement.times.reset();
  }

  void lights(const aiNode& node, const Space& space) {
    for (unsigned i = 0; i < from_.mNumLights; ++i) {
      const aiLight& from = *from_.mLights[i];
      if (std::string_view(from.mName.C_Str()) != node.mName.C_Str()) continue;
      if (from.mType != aiLightSource_POINT && from.mType != aiLightSource_SPOT) {
        notes_.push_back(std::string("the light '") + from.mName.C_Str() +
                         "' is neither a point nor a spot: left out");
        continue;
      }
      if (!is_in_range(space.map.point(to_vector(from.mPosition))))
        reject("a light's place is not finite, or beyond 1e100");
      scene_.lights.push_back(
          {space.map.point(to_vector(from.mPosition)), light_color(from.mColorDiffuse), {}});
      scene_.light_nodes.push_back({.node = space.node});
    }
  }

  static constexpr const char* kNodeCalledCamera = "camera_node";  // "camera" moves the view

  const aiScene& from_;
  std::optional<GltfFacts> gltf_;
  MeshTextures textures_;
  SceneDescription scene_;
  std::vector<std::string> notes_;
  MaterialTable table_;
  std::size_t skipped_ = 0, skins_ = 0;
  std::set<std::string> names_;  // of nodes
  std::size_t namesakes_ = 0;
  int depth_ = 0;
  const aiCamera* from_camera_ = nullptr;  // that the view is taken from
  Space camera_;
  std::vector<Vec3d> positions_;  // of the polygon at hand
  std::vector<PatchVertex> vertices_;
};

void require_readable(const std::string& path) {
  std::string defect = defect_of_file(path);
  if (defect.empty() && !std::ifstream(path)) defect = std::generic_category().message(errno);
  if (!defect.empty()) throw InputError("cannot read '" + path + "': " + defect);
}

// Assimp makes a message of every exception.
void rethrow_lack_of_memory(const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (...) {
  }
}

// Finds a better reason than Assimp's why a file cannot be read.
struct Unreadable {
  const std::string& path;
  GltfFacts gltf;
  const std::map<std::string, std::string>& unread;

  [[noreturn]] void reject(const std::string& otherwise) const {
    if (!unread.empty()) {
      const auto& [name, reason] = *unread.begin();
      fail("it needs '" + printable(name) + "': " + reason);
    }
    if (gltf.broken_at) fail_at(*gltf.broken_at);
    if (!gltf.likely_cause.empty()) fail(gltf.likely_cause);
    if (is_utf16()) fail("it is text in UTF-16, which cannot be read; save it as UTF-8");
    fail(otherwise.empty() ? "Assimp cannot read it" : otherwise);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const { throw InputError(path + ": error: " + problem); }

  [[noreturn]] void fail_at(std::size_t byte) const {
    const std::string text = read_text(path, kMaxBytes);
    Diagnostics problem;
    problem.error(LineCursor(text).at(text.data() + std::min(byte, text.size())), gltf.likely_cause);
    std::string report = report_of(problem, path, text);
    report.pop_back();  // the last line end
    throw InputError(report);
  }

  // By its mark at the beginning, or the half of its first letter that is 0.
  bool is_utf16() const {
    char head[2] = {'?', '?'};
    std::ifstream(path, std::ios::binary).read(head, sizeof head);
    const std::string_view first(head, sizeof head);
    return first == "\xff\xfe" || first == "\xfe\xff" || ((head[0] == 0) != (head[1] == 0));
  }
};

}  // namespace

bool is_mesh_extension(const std::string& extension) {
  return extension != ".nff" && extension.size() > 1 && Assimp::Importer().IsExtensionSupported(extension);
}

ReadMesh read_mesh(const std::string& path, std::uint64_t max_memory) {
  require_readable(path);
  std::optional<GltfFacts> gltf;
  if (extension_of(path) == ".glb" || extension_of(path) == ".gltf") {
    gltf = gltf_facts(read_text(path, kMaxBytes));
    if (!gltf->problem.empty()) throw InputError(path + ": error: " + gltf->problem);
  }
  Assimp::Importer importer;
  auto* const files = new ModelFiles(path);
  importer.SetIOHandler(files);  // which takes it
  const aiScene* scene = importer.ReadFile(path, 0);
  if (const std::exception_ptr thrown = importer.GetException()) rethrow_lack_of_memory(thrown);
  const Unreadable unreadable{path, gltf.value_or(GltfFacts()), files->unread()};
  if (scene == nullptr || scene->mRootNode == nullptr) unreadable.reject(importer.GetErrorString());
  ReadMesh mesh = SceneReader(*scene, path, std::move(gltf), max_memory).run();
  if (mesh.scene.primitive_count() == 0) unreadable.reject("there is no polygon in it");
  for (const auto& [name, reason] : files->unread())
    mesh.notes.push_back((name.ends_with(".mtl") ? "the material library '" : "the file '") +
                         printable(name) + "' is left out: " + reason);
  mesh.files.insert(mesh.files.end(), files->opened().begin(), files->opened().end());
  return mesh;
}

}  // namespace pprt
