// Materials and textures as POV-Ray has them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"
#include "scene/description/scene_description.h"

namespace pprt {

// Largest transmittance written: it leaves POV-Ray a share of the surface to light, which is compensated.
inline constexpr double kLargestTransmittance = 1 - 0x1p-10;

// The parameters of a pigment and its finish. POV-Ray multiplies ambient and diffuse light by the pigment's
// colour.
struct PovMaterial {
  Rgb pigment{1, 1, 1};  // times the texture
  double transmit = 0;
  Rgb ambient{0, 0, 0};
  double diffuse = 0;
  double phong = 0;  // 0: no highlight
  Rgb reflection{0, 0, 0};
  // The colour of a layer above that lets light pass. It colours all but the reflection.
  std::optional<Rgb> filter;
  // What a layer above all gives off, which lets kLargestTransmittance through.
  std::optional<Rgb> emission;
  bool lost_highlight = false;  // the highlight's colour; POV-Ray's is white, of the mean brightness
  bool lost_ambient = false;    // a channel that the texture's picture cannot hold
};

// Returns the parameters that give the material's colours.
PovMaterial pov_material(const SceneDescription& scene, const Material& material);

// A texture as a file, multiplied by a pigment's colour.
struct PovPicture {
  std::string name;  // without a folder
  TextureIndex texture = 0;
  Rgb tint{1, 1, 1};
};

struct PovPictures {
  std::vector<PovPicture> files;                      // with distinct names
  std::vector<std::optional<std::size_t>> materials;  // the file of each material
  std::vector<std::optional<std::size_t>> emissions;  // the file of the light that it gives off
};

// Returns the files for the textures of a scene that is written as STEM.pov.
PovPictures pov_pictures(const SceneDescription& scene, const std::string& stem);

// Returns what such a file shows. Without a tint, it keeps the texture's bytes.
Image picture_of(const SceneDescription& scene, const PovPicture& picture);

}  // namespace pprt
