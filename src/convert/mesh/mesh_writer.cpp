#include "convert/mesh/mesh_writer.h"

#include <assimp/anim.h>
#include <assimp/camera.h>
#include <assimp/config.h>
#include <assimp/light.h>
#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <assimp/texture.h>
#include <algorithm>
#include <array>
#include <assimp/Exporter.hpp>
#include <cmath>
#include <cstring>
#include <deque>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>

#include "base/diagnostics.h"
#include "convert/gltf/gltf_document.h"
#include "convert/mesh/assimp_values.h"
#include "convert/mesh/mesh_animation.h"
#include "convert/mesh/mesh_materials.h"
#include "convert/names/picture_names.h"
#include "convert/pov/pov_material.h"
#include "convert/surfaces/material_meshes.h"
#include "image/image_io.h"
#include "scene/description/view_frame.h"
#include "scene/movement/straight_track.h"

namespace pprt {
namespace {

struct Format {
  std::string_view extension;
  const char* assimp_id;
  bool is_gltf = false;  // has physically based materials, movement, and pictures within the file
  bool has_textures = true;
};

// Binary where there is a choice: a tenth of the time, a third of the size.
constexpr std::array kFormats = {Format{.extension = ".obj", .assimp_id = "obj"},
                                 Format{.extension = ".ply", .assimp_id = "plyb", .has_textures = false},
                                 Format{.extension = ".stl", .assimp_id = "stlb", .has_textures = false},
                                 Format{.extension = ".glb", .assimp_id = "glb2", .is_gltf = true},
                                 Format{.extension = ".gltf", .assimp_id = "gltf2", .is_gltf = true},
                                 Format{.extension = ".dae", .assimp_id = "collada"}};

const Format& format_of(std::string_view extension) {
  const auto* format = std::find_if(kFormats.begin(), kFormats.end(),
                                    [&](const Format& f) { return f.extension == extension; });
  if (format == kFormats.end()) throw std::invalid_argument("no mesh format: " + std::string(extension));
  return *format;
}

std::unique_ptr<aiMesh> to_mesh(const MaterialMesh& from, unsigned material) {
  auto mesh = std::make_unique<aiMesh>();
  mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  mesh->mMaterialIndex = material;
  mesh->mNumVertices = static_cast<unsigned>(from.vertices.size());
  mesh->mVertices = new aiVector3D[from.vertices.size()];
  mesh->mNormals = new aiVector3D[from.vertices.size()];
  for (std::size_t i = 0; i < from.vertices.size(); ++i) {
    mesh->mVertices[i] = to_assimp(from.vertices[i].position);
    mesh->mNormals[i] = to_assimp(from.vertices[i].normal);
  }
  if (from.texture_points.size() == from.vertices.size()) {  // Assimp's second coordinate runs upwards
    mesh->mNumUVComponents[0] = 2;
    mesh->mTextureCoords[0] = new aiVector3D[from.vertices.size()];
    for (std::size_t i = 0; i < from.vertices.size(); ++i)
      mesh->mTextureCoords[0][i] =
          to_assimp(Vec3d(from.texture_points[i].x, 1 - from.texture_points[i].y, 0));
  }
  mesh->mNumFaces = static_cast<unsigned>(from.triangles.size());
  mesh->mFaces = new aiFace[from.triangles.size()];
  for (std::size_t i = 0; i < from.triangles.size(); ++i) {
    mesh->mFaces[i].mNumIndices = 3;
    mesh->mFaces[i].mIndices = new unsigned[3];
    std::copy_n(from.triangles[i].begin(), 3, mesh->mFaces[i].mIndices);
  }
  return mesh;
}

// Returns the shortest side of a mesh's box; of what is flat, 1.
double thickness(const MaterialMesh& mesh) {
  Box3d box;
  for (const PatchVertex& v : mesh.vertices) box.extendBy(v.position);
  const Vec3d size = box.size();
  const double shortest = std::min({size.x, size.y, size.z});
  return shortest > 0 ? shortest : 1;
}

// Fills Assimp's scene, which takes what it is given.
class AssimpScene {
 public:
  AssimpScene(const SceneDescription& scene, const Format& format, const std::vector<std::string>& pictures)
      : scene_(scene),
        format_(format),
        pictures_(pictures),
        materials_(scene.materials.size()),
        start_(start_of_keys(scene.movement)) {}

