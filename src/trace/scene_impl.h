// What a CompiledScene holds; private to the module.
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
#include "trace/mesh.h"
#include "trace/normalisation.h"
#include "trace/user_geometry.h"

namespace pprt {

// A material as shading wants it: products taken, weights of the lights left to the lights.
struct ShadingMaterial {
  Color ambient{0, 0, 0};  // the light that is everywhere, as reflected
  Color diffuse{0, 0, 0};  // colour times Kd
  float specular = 0;      // Ks
  float shine = 0;         // 0: no highlight
  float transmittance = 0;
  double refractive_index = 1;  // > 0
  bool lit = false;             // whether a light makes any difference to it
};

struct ShadingLight {
  Vec3d position{0, 0, 0};
  Color color{1, 1, 1};  // times its weight
};

// One Embree geometry: primitives of one kind, of which the same sides are seen.
struct ScenePart {
  PrimitiveKind kind = PrimitiveKind::kSphere;
  Sides sides = Sides::kBoth;
  std::variant<std::vector<SphereRecord>, std::vector<ConeRecord>, Mesh> shape;
  std::vector<MaterialIndex> materials;   // by Embree's primitive number
  std::vector<std::uint32_t> primitives;  // by the same: place in the description's order
};

struct BuildFigures {
  double seconds = 0;
  std::size_t hierarchy_bytes = 0;  // Embree's own
  std::size_t primitive_bytes = 0;
  std::size_t triangles = 0;
  std::size_t degenerate = 0;  // primitives without extent, left out
};

class CompiledScene::Impl {
 public:
  std::string name;
  CompileOptions options;
  Inventory inventory;
  EffectSet effects;
  Kernel kernel = nullptr;

  Normalisation normalisation;
  double radius = 1;  // of a sphere about the origin that holds the compiled scene
  Color background{0, 0, 0};
  std::vector<ShadingMaterial> materials;
  std::vector<ShadingLight> lights;
  std::vector<ScenePart> parts;  // by Embree's geometry number; never moved once Embree has read them

  BuildFigures figures;
  EmbreeDevice device;
  EmbreeScene embree;  // released before the device and the parts it reads
};

// The text of CompiledScene::census().
std::string census_text(const CompiledScene::Impl& scene);

}  // namespace pprt
