#include "convert/mesh_reader.h"

#include <Imath/ImathMatrix.h>

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
#include <fstream>
#include <numbers>
#include <optional>
#include <string_view>
#include <system_error>

#include "base/diagnostics.h"
#include "scene/triangulate.h"

namespace pprt {
namespace {

constexpr double kDefaultGlassIndex = 1.5;  // of transparent materials that name none
constexpr std::size_t kMaxPolygons = 20'000'000;

// Cosine from which on a vertex' normal is taken for the polygon's: half a degree.
constexpr double kSameDirection = 0.99996;

Vec3d to_vector(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}

// Imath's vectors are rows, Assimp's columns.
Imath::M44d to_matrix(const aiMatrix4x4& m) {
  return {m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2, m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4};
}

Vec3d direction_by(const Imath::M44d& transform, const Vec3d& v) {
  Vec3d result;
  transform.multDirMatrix(v, result);
  return result;
}

bool finite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

double unit_interval(double v) {
  return std::isfinite(v) ? std::clamp(v, 0.0, 1.0) : 0;
}

Rgb to_color(const aiColor3D& c) {
  return {unit_interval(c.r), unit_interval(c.g), unit_interval(c.b)};
}

// Scales the brightest channel to 1, as the intensity of lights follows from a rule of NFF.
std::optional<Rgb> light_color(const aiColor3D& c) {
  const double largest = std::max({c.r, c.g, c.b});
  if (!(largest > 0) || !std::isfinite(largest)) return std::nullopt;
  const Rgb color(unit_interval(c.r / largest), unit_interval(c.g / largest), unit_interval(c.b / largest));
  if (color == Rgb(1, 1, 1)) return std::nullopt;
  return color;
}

// The material that Assimp adds to meshes without one becomes NFF's default, white and matte.
Material to_material(const aiMaterial& from) {
  Material material;
  if (std::string_view(const_cast<aiMaterial&>(from).GetName().C_Str()) == AI_DEFAULT_MATERIAL_NAME)
    return material;
  aiColor3D color(1, 1, 1);
  aiColor4D base;
  if (from.Get(AI_MATKEY_COLOR_DIFFUSE, color) == aiReturn_SUCCESS) {
    material.color = to_color(color);
  } else if (from.Get(AI_MATKEY_BASE_COLOR, base) == aiReturn_SUCCESS) {
    material.color = to_color({base.r, base.g, base.b});
  }
  float value = 0;
  // The PLY reader invents a highlight without a size.
  if (from.Get(AI_MATKEY_COLOR_SPECULAR, color) == aiReturn_SUCCESS &&
      from.Get(AI_MATKEY_SHININESS, value) == aiReturn_SUCCESS) {
    material.specular = unit_interval((color.r + color.g + color.b) / 3);
    if (value > 0) material.shine = value;
  } else if (from.Get(AI_MATKEY_METALLIC_FACTOR, value) == aiReturn_SUCCESS) {
    float rough = 1;
    from.Get(AI_MATKEY_ROUGHNESS_FACTOR, rough);
    material.specular = unit_interval(value * (1 - unit_interval(rough)));
  }
  if (from.Get(AI_MATKEY_OPACITY, value) == aiReturn_SUCCESS)
    material.transmittance = 1 - unit_interval(value);
  if (material.transmittance > 0) {
    const bool given = from.Get(AI_MATKEY_REFRACTI, value) == aiReturn_SUCCESS && value > 0;
    material.refractive_index = given ? value : kDefaultGlassIndex;
  }
  return material;
}

class SceneReader {
 public:
  SceneReader(const aiScene& from, const std::string& path) : from_(from) { scene_.name = path; }

  ReadMesh run() {
    node(*from_.mRootNode, Imath::M44d());
    if (scene_.primitive_count() == 0) reject("there is no polygon in it");
    note(skipped_, "points, lines and faces without extent left out");
    return {std::move(scene_), std::move(notes_)};
  }

 private:
  [[noreturn]] void reject(const std::string& problem) const {
    throw InputError(scene_.name + ": error: " + problem);
  }

  void note(std::size_t count, const std::string& what) {
    if (count > 0) notes_.push_back(std::to_string(count) + " " + what);
  }