  std::unique_ptr<aiScene> run(const MaterialMeshes& meshes) {
    to_->mRootNode = new aiNode("scene");
    nodes_.push_back({to_->mRootNode, {}, {}});
    add_nodes();
    add_meshes(meshes);
    add_camera();
    add_lights();
    add_animation();
    for (Node& node : nodes_) {
      own(node.children, node.to->mChildren, node.to->mNumChildren);
      own(node.meshes, node.to->mMeshes, node.to->mNumMeshes);
    }
    own(meshes_, to_->mMeshes, to_->mNumMeshes);
    own(used_materials_, to_->mMaterials, to_->mNumMaterials);
    if (format_.is_gltf) add_pictures();
    return std::move(to_);
  }

 private:
  struct Node {
    aiNode* to;
    std::vector<aiNode*> children;
    std::vector<unsigned> meshes;
  };

  template <typename T>
  static void own(const std::vector<T>& from, T*& to, unsigned& count) {
    if (from.empty()) return;
    to = new T[from.size()];
    count = static_cast<unsigned>(from.size());
    std::copy(from.begin(), from.end(), to);
  }

  // `parent`: in nodes_.
  Node& add_node(NodeIndex parent, const std::string& name, const Affine& map) {
    auto* node = new aiNode(name);
    node->mParent = nodes_[parent].to;
    node->mTransformation = to_assimp(map);
    nodes_[parent].children.push_back(node);
    return nodes_.emplace_back(Node{node, {}, {}});
  }

  // A node has the name of its movement, where no other has it.
  void add_nodes() {
    std::set<std::string> names = {"scene", "camera"};
    for (std::size_t i = 0; i < scene_.lights.size(); ++i) names.insert(light_name(i));
    for (std::size_t i = 1; i < scene_.movement.nodes.size(); ++i) {
      const SceneNode& from = scene_.movement.nodes[i];
      const auto track = scene_.movement.tracks.find(from.track);
      const bool moves = track != scene_.movement.tracks.end();
      const std::string first = moves ? from.track : "node";
      std::string name = first;
      for (int n = 2; !names.insert(name).second; ++n) name = first + "_" + std::to_string(n);
      add_node(from.parent, name,
               moves ? placement_at(track->second, start_time(scene_.movement)).to_parent : from.to_parent);
      if (moves) add_movement(track->second, name);
    }
  }

  void add_movement(const MotionTrack& track, const std::string& node) {
    add_movement(
        track, [&](double time) { return values_at(track, time); }, node);
  }

  void add_movement(const MotionTrack& track, const std::function<TrackValues(double)>& values,
                    const std::string& node) {
    if (!format_.is_gltf) return;
    std::vector<double> times = key_times(track);
    if (times.empty()) times.push_back(start_);
    channels_.push_back(node_animation(std::move(times), values, node, start_).release());
  }

  void add_animation() {
    if (channels_.empty()) return;
    auto animation = std::make_unique<aiAnimation>();
    animation->mName = "movement";
    animation->mTicksPerSecond = 1;
    own(channels_, animation->mChannels, animation->mNumChannels);
    if (scene_.movement.times) animation->mDuration = scene_.movement.times->end - start_;
    own(std::vector<aiAnimation*>{animation.release()}, to_->mAnimations, to_->mNumAnimations);
  }

  // Returns the time that is 0 in the file, where no key may be earlier.
  static double start_of_keys(const Movement& movement) {
    double start = 0;
    for (const auto& [name, track] : movement.tracks) {
      for (const double time : key_times(track)) start = std::min(start, time);
    }
    return start;
  }

