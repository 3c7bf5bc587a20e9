// Materials of glTF, which are physically based, as Phong's.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "convert/gltf/gltf_holes.h"
#include "convert/gltf/gltf_model.h"
#include "convert/model/model_builder.h"
#include "convert/model/model_losses.h"
#include "convert/model/model_textures.h"
#include "image/image_io.h"

namespace pprt {

// A picture on a material, and how its coordinates follow from those of a mesh.
struct GltfPicture {
  int texture = -1;     // none
  int coordinates = 0;  // the set of a mesh
  Vec2d offset{0, 0}, scale{1, 1};
  double turn = 0;  // radians, counter-clockwise

  // Whether another picture lies at the same places.
  bool is_placed_as(const GltfPicture& other) const {
    return coordinates == other.coordinates && offset == other.offset && scale == other.scale &&
           turn == other.turn;
  }
};

struct GltfSurface {
  Material material;                    // without its texture
  std::array<double, 3> base{1, 1, 1};  // the factor of its colour, linear
  GltfPicture picture;                  // that of its colour, or else that of its emission
  int emission_texture = -1;            // placed as `picture`
  bool is_coloured = false;             // by `picture`
  std::optional<double> cutoff = {};    // of a picture's alpha, below which there is nothing
  bool is_double_sided = false;
  bool is_hidden = false;  // its alpha lies below the cutoff everywhere
};

// Reads the materials and pictures of a file, each once.
class GltfMaterials {
 public:
  // Losses and notes are told to `losses` and `builder`.
  GltfMaterials(const tinygltf::Model& model, const ModelFolder& folder, GltfFiles& files,
                ModelLosses& losses, ModelBuilder& builder, std::uint64_t max_memory)
      : model_(model),
        folder_(folder),
        files_(files),
        losses_(losses),
        builder_(builder),
        textures_(max_memory),
        max_memory_(max_memory) {
    known_.resize(model.materials.size());
  }

  // Returns a material; without one, the specification's own.
  const GltfSurface& surface(int material);

  // Returns the same with another factor of its colour, linear.
  static Material recoloured(const GltfSurface& surface, const std::array<double, 3>& factor);

  // Sets the textures of a material, and the coordinates of a mesh that are its own in `mesh`.
  void put_on(const GltfSurface& surface, Material& material, ModelMesh& mesh);

  // Returns the place of a texture that is no picture of the file.
  TextureIndex add(Texture texture);

  // Cuts holes into a mesh that has a texture, where its surface has them.
  void cut(const GltfSurface& surface, const Material& material, ModelMesh& mesh);

 private:
  GltfSurface read(const tinygltf::Material& from);
  double read_glass(const tinygltf::Material& from, double metal, double rough);
  void set_glow(const tinygltf::Material& from, GltfSurface& surface);
  std::array<double, 4> mean(int texture);
  std::optional<TextureIndex> tiled(int texture, const Vec2d& low, const Vec2d& tiles);
  TransparentImage picture(int image, std::uint64_t max_memory);

  const tinygltf::Model& model_;
  const ModelFolder& folder_;
  GltfFiles& files_;
  ModelLosses& losses_;
  ModelBuilder& builder_;
  ModelTextures textures_;
  std::map<TextureIndex, AlphaPicture> alphas_;  // of textures with holes or glass
  std::uint64_t max_memory_;
  std::vector<std::optional<GltfSurface>> known_;
  std::optional<GltfSurface> default_;
};

}  // namespace pprt
