// What glTF can say and a scene cannot hold.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pprt {

enum class GltfLoss : std::uint8_t {
  kHoles,
  kAlphaPicture,
  kNormalMap,
  kOcclusion,
  kRoughnessPicture,
  kGlowPicture,
  kTint,
  kVertexColours,
  kSkin,
  kShapes,
  kShapeMovement,
  kOtherMovement,
  kSpot,
  kDistance,
  kCameras,
  kScenes,
  kBorder,
  kHardTexels,
  kCount
};

// The words that follow the count, as pprt-convert(1) has them.
inline constexpr std::array<std::string_view, static_cast<std::size_t>(GltfLoss::kCount)> kGltfLossWords = {
    "meshes with holes by a picture's alpha (MASK): the edges of some are coarse",
    "materials as transparent as a picture's alpha (BLEND): its mean counts",
    "materials with a normal map: they are smooth",
    "materials with a picture of occlusion: it is not shown",
    "materials with a picture of metal and roughness: its mean counts",
    "materials that glow by a picture placed otherwise than that of their colour: its mean glows",
    "materials with coloured glass or metal: what is seen through or in them keeps its colours",
    "meshes with colours at their vertices besides a texture: their mean counts",
    "meshes with a skin stand in the pose that they are bound in",
    "meshes that can change their shape (morph targets): they rest",
    "movements that change a mesh's shape: left out",
    "movements of what is no place of a node (KHR_animation_pointer): left out",
    "spot lights: they shine to all sides",
    "lights that weaken with the distance: they are as bright everywhere as in the middle of the scene",
    "cameras besides the first: left out",
    "scenes besides the one shown: left out",
    "textures that end at their border (CLAMP_TO_EDGE), far beyond it: they are repeated",
    "textures with hard texels (NEAREST): they are smooth",
};

// Counts losses.
class GltfLosses {
 public:
  void add(GltfLoss loss, std::size_t count = 1) { counts_[static_cast<std::size_t>(loss)] += count; }

  // Appends a line for each kind of loss, in the order above.
  void tell(std::vector<std::string>& notes) const {
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      if (counts_[i] > 0) notes.push_back(std::to_string(counts_[i]) + " " + std::string(kGltfLossWords[i]));
    }
  }

 private:
  std::array<std::size_t, static_cast<std::size_t>(GltfLoss::kCount)> counts_{};
};

}  // namespace pprt