  void add_meshes(const MaterialMeshes& meshes) {
    for (const auto& [place, mesh] : meshes) {
      nodes_[place.first].meshes.push_back(static_cast<unsigned>(meshes_.size()));
      meshes_.push_back(to_mesh(mesh, material(place.second, mesh)).release());
    }
  }

  // Keeps only materials of some mesh: most formats drop the others.
  unsigned material(MaterialIndex index, const MaterialMesh& mesh) {
    std::optional<unsigned>& to = materials_[index];
    if (to) return *to;
    to = static_cast<unsigned>(used_materials_.size());
    const Material& from = scene_.materials[index];
    const MaterialPictures pictures{path_of(from.texture), path_of(from.emission_texture)};
    used_materials_.push_back(
        to_assimp(from, "material_" + std::to_string(index + 1), format_.is_gltf, pictures, thickness(mesh))
            .release());
    return *to;
  }

  std::string path_of(const std::optional<TextureIndex>& texture) const {
    if (!texture || !format_.has_textures) return {};
    return format_.is_gltf ? "*" + std::to_string(*texture) : pictures_[*texture];
  }

  void add_pictures() {
    std::vector<aiTexture*> textures;
    for (TextureIndex i = 0; i < scene_.textures.size(); ++i) {
      const std::string bytes = encode_png(picture_of(scene_, {.name = {}, .texture = i}));
      auto texture = std::make_unique<aiTexture>();
      texture->mFilename = pictures_[i];
      texture->mWidth = static_cast<unsigned>(bytes.size());
      std::strcpy(texture->achFormatHint, "png");
      texture->pcData = new aiTexel[(bytes.size() + sizeof(aiTexel) - 1) / sizeof(aiTexel)];
      std::memcpy(texture->pcData, bytes.data(), bytes.size());
      textures.push_back(texture.release());
    }
    own(textures, to_->mTextures, to_->mNumTextures);
  }

  // A camera that looks along its node's -z, as in most formats.
  void add_camera() {
    if (!scene_.view) return;
    const View& view = *scene_.view;
    const ViewFrame frame = view_frame(view, scene_.name);
    auto camera = std::make_unique<aiCamera>();
    camera->mName = "camera";
    camera->mLookAt = {0, 0, -1};
    camera->mUp = {0, 1, 0};
    camera->mAspect = static_cast<float>(view.width) / static_cast<float>(view.height);
    camera->mHorizontalFOV = static_cast<float>(2 * std::atan(0.5 * view.width * frame.slope_per_pixel));
    if (view.hither > 0) camera->mClipPlaneNear = static_cast<float>(view.hither);
    add_node(0, "camera", {frame.right, frame.up, -frame.forward, view.from});
    const auto track = scene_.movement.tracks.find(kCameraTrack);
    if (track != scene_.movement.tracks.end()) {
      const auto values = [&](double time) {
        const View at_time = *view_at(scene_, time);
        const ViewFrame axes = view_frame(at_time, scene_.name);
        return TrackValues{.rotation = {axes.right, axes.up, -axes.forward, {0, 0, 0}},
                           .translation = at_time.from};
      };
      add_movement(track->second, values, "camera");
    }
    own(std::vector<aiCamera*>{camera.release()}, to_->mCameras, to_->mNumCameras);
  }

  // Returns a turn of -z, along which nodes shine.
  static Affine looking_along(const Vec3d& direction) {
    const Vec3d back = -direction.normalized();
    const Vec3d aside = (std::abs(back.y) < 0.9 ? Vec3d(0, 1, 0) : Vec3d(1, 0, 0)).cross(back).normalized();
    return {aside, back.cross(aside), back, {0, 0, 0}};
  }

