#include "convert/mesh/mesh_reader.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/camera.h>
#include <assimp/light.h>
#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <assimp/texture.h>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <new>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/diagnostics.h"
#include "base/printable.h"
#include "convert/gltf/gltf_document.h"
#include "convert/gltf/gltf_reader.h"
#include "convert/mesh/assimp_values.h"
#include "convert/mesh/collada_cameras.h"
#include "convert/mesh/mesh_animation.h"
#include "convert/mesh/mesh_materials.h"
#include "convert/mesh/model_files.h"
#include "convert/model/model_builder.h"
#include "convert/model/model_folder.h"
#include "convert/model/model_losses.h"
#include "convert/model/model_textures.h"
#include "convert/model/vertex_colours.h"
#include "convert/names/extension.h"
#include "image/image_io.h"
#include "parser/text/text_input.h"

namespace pprt {
namespace {

constexpr std::size_t kMaxBytes = std::numeric_limits<std::uint32_t>::max();  // of a .glb or a .gltf

// Scales the brightest channel to 1, as the intensity of lights follows from a rule of NFF.
std::optional<Rgb> light_color(const aiColor3D& c) {
  const double largest = std::max({c.r, c.g, c.b});
  if (!(largest > 0) || !std::isfinite(largest)) return std::nullopt;
  const auto share = [&](double v) { return std::isfinite(v) ? std::clamp(v / largest, 0.0, 1.0) : 0; };
  const Rgb color(share(c.r), share(c.g), share(c.b));
  if (color == Rgb(1, 1, 1)) return std::nullopt;
  return color;
}

// Whether a file says so. Where it says nothing Assimp has values of its own.
bool weakens(const aiLight& light) {
  const float linear = light.mAttenuationLinear, quadratic = light.mAttenuationQuadratic;
  const bool is_told = light.mAttenuationConstant != 0 || linear != 1 || quadratic != 0;
  return is_told && (linear > 0 || quadratic > 0);
}

// Returns a picture within the file: another file's bytes, or texels where there is a height.
Image embedded(const aiTexture& from, std::uint64_t max_memory) {
  if (from.mHeight == 0)
    return decode_image({reinterpret_cast<const char*>(from.pcData), from.mWidth}, max_memory);
  Image image(static_cast<int>(from.mWidth), static_cast<int>(from.mHeight));
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const aiTexel& texel = from.pcData[i];
    image.pixels[i] = Color(texel.r, texel.g, texel.b) / 255.F;
  }
  return image;
}

// What Assimp has read, as a scene.
class SceneReader {
 public:
  // `max_memory`: bytes that its pictures may take.
  SceneReader(const aiScene& from, const std::string& path, std::uint64_t max_memory)
      : from_(from), builder_(path), folder_(path), textures_(max_memory) {
    if (extension_of(path) == ".dae") told_cameras_ = collada_cameras(read_text(path, kMaxBytes));
  }

  ReadMesh run(const std::string& animation) {
    read_movement(animation);
    node(*from_.mRootNode, {});
    if (cameras_ > 1) losses_.add(ModelLoss::kCameras, cameras_ - 1);
    tell_of_pictures();
    losses_.tell(builder_.notes());
    return std::move(builder_).finish(std::move(files_));
  }

 private:
  void read_movement(const std::string& name) {
    try {
      ModelAnimation animation = read_animation(from_, name);
      builder_.scene().movement.times = animation.times;
      builder_.notes() = std::move(animation.notes);
      for (auto& [node, track] : animation.tracks)
        builder_.scene().movement.tracks[ModelBuilder::track_name(node)] = std::move(track);
    } catch (const std::runtime_error& e) {
      builder_.reject(e.what());
    }
  }

  void node(const aiNode& from, const ModelSpace& parent) {
    if (++depth_ > kMaxNodeDepth)
      builder_.reject("its nodes lie more than " + std::to_string(kMaxNodeDepth) + " deep in each other");
    if (!names_.insert(from.mName.C_Str()).second) losses_.add(ModelLoss::kNamesakes);
    const ModelSpace space = builder_.space_of(parent, to_affine(from.mTransformation),
                                               ModelBuilder::track_name(from.mName.C_Str()));
    for (unsigned i = 0; i < from.mNumMeshes; ++i) {
      if (from.mMeshes[i] >= from_.mNumMeshes) builder_.reject("a node names a mesh that is not there");
      mesh(*from_.mMeshes[from.mMeshes[i]], space);
    }
    camera(from, space);
    lights(from, space);
    for (unsigned i = 0; i < from.mNumChildren; ++i) node(*from.mChildren[i], space);
    --depth_;
  }

