// The contents of a CompiledScene. Private to src/trace.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "trace/compiled_scene.h"
#include "trace/geometry/embree.h"
#include "trace/geometry/mesh.h"
#include "trace/geometry/normalisation.h"
#include "trace/geometry/user_geometry.h"
#include "trace/light_contacts.h"
#include "trace/survey/inventory.h"
#include "trace/textures/texture_image.h"

namespace pprt {

// A material prepared for shading: products are multiplied out. The lights' weight is in ShadingLight.
struct ShadingMaterial {
  Color ambient{0, 0, 0};  // colour reflected from the ambient light
  Color unlit{0, 0, 0};    // the same and what it gives off: all that is seen of it without lights
  Color diffuse{0, 0, 0};  // colour times Kd
  float specular = 0;      // Ks
  float shine = 0;         // 0: no highlight
  float transmittance = 0;
  double refractive_index = 1;  // > 0
  bool lit = false;             // whether lights contribute to it at all
  // What NFF has not.
  bool reflects_totally = false;          // follows the mirrored ray where none is refracted
  Color specular_color{0, 0, 0};          // in place of `specular`, its largest component
  const TextureImage* texture = nullptr;  // times ambient and diffuse
  Color emission{0, 0, 0};
  const TextureImage* emission_texture = nullptr;  // times emission

  bool has_picture() const { return texture != nullptr || emission_texture != nullptr; }
};

// The background above the horizon.
struct ShadingSky {
  Vec3f up{0, 1, 0};                      // unit
  Color horizon{0, 0, 0}, rise{0, 0, 0};  // rise: from the horizon to the zenith

  // Returns the colour at the sine of an elevation.
  Color at(float height) const { return horizon + rise * height; }
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
  std::uint32_t body = 0;                 // in whose space it lies
  bool smooth = false;                    // a mesh with normals
  bool textured = false;                  // a mesh with texture coordinates
  std::vector<MaterialIndex> materials;   // by Embree's primitive number
  std::vector<std::uint32_t> primitives;  // place in SceneDescription::order, by Embree's primitive number
  std::vector<bool> coincides;            // triangles that lie in others; empty: none. See coincident_faces.h
  std::vector<Box3d> boxes;               // boxes_of() a mesh whose corners do not move
  std::vector<MovingTriangle> shapes;     // of triangles whose corners move, in the body's space
};

// Objects that move as one, or change their shape, in a compiled space of their own. The first body is what
// rests; its space is the world's.
struct CompiledBody {
  NodeIndex node = 0;
  bool deforms = false;
  Normalisation normalisation;
  Box3d box;           // in its compiled space, of all times
  EmbreeScene embree;  // of the first body and of those that keep their shape
};

// Figures of the compilation, for the census.
struct BuildFigures {
  double seconds = 0;
  std::size_t hierarchy_bytes = 0;  // memory of Embree's BVH
  std::size_t primitive_bytes = 0;
  std::size_t texture_bytes = 0;  // pyramids included
  std::size_t triangles = 0;
  std::size_t degenerate = 0;        // primitives without extent, left out
  std::size_t repeated = 0;          // primitives that equal an earlier one, left out
  std::size_t coincident = 0;        // triangles that lie in others
  std::uint32_t first_repeated = 0;  // of them, the first in SceneDescription::order
};

class CompiledScene::Impl {
 public:
  std::string name;
  CompileOptions options;
  Inventory inventory;
  EffectSet effects;

  EmbreeDevice device;
  Normalisation normalisation;
  double radius = 1;          // of a sphere about the origin that contains the compiled scene
  Color background{0, 0, 0};  // below the horizon, if the background is a sky
  ShadingSky sky;
  std::vector<TextureImage> textures;
  std::vector<ShadingMaterial> materials;
  std::vector<ShadingLight> lights;
  std::vector<std::uint32_t> surfaces;      // connected_surfaces()
  std::vector<std::uint8_t> with_pictures;  // primitives_with_pictures()
  std::vector<LitSurface> lit_surfaces;     // lit_surfaces()
  std::vector<ScenePart> parts;             // by Embree's geometry number; not moved once Embree reads them

  // What moves.
  bool moves = false;  // more than the camera
  Movement movement;
  std::vector<LightNode> light_nodes;            // empty: no light moves
  std::vector<Light> lights_in_nodes;            // each in the space of its node, if lights move
  std::vector<CompiledBody> bodies;              // destroyed before the parts that they read
  std::vector<std::uint32_t> part_of_primitive;  // by place in the order; kNoPart: none

  BuildFigures figures;
};

inline constexpr std::uint32_t kNoPart = ~std::uint32_t{0};

// Returns where a light of a node stands in the compiled space.
Vec3d compiled_place(const Light& light, const Affine& to_world, const Normalisation& map);

// Returns the text of CompiledScene::census().
std::string census_text(const CompiledScene::Impl& scene);

}  // namespace pprt