  void add_lights() {
    std::vector<aiLight*> lights;
    for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
      const Light& from = scene_.lights[i];
      auto light = std::make_unique<aiLight>();
      const std::string name = light_name(i);
      light->mName = name;
      light->mType = from.is_sun ? aiLightSource_DIRECTIONAL : aiLightSource_POINT;
      light->mDirection = {0, 0, -1};
      light->mColorDiffuse = light->mColorSpecular = to_color(from.color.value_or(Rgb(1, 1, 1)));
      light->mAttenuationConstant = 1;
      light->mAttenuationLinear = light->mAttenuationQuadratic = 0;
      const LightNode at = scene_.light_nodes.empty() ? LightNode() : scene_.light_nodes[i];
      add_node(at.node, name, from.is_sun ? looking_along(-from.position) : translation(from.position));
      const auto track = scene_.movement.tracks.find(at.track);
      if (track != scene_.movement.tracks.end()) add_movement(track->second, name);
      lights.push_back(light.release());
    }
    own(lights, to_->mLights, to_->mNumLights);
  }

  const SceneDescription& scene_;
  const Format& format_;
  const std::vector<std::string>& pictures_;
  std::unique_ptr<aiScene> to_ = std::make_unique<aiScene>();
  std::deque<Node> nodes_;  // those of the movement, then those of camera and lights
  std::vector<aiMesh*> meshes_;
  std::vector<std::optional<unsigned>> materials_;  // the place of each that is used
  std::vector<aiMaterial*> used_materials_;
  double start_;  // of the animation in the file
  std::vector<aiNodeAnim*> channels_;
};

}  // namespace

const std::vector<std::string>& mesh_output_extensions() {
  static const std::vector<std::string> kExtensions = [] {
    std::vector<std::string> names;
    names.reserve(std::size(kFormats));
    for (const Format& format : kFormats) names.emplace_back(format.extension);
    return names;
  }();
  return kExtensions;
}

bool keeps_movement(std::string_view extension) {
  return format_of(extension).is_gltf;
}

bool keeps_textures(std::string_view extension) {
  return format_of(extension).has_textures;
}

WrittenMesh write_mesh(const SceneDescription& scene, std::string_view extension, const std::string& stem,
                       const Fineness& fineness) {
  const Format& format = format_of(extension);
  check_triangle_count(scene, fineness);
  WrittenMesh result;
  const std::vector<std::string> pictures = picture_names(scene, format.is_gltf ? utf8(stem) : stem);
  std::unique_ptr<aiScene> assimp;
  {
    const MaterialMeshes meshes = material_meshes(scene, fineness, result.degenerate);
    for (const auto& [place, mesh] : meshes) result.triangles += mesh.triangles.size();
    if (result.triangles == 0)
      throw InputError(scene.name + ": error: no object of the scene has any extent");
    assimp = AssimpScene(scene, format, pictures).run(meshes);
  }
  Assimp::Exporter exporter;
  Assimp::ExportProperties properties;
  properties.SetPropertyString(AI_CONFIG_EXPORT_BLOB_NAME, format.is_gltf ? utf8(stem) : stem);
  const aiExportDataBlob* blob = exporter.ExportToBlob(assimp.get(), format.assimp_id, 0, &properties);
  if (blob == nullptr)
    throw std::runtime_error(std::string("cannot make a mesh file: ") + exporter.GetErrorString());
  for (; blob != nullptr;
       blob = blob->next) {  // the first is the named one, the others have names of their own
    result.files.push_back({result.files.empty() ? stem + std::string(extension) : blob->name.C_Str(),
                            std::string(static_cast<const char*>(blob->data), blob->size)});
  }
  if (format.has_textures && !format.is_gltf) {
    for (TextureIndex i = 0; i < scene.textures.size(); ++i)
      result.files.push_back({pictures[i], encode_png(picture_of(scene, {.name = {}, .texture = i}))});
  }
  if (format.is_gltf) add_camera_and_lights(result.files.front().bytes, scene);
  std::reverse(result.files.begin(), result.files.end());
  return result;
}

}  // namespace pprt
