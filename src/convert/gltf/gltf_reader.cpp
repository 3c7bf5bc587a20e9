#include "convert/gltf/gltf_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "base/diagnostics.h"
#include "base/printable.h"
#include "convert/gltf/gltf_animation.h"
#include "convert/gltf/gltf_lights.h"
#include "convert/gltf/gltf_materials.h"
#include "convert/gltf/gltf_mesh.h"
#include "convert/model/model_builder.h"
#include "convert/model/model_losses.h"

namespace pprt {
namespace {

// Extensions that are shown as well as they can be, or whose losses are counted.
constexpr std::array<std::string_view, 12> kKnownExtensions = {
    "FB_ngon_encoding",           "KHR_animation_pointer",
    "KHR_lights_punctual",        "KHR_materials_emissive_strength",
    "KHR_materials_ior",          "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_transmission", "KHR_materials_unlit",
    "KHR_materials_volume",       "KHR_mesh_quantization",
    "KHR_node_visibility",        "KHR_texture_transform"};

// Extensions without which there are no numbers.
constexpr std::array<std::string_view, 3> kPackings = {"KHR_draco_mesh_compression",
                                                       "EXT_meshopt_compression", "KHR_meshopt_compression"};

class GltfReader {
 public:
  GltfReader(const tinygltf::Model& model, const std::string& path, const ModelFolder& folder,
             GltfFiles& files, std::uint64_t max_memory)
      : model_(model),
        files_(files),
        builder_(path),
        materials_(model, folder, files, losses_, builder_, max_memory) {}

  ReadMesh run(const GltfFacts& facts, const std::string& animation) {
    tell_extensions();
    name_nodes();
    ModelAnimation moved = gltf_animation(model_, facts, animation, tracks_, losses_);
    builder_.scene().movement.times = moved.times;
    builder_.notes().insert(builder_.notes().end(), moved.notes.begin(), moved.notes.end());
    for (auto& [name, track] : moved.tracks) builder_.scene().movement.tracks[name] = std::move(track);
    for (const int root : roots()) node(root, {}, true);
    builder_.scene().ambient = Rgb(1, 1, 1);
    add_gltf_lights(model_, lights_, losses_, builder_);
    losses_.tell(builder_.notes());
    return std::move(builder_).finish(files_.opened);
  }

 private:
  void tell_extensions() {
    for (const std::string& name : model_.extensionsRequired) {
      if (std::find(kPackings.begin(), kPackings.end(), name) != kPackings.end())
        throw std::runtime_error("its numbers are packed (" + name +
                                 "), which cannot be read; export it without");
    }
    for (const std::string& name : model_.extensionsUsed) {
      const bool is_known =
          std::find(kKnownExtensions.begin(), kKnownExtensions.end(), name) != kKnownExtensions.end();
      if (!is_known)
        builder_.notes().push_back("the extension " + printable(name) +
                                   " is not known: what it adds is left out");
    }
  }

  // Gives each node a name of its own.
  void name_nodes() {
    std::set<std::string> taken = {kCameraTrack};
    std::map<std::string, std::size_t> repeats;  // thousands of nodes may have one name
    for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
      const std::string& own = model_.nodes[i].name;
      const std::string first =
          ModelBuilder::track_name(own.empty() ? "nodes[" + std::to_string(i) + "]" : own);
      std::string name = first;
      while (!taken.insert(name).second) name = first + "_" + std::to_string(++repeats[first] + 1);
      tracks_.push_back(std::move(name));
    }
  }

  std::vector<int> roots() {
    if (model_.scenes.size() > 1) losses_.add(ModelLoss::kScenes, model_.scenes.size() - 1);
    if (!model_.scenes.empty())
      return element(model_.scenes, std::max(model_.defaultScene, 0), "a scene").nodes;
    std::set<int> children;
    for (const tinygltf::Node& node : model_.nodes)
      children.insert(node.children.begin(), node.children.end());
    std::vector<int> result;
    for (int i = 0; i < static_cast<int>(model_.nodes.size()); ++i) {
      if (!children.contains(i)) result.push_back(i);
    }
    return result;
  }