  void node(const aiNode& from, const Imath::M44d& parent) {
    const Imath::M44d transform = to_matrix(from.mTransformation) * parent;
    for (unsigned i = 0; i < from.mNumMeshes; ++i) mesh(*from_.mMeshes[from.mMeshes[i]], transform);
    camera(from, transform);
    lights(from, transform);
    for (unsigned i = 0; i < from.mNumChildren; ++i) node(*from.mChildren[i], transform);
  }

  void mesh(const aiMesh& from, const Imath::M44d& transform) {
    const Imath::M44d for_normals = transform.inverse().transposed();
    const bool mirrored = transform.determinant() < 0;
    const MaterialIndex material =
        table_.intern(scene_.materials, to_material(*from_.mMaterials[from.mMaterialIndex]));
    for (unsigned i = 0; i < from.mNumFaces; ++i) {
      const aiFace& face = from.mFaces[i];
      positions_.clear();
      vertices_.clear();
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        const unsigned at = face.mIndices[mirrored ? face.mNumIndices - 1 - k : k];
        Vec3d normal(0, 0, 0);
        if (from.mNormals != nullptr)
          normal = direction_by(for_normals, to_vector(from.mNormals[at])).normalized();
        positions_.push_back(to_vector(from.mVertices[at]) * transform);
        vertices_.push_back({positions_.back(), finite(normal) ? normal : Vec3d(0, 0, 0)});
        if (!finite(positions_.back())) reject("a coordinate is not finite");
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
    if (scene_.primitive_count() == kMaxPolygons) reject("it has more than 20 million polygons");
    const bool flat = std::all_of(vertices_.begin(), vertices_.end(), [&](const PatchVertex& v) {
      return v.normal == Vec3d(0, 0, 0) || v.normal.dot(plane) > kSameDirection;
    });
    if (flat) {
      add_polygon(scene_, positions_, material);
    } else {
      add_patch(scene_, vertices_, material);
    }
  }

  // Takes the first camera as the view. The angle of modelling programs spans the picture, that of NFF the
  // centres of its rows.
  void camera(const aiNode& node, const Imath::M44d& transform) {
    for (unsigned i = 0; i < from_.mNumCameras && !scene_.view; ++i) {
      const aiCamera& from = *from_.mCameras[i];
      if (std::string_view(from.mName.C_Str()) != node.mName.C_Str()) continue;
      View view;
      const double aspect = from.mAspect > 0 ? from.mAspect : 1;
      view.width = std::clamp(static_cast<int>(std::lround(view.height * aspect)), 1, 1 << 15);
      const double half_height = std::tan(0.5 * from.mHorizontalFOV) / aspect;
      const double rows = view.height;
      view.angle_degrees = 2 * std::atan(half_height * (rows - 1) / rows) * (180 / std::numbers::pi);
      view.from = to_vector(from.mPosition) * transform;
      view.at = view.from + direction_by(transform, to_vector(from.mLookAt)).normalized();
      view.up = direction_by(transform, to_vector(from.mUp)).normalized();
      view.hither = from.mClipPlaneNear;
      scene_.view = view;
    }
  }

  void lights(const aiNode& node, const Imath::M44d& transform) {
    for (unsigned i = 0; i < from_.mNumLights; ++i) {
      const aiLight& from = *from_.mLights[i];
      if (std::string_view(from.mName.C_Str()) != node.mName.C_Str()) continue;
      if (from.mType != aiLightSource_POINT && from.mType != aiLightSource_SPOT) {
        notes_.push_back(std::string("the light '") + from.mName.C_Str() +
                         "' is neither a point nor a spot: left out");
        continue;
      }
      scene_.lights.push_back({to_vector(from.mPosition) * transform, light_color(from.mColorDiffuse), {}});
    }
  }

  const aiScene& from_;
  SceneDescription scene_;
  std::vector<std::string> notes_;
  MaterialTable table_;
  std::size_t skipped_ = 0;
  std::vector<Vec3d> positions_;  // of the polygon at hand
  std::vector<PatchVertex> vertices_;
};

}  // namespace

bool is_mesh_extension(const std::string& extension) {
  return extension != ".nff" && extension.size() > 1 && Assimp::Importer().IsExtensionSupported(extension);
}

ReadMesh read_mesh(const std::string& path) {
  // Assimp has the same message for every reason why a file cannot be read.
  if (!std::ifstream(path))
    throw InputError("cannot read '" + path + "': " + std::generic_category().message(errno));
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, 0);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    throw InputError(path + ": error: " + importer.GetErrorString());
  }
  return SceneReader(*scene, path).run();
}

}  // namespace pprt
