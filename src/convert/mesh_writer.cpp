#include "convert/mesh_writer.h"

#include <assimp/camera.h>
#include <assimp/config.h>
#include <assimp/light.h>
#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <algorithm>
#include <array>
#include <assimp/Exporter.hpp>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <stdexcept>

#include "base/diagnostics.h"
#include "scene/shading_rules.h"
#include "scene/view_frame.h"

namespace pprt {
namespace {

struct Format {
  std::string_view extension;
  const char* assimp_id;
  bool physically_based = false;  // its materials
};

// Binary where there is a choice: a tenth of the time, a third of the size.
constexpr std::array kFormats = {Format{".obj", "obj"},          Format{".ply", "plyb"},
                                 Format{".stl", "stlb"},         Format{".glb", "glb2", true},
                                 Format{".gltf", "gltf2", true}, Format{".dae", "collada"}};

aiVector3D to_assimp(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

aiColor3D to_assimp(const Rgb& c) {
  return {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)};
}

// The triangles of one material.
struct MaterialMesh {
  std::vector<PatchVertex> vertices;
  std::vector<TriangleIndices> triangles;

  void add(const Surface& surface) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), surface.vertices.begin(), surface.vertices.end());
    for (const TriangleIndices& t : surface.triangles) {
      triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }
};

// Makes every primitive a surface. Flat ones get their own normal at every vertex, so that they stay flat.
class MeshBuilder {
 public:
  MeshBuilder(const SceneDescription& scene, const Fineness& fineness)
      : scene_(scene), fineness_(fineness), meshes_(scene.materials.size()) {}

  std::vector<MaterialMesh> run() {
    for (const PrimitiveRef ref : scene_.order) {
      const Surface surface = surface_of(ref);
      if (surface.triangles.empty()) ++degenerate_;
      meshes_[material_of(scene_, ref)].add(surface);
    }
    return std::move(meshes_);
  }

  std::size_t degenerate() const { return degenerate_; }

 private:
  Surface surface_of(PrimitiveRef ref) {
    switch (ref.kind) {
      case PrimitiveKind::kSphere:
        return curved(scene_.spheres[ref.index]);
      case PrimitiveKind::kCone:
        return curved(scene_.cones[ref.index]);
      case PrimitiveKind::kPolygon: {
        corners_.clear();
        for (const Vec3d& v : scene_.vertices(scene_.polygons[ref.index])) corners_.push_back({v, {0, 0, 0}});
        return facets();
      }
      case PrimitiveKind::kTriangle: {
        const std::array<PatchVertex, 3> corners = corners_of(scene_, scene_.triangles[ref.index]);
        corners_.assign(corners.begin(), corners.end());
        return facets();
      }
      case PrimitiveKind::kPatch:
      case PrimitiveKind::kMovingTriangle:
        break;
    }
    const std::span<const PatchVertex> vertices = scene_.vertices(scene_.patches[ref.index]);
    corners_.assign(vertices.begin(), vertices.end());
    return facets();
  }

  template <typename Curved>
  Surface curved(const Curved& object) const {
    const int n = divisions(object, fineness_);
    return n > 0 ? tessellate(object, n) : Surface();
  }

  // A vertex without a normal of its own gets the polygon's.
  Surface facets() {
    positions_.clear();
    for (const PatchVertex& v : corners_) positions_.push_back(v.position);
    Surface surface;
    surface.triangles = triangulate(positions_);
    if (surface.triangles.empty()) return surface;
    const Vec3d flat = newell_normal(positions_).normalized();
    for (PatchVertex& v : corners_) {
      v.normal.normalize();  // zero stays zero
      if (v.normal == Vec3d(0, 0, 0)) v.normal = flat;
    }
    surface.vertices = corners_;
    return surface;
  }

  const SceneDescription& scene_;
  const Fineness& fineness_;
  std::vector<MaterialMesh> meshes_;  // one a material, some perhaps empty
  std::size_t degenerate_ = 0;
  std::vector<PatchVertex> corners_;
  std::vector<Vec3d> positions_;
};