  static Affine transform_of(const tinygltf::Node& from) {
    const std::vector<double>& m = from.matrix;
    if (m.size() == 16)
      return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
    const TrackValues values = gltf_placement(from);
    return translation(values.translation) * values.rotation * scaling(values.scale);
  }

  bool is_shown(const tinygltf::Node& from, const std::string& track) {
    const auto found = from.extensions.find("KHR_node_visibility");
    if (found == from.extensions.end() || !found->second.Has("visible")) return true;
    const tinygltf::Value& value = found->second.Get("visible");
    if (!value.IsBool() || value.Get<bool>()) return true;
    const auto& tracks = builder_.scene().movement.tracks;
    const auto moved = tracks.find(track);
    return moved != tracks.end() && !moved->second.visibility.empty();
  }

  void node(int index, const ModelSpace& parent, bool shown) {
    if (++depth_ > kMaxNodeDepth)
      throw std::runtime_error("its nodes lie more than " + std::to_string(kMaxNodeDepth) +
                               " deep in each other");
    const tinygltf::Node& from = element(model_.nodes, index, "a node");
    const std::string& track = tracks_[static_cast<std::size_t>(index)];
    const ModelSpace space = builder_.space_of(parent, transform_of(from), track);
    shown = shown && is_shown(from, track);
    if (shown && from.mesh >= 0) mesh(from.mesh, from.skin >= 0, space);
    if (from.camera >= 0) camera(element(model_.cameras, from.camera, "a camera"), track, space);
    const double light = number_in(from.extensions, "KHR_lights_punctual", "light", -1);
    if (light >= 0) lights_.push_back({static_cast<int>(std::min(light, 1e9)), space});
    for (const int child : from.children) node(child, space, shown);
    --depth_;
  }

  void mesh(int index, bool has_skin, const ModelSpace& space) {
    const tinygltf::Mesh& from = element(model_.meshes, index, "a mesh");
    if (has_skin) losses_.add(ModelLoss::kSkin);
    bool has_shapes = false;
    for (const tinygltf::Primitive& primitive : from.primitives) {
      has_shapes = has_shapes || !primitive.targets.empty();
      add_gltf_primitive(model_, primitive, materials_, losses_, builder_, space);
    }
    if (has_shapes) losses_.add(ModelLoss::kShapes);
    if (seen_meshes_.insert(index).second && is_open_behind(model_, from, materials_))
      losses_.add(ModelLoss::kOneSide);
  }

  void camera(const tinygltf::Camera& from, const std::string& name, const ModelSpace& space) {
    ModelCamera camera{.name = name};
    if (from.type == "perspective") {
      camera.half_height = std::tan(from.perspective.yfov / 2);
      if (from.perspective.aspectRatio > 0) camera.aspect = from.perspective.aspectRatio;
      camera.near = from.perspective.znear;
    }
    if (builder_.scene().view) losses_.add(ModelLoss::kCameras);  // the first that can be shown is
    builder_.add(camera, space);
  }

  const tinygltf::Model& model_;
  GltfFiles& files_;
  std::set<int> seen_meshes_;
  ModelLosses losses_;
  ModelBuilder builder_;
  GltfMaterials materials_;
  std::vector<std::string> tracks_;  // the name of each node's track
  std::vector<PlacedGltfLight> lights_;
  int depth_ = 0;
};

}  // namespace

ReadMesh read_gltf(const std::string& path, std::string bytes, const GltfFacts& facts,
                   const std::string& animation, std::uint64_t max_memory, GltfFiles& files) {
  try {
    const ModelFolder folder(path);
    const tinygltf::Model model = load_gltf(std::move(bytes), facts, folder, files);
    return GltfReader(model, path, folder, files, max_memory).run(facts, animation);
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& e) {
    throw InputError(path + ": error: " + e.what());
  }
}

}  // namespace pprt