  void mesh(const aiMesh& from, const ModelSpace& space) {
    if (from.mMaterialIndex >= from_.mNumMaterials)
      builder_.reject("a mesh names a material that is not there");
    if (from.mNumBones > 0) losses_.add(ModelLoss::kSkin);
    if (from.mNumAnimMeshes > 0) losses_.add(ModelLoss::kShapes);
    materials_.insert(from.mMaterialIndex);
    const aiMaterial& material = *from_.mMaterials[from.mMaterialIndex];
    Material own = to_material(material);
    const bool has_places = from.mTextureCoords[0] != nullptr;
    if (const std::string path = picture_path(material); !path.empty() && has_places)
      own.texture = texture(path);
    if (const std::string path = emission_path(material); !path.empty() && has_places) {
      own.emission_texture = texture(path);
      if (own.emission_texture && own.emission == Rgb(0, 0, 0)) own.emission = Rgb(1, 1, 1);
    }
    ModelMesh mesh;
    for (unsigned i = 0; i < from.mNumVertices; ++i) {
      mesh.positions.push_back(to_vector(from.mVertices[i]));
      if (from.mNormals != nullptr) mesh.normals.push_back(to_vector(from.mNormals[i]));
      // Assimp's second coordinate runs upwards.
      if (own.has_picture())
        mesh.texture_points.emplace_back(from.mTextureCoords[0][i].x, 1 - from.mTextureCoords[0][i].y);
    }
    for (const aiFace& face : std::span(from.mFaces, from.mNumFaces)) {
      mesh.corners.insert(mesh.corners.end(), face.mIndices, face.mIndices + face.mNumIndices);
      mesh.ends.push_back(mesh.corners.size());
    }
    if (const std::vector<Rgb> colors = vertex_colors(from); !colors.empty()) color(mesh, colors, own);
    builder_.add(mesh, own, space);
  }

  // Colours at the vertices become a texture, or their mean where there is one.
  void color(ModelMesh& mesh, const std::vector<Rgb>& colors, Material& material) {
    std::optional<Texture> painted;
    if (!material.has_picture()) painted = paint(mesh, colors);
    if (painted) {
      std::vector<Texture>& textures = builder_.scene().textures;
      textures.push_back(std::move(*painted));
      material.texture = static_cast<TextureIndex>(textures.size() - 1);
    } else {
      material.color *=
          std::accumulate(colors.begin(), colors.end(), Rgb(0, 0, 0)) / static_cast<double>(colors.size());
      losses_.add(ModelLoss::kVertexColours);
    }
  }

  void tell_of_pictures() {
    for (const unsigned i : materials_) {
      const aiMaterial& material = *from_.mMaterials[i];
      if (has_normal_map(material)) losses_.add(ModelLoss::kNormalMap);
      if (has_other_pictures(material)) losses_.add(ModelLoss::kOtherPictures);
    }
  }

  std::optional<TextureIndex> texture(const std::string& path) {
    const auto picture = [&](std::uint64_t max_memory) {
      if (const aiTexture* inside = from_.GetEmbeddedTexture(path.c_str()))
        return embedded(*inside, max_memory);
      files_.push_back(folder_.find(path).string());
      return read_image(files_.back(), max_memory);
    };
    const std::string name =
        path.starts_with('*') ? "texture" + path.substr(1) : std::filesystem::path(path).filename().string();
    return textures_.intern(path, name, picture, builder_.scene().textures, builder_.notes());
  }

  void camera(const aiNode& node, const ModelSpace& space) {
    for (unsigned i = 0; i < from_.mNumCameras; ++i) {
      const aiCamera& from = *from_.mCameras[i];
      if (std::string_view(from.mName.C_Str()) != node.mName.C_Str()) continue;
      ModelCamera camera{.name = from.mName.C_Str(),
                         .half_height = 0,
                         .aspect = from.mAspect > 0 ? from.mAspect : 1,
                         .near = from.mClipPlaneNear,
                         .from = to_vector(from.mPosition),
                         .direction = to_vector(from.mLookAt),
                         .up = to_vector(from.mUp)};
      camera.half_height = std::tan(0.5 * from.mHorizontalFOV) / camera.aspect;
      correct(camera);
      ++cameras_;
      builder_.add(camera, space);
    }
  }

