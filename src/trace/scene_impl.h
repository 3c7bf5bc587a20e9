// The contents of a CompiledScene. Private to src/trace.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "trace/compiled_scene.h"
#include "trace/embree.h"
#include "trace/inventory.h"
#include "trace/kernel.h"
#include "trace/light_contacts.h"
#include "trace/mesh.h"
#include "trace/normalisation.h"
#include "trace/user_geometry.h"

namespace pprt {

// A material prepared for shading: products are multiplied out. The lights' weight is in ShadingLight.
struct ShadingMaterial {
  Color ambient{0, 0, 0};  // colour reflected from the ambient light
  Color diffuse{0, 0, 0};  // colour times Kd
  float specular = 0;      // Ks
  float shine = 0;         // 0: no highlight
  float transmittance = 0;
  double refractive_index = 1;  // > 0
  bool lit = false;             // whether lights contribute to it at all
};

// A light prepared for shading.
struct ShadingLight {
  Vec3d position{0, 0, 0};
  Color color{1, 1, 1};                // colour times the light's weight
  std::vector<LightContact> contacts;  // empty for nearly every light
};

// One Embree geometry: primitives of one kind and one visibility of faces.
struct ScenePart {
  PrimitiveKind kind = PrimitiveKind::kSphere;
  VisibleFaces faces = VisibleFaces::kBoth;
  std::variant<std::vector<SphereRecord>, std::vector<ConeRecord>, Mesh> shape;
  std::vector<MaterialIndex> materials;   // by Embree's primitive number
  std::vector<std::uint32_t> primitives;  // place in SceneDescription::order, by Embree's primitive number
};

// Figures of the compilation, for the census.
struct BuildFigures {
  double seconds = 0;
  std::size_t hierarchy_bytes = 0;  // memory of Embree's BVH
  std::size_t primitive_bytes = 0;
  std::size_t triangles = 0;
  std::size_t degenerate = 0;        // primitives without extent, left out
  std::size_t repeated = 0;          // primitives that equal an earlier one, left out
  std::uint32_t first_repeated = 0;  // of them, the first in SceneDescription::order
};

class CompiledScene::Impl {
 public:
  std::string name;
  CompileOptions options;
  Inventory inventory;
  EffectSet effects;
  Kernel kernel = nullptr;

  Normalisation normalisation;
  double radius = 1;  // of a sphere about the origin that contains the compiled scene
  Color background{0, 0, 0};
  std::vector<ShadingMaterial> materials;
  std::vector<ShadingLight> lights;
  std::vector<ScenePart> parts;  // by Embree's geometry number; not moved once Embree reads them

  BuildFigures figures;
  EmbreeDevice device;
  EmbreeScene embree;  // destroyed before the device and the parts that it reads
};

// Returns the text of CompiledScene::census().
std::string census_text(const CompiledScene::Impl& scene);

}  // namespace pprt