std::unique_ptr<aiMesh> to_assimp(const MaterialMesh& from, unsigned material) {
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
  mesh->mNumFaces = static_cast<unsigned>(from.triangles.size());
  mesh->mFaces = new aiFace[from.triangles.size()];
  for (std::size_t i = 0; i < from.triangles.size(); ++i) {
    mesh->mFaces[i].mNumIndices = 3;
    mesh->mFaces[i].mIndices = new unsigned[3];
    std::copy_n(from.triangles[i].begin(), 3, mesh->mFaces[i].mIndices);
  }
  return mesh;
}

// Phong's model is that of NFF without the mirror. Formats with only physically based materials get smooth
// metal for it.
std::unique_ptr<aiMaterial> to_assimp(const Material& m, std::size_t number, bool physically_based) {
  auto material = std::make_unique<aiMaterial>();
  const aiString name("material_" + std::to_string(number));
  const aiColor3D diffuse = to_assimp(m.terms ? m.terms->diffuse : m.color * m.diffuse);
  const auto opacity = static_cast<float>(1 - m.transmittance);
  const auto mirror = static_cast<float>(m.specular);
  material->AddProperty(&name, AI_MATKEY_NAME);
  material->AddProperty(&opacity, 1, AI_MATKEY_OPACITY);
  if (physically_based) {
    const aiColor4D base(diffuse.r, diffuse.g, diffuse.b, 1);  // times the opacity
    const float roughness = 0;
    material->AddProperty(&base, 1, AI_MATKEY_BASE_COLOR);
    material->AddProperty(&mirror, 1, AI_MATKEY_METALLIC_FACTOR);
    material->AddProperty(&roughness, 1, AI_MATKEY_ROUGHNESS_FACTOR);
    return material;
  }
  const aiColor3D specular = m.terms ? to_assimp(m.terms->specular) : aiColor3D(mirror, mirror, mirror);
  const int model = aiShadingMode_Phong;
  const auto shine = static_cast<float>(m.shine);
  const auto index = static_cast<float>(effective_refractive_index(m));
  if (m.terms) {
    const aiColor3D ambient = to_assimp(m.terms->ambient);
    material->AddProperty(&ambient, 1, AI_MATKEY_COLOR_AMBIENT);
  }
  material->AddProperty(&diffuse, 1, AI_MATKEY_COLOR_DIFFUSE);
  material->AddProperty(&specular, 1, AI_MATKEY_COLOR_SPECULAR);
  material->AddProperty(&model, 1, AI_MATKEY_SHADING_MODEL);
  material->AddProperty(&shine, 1, AI_MATKEY_SHININESS);
  material->AddProperty(&index, 1, AI_MATKEY_REFRACTI);
  return material;
}

// Returns a node that places the camera or light of the same name.
aiNode* new_node(aiNode& root, const std::string& name, const Vec3d& x, const Vec3d& y, const Vec3d& z,
                 const Vec3d& origin) {
  auto node = std::make_unique<aiNode>(name);
  node->mParent = &root;
  const aiVector3D a = to_assimp(x), b = to_assimp(y), c = to_assimp(z), o = to_assimp(origin);
  node->mTransformation = {a.x, b.x, c.x, o.x, a.y, b.y, c.y, o.y, a.z, b.z, c.z, o.z, 0, 0, 0, 1};
  return node.release();
}

// Returns a camera that looks along its node's -z, as in most formats.
void add_camera(const SceneDescription& scene, aiScene& to, std::vector<aiNode*>& children) {
  if (!scene.view) return;
  const View& view = *scene.view;
  const ViewFrame frame = view_frame(view, scene.name);
  auto camera = std::make_unique<aiCamera>();
  camera->mName = "camera";
  camera->mLookAt = {0, 0, -1};
  camera->mUp = {0, 1, 0};
  camera->mAspect = static_cast<float>(view.width) / static_cast<float>(view.height);
  camera->mHorizontalFOV = static_cast<float>(2 * std::atan(0.5 * view.width * frame.slope_per_pixel));
  if (view.hither > 0) camera->mClipPlaneNear = static_cast<float>(view.hither);
  children.push_back(new_node(*to.mRootNode, "camera", frame.right, frame.up, -frame.forward, view.from));
  to.mNumCameras = 1;
  to.mCameras = new aiCamera* [1] { camera.release() };
}