  void correct(ModelCamera& camera) const {
    const auto told = told_cameras_.find(camera.name);
    if (told == told_cameras_.end() || !told->second.half_height()) return;
    camera.half_height = *told->second.half_height();
    camera.aspect = told->second.ratio();
    camera.near = told->second.near.value_or(camera.near);
  }

  void lights(const aiNode& node, const ModelSpace& space) {
    for (unsigned i = 0; i < from_.mNumLights; ++i) {
      const aiLight& from = *from_.mLights[i];
      if (std::string_view(from.mName.C_Str()) != node.mName.C_Str()) continue;
      Light light{.position = to_vector(from.mPosition), .color = light_color(from.mColorDiffuse)};
      light.is_sun = from.mType == aiLightSource_DIRECTIONAL;
      if (light.is_sun) light.position = -to_vector(from.mDirection);
      if (light.is_sun || from.mType == aiLightSource_POINT || from.mType == aiLightSource_SPOT) {
        if (from.mType == aiLightSource_SPOT) losses_.add(ModelLoss::kSpot);
        if (!light.is_sun && weakens(from)) losses_.add(ModelLoss::kDistance);
        builder_.add(light, space);
      } else {
        builder_.notes().push_back("the light '" + printable(from.mName.C_Str()) +
                                   "' is neither a point, nor a spot, nor a sun: left out");
      }
    }
  }

  const aiScene& from_;
  ModelBuilder builder_;
  ModelFolder folder_;
  ModelTextures textures_;
  std::map<std::string, ColladaCamera, std::less<>> told_cameras_;  // by what the file itself tells
  std::vector<std::string> files_;
  ModelLosses losses_;
  std::set<std::string> names_;   // of nodes
  std::set<unsigned> materials_;  // of meshes
  std::size_t cameras_ = 0;
  int depth_ = 0;
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

namespace {

ReadMesh read_gltf_file(const std::string& path, const MeshOptions& options) {
  std::string bytes = read_text(path, kMaxBytes);
  const GltfFacts facts = gltf_facts(bytes);
  if (!facts.problem.empty()) throw InputError(path + ": error: " + facts.problem);
  GltfFiles files;
  const auto reason = [&](const std::string& otherwise) {
    return Unreadable{path, facts, files.unread}.reject(otherwise);
  };
  if (facts.broken_at || !facts.likely_cause.empty()) reason("");
  try {
    ReadMesh mesh = read_gltf(path, std::move(bytes), facts, options.animation, options.max_memory, files);
    if (mesh.scene.primitive_count() == 0) reason("there is no polygon in it");
    return mesh;
  } catch (const InputError&) {
    if (!files.unread.empty()) reason("");
    throw;
  }
}

ReadMesh read_by_assimp(const std::string& path, const MeshOptions& options) {
  Assimp::Importer importer;
  auto* const files = new ModelFiles(path);
  importer.SetIOHandler(files);  // which takes it
  const aiScene* scene = importer.ReadFile(path, 0);
  if (const std::exception_ptr thrown = importer.GetException()) rethrow_lack_of_memory(thrown);
  const Unreadable unreadable{path, {}, files->unread()};
  if (scene == nullptr || scene->mRootNode == nullptr) unreadable.reject(importer.GetErrorString());
  ReadMesh mesh = SceneReader(*scene, path, options.max_memory).run(options.animation);
  if (mesh.scene.primitive_count() == 0) unreadable.reject("there is no polygon in it");
  for (const auto& [name, reason] : files->unread())
    mesh.notes.push_back((name.ends_with(".mtl") ? "the material library '" : "the file '") +
                         printable(name) + "' is left out: " + reason);
  mesh.files.insert(mesh.files.end(), files->opened().begin(), files->opened().end());
  return mesh;
}

}  // namespace

ReadMesh read_mesh(const std::string& path, const MeshOptions& options) {
  require_readable(path);
  const std::string extension = extension_of(path);
  return extension == ".glb" || extension == ".gltf" ? read_gltf_file(path, options)
                                                     : read_by_assimp(path, options);
}

}  // namespace pprt