void add_lights(const SceneDescription& scene, aiScene& to, std::vector<aiNode*>& children) {
  to.mLights = new aiLight*[scene.lights.size()];
  for (const Light& from : scene.lights) {
    auto light = std::make_unique<aiLight>();
    const std::string name = "light_" + std::to_string(to.mNumLights + 1);
    light->mName = name;
    light->mType = aiLightSource_POINT;
    light->mColorDiffuse = light->mColorSpecular = to_assimp(from.color.value_or(Rgb(1, 1, 1)));
    light->mAttenuationConstant = 1;
    light->mAttenuationLinear = light->mAttenuationQuadratic = 0;
    children.push_back(new_node(*to.mRootNode, name, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, from.position));
    to.mLights[to.mNumLights++] = light.release();
  }
}

// Keeps only materials of some mesh: most formats drop the others.
std::unique_ptr<aiScene> to_assimp(const SceneDescription& scene, const std::vector<MaterialMesh>& meshes,
                                   bool physically_based) {
  auto result = std::make_unique<aiScene>();
  result->mRootNode = new aiNode("scene");
  result->mMeshes = new aiMesh*[meshes.size()];
  result->mMaterials = new aiMaterial*[meshes.size()];
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (meshes[i].triangles.empty()) continue;
    result->mMeshes[result->mNumMeshes] = to_assimp(meshes[i], result->mNumMaterials).release();
    ++result->mNumMeshes;
    result->mMaterials[result->mNumMaterials] =
        to_assimp(scene.materials[i], i + 1, physically_based).release();
    ++result->mNumMaterials;
  }
  result->mRootNode->mNumMeshes = result->mNumMeshes;
  result->mRootNode->mMeshes = new unsigned[result->mNumMeshes];
  for (unsigned i = 0; i < result->mNumMeshes; ++i) result->mRootNode->mMeshes[i] = i;
  std::vector<aiNode*> children;
  add_camera(scene, *result, children);
  add_lights(scene, *result, children);
  result->mRootNode->mNumChildren = static_cast<unsigned>(children.size());
  result->mRootNode->mChildren = new aiNode*[children.size()];
  std::copy(children.begin(), children.end(), result->mRootNode->mChildren);
  return result;
}

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

WrittenMesh write_mesh(const SceneDescription& scene, std::string_view extension, const std::string& stem,
                       const Fineness& fineness) {
  const auto* format = std::find_if(kFormats.begin(), kFormats.end(),
                                    [&](const Format& f) { return f.extension == extension; });
  if (format == kFormats.end()) throw std::invalid_argument("no mesh format: " + std::string(extension));
  check_triangle_count(scene, fineness);
  WrittenMesh result;
  std::unique_ptr<aiScene> assimp;
  {
    MeshBuilder builder(scene, fineness);
    const std::vector<MaterialMesh> meshes = builder.run();
    result.degenerate = builder.degenerate();
    for (const MaterialMesh& mesh : meshes) result.triangles += mesh.triangles.size();
    if (result.triangles == 0)
      throw InputError(scene.name + ": error: no object of the scene has any extent");
    assimp = to_assimp(scene, meshes, format->physically_based);
  }
  Assimp::Exporter exporter;
  Assimp::ExportProperties properties;
  properties.SetPropertyString(AI_CONFIG_EXPORT_BLOB_NAME, stem);
  const aiExportDataBlob* blob = exporter.ExportToBlob(assimp.get(), format->assimp_id, 0, &properties);
  if (blob == nullptr)
    throw std::runtime_error(std::string("cannot make a mesh file: ") + exporter.GetErrorString());
  for (; blob != nullptr;
       blob = blob->next) {  // the first is the named one, the others have names of their own
    result.files.push_back({result.files.empty() ? stem + std::string(extension) : blob->name.C_Str(),
                            std::string(static_cast<const char*>(blob->data), blob->size)});
  }
  std::reverse(result.files.begin(), result.files.end());
  return result;
}

}  // namespace pprt
