// What models can say and a scene cannot hold.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/counted.h"

namespace pprt {

enum class ModelLoss : std::uint8_t {
  kHoles,
  kAlphaPicture,
  kNormalMap,
  kOcclusion,
  kRoughnessPicture,
  kGlowPicture,
  kTint,
  kGlassPicture,
  kFrosted,
  kHighlight,
  kOneSide,
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
  kOtherPictures,  // from here on not of glTF
  kNamesakes,
  kRepeatedMovement,
  kCount
};

// The words that follow the count: of one, and of more, as pprt-convert(1) has them.
struct ModelLossWords {
  std::string_view one, many;
};
inline constexpr std::array<ModelLossWords, static_cast<std::size_t>(ModelLoss::kCount)> kModelLossWords = {{
    {"mesh with holes by a picture's alpha (MASK): some of its edges are coarse",
     "meshes with holes by a picture's alpha (MASK): the edges of some are coarse"},
    {"material as transparent as a picture's alpha (BLEND): its mean counts",
     "materials as transparent as a picture's alpha (BLEND): its mean counts"},
    {"material with a normal map: it is smooth", "materials with a normal map: they are smooth"},
    {"material with a picture of occlusion: it is not shown",
     "materials with a picture of occlusion: it is not shown"},
    {"material with a picture of metal and roughness: its mean counts",
     "materials with a picture of metal and roughness: its mean counts"},
    {"material that glows by a picture placed otherwise than that of its colour: its mean glows",
     "materials that glow by a picture placed otherwise than that of their colour: its mean glows"},
    {"material with coloured glass or metal: what is seen through or in it keeps its colours",
     "materials with coloured glass or metal: what is seen through or in them keeps its colours"},
    {"material with a picture of how much light it lets through: it does so all over",
     "materials with a picture of how much light they let through: they do so all over"},
    {"material of rough glass: it is clear", "materials of rough glass: they are clear"},
    {"smooth material that is no metal: its highlight is not shown",
     "smooth materials that are no metal: their highlights are not shown"},
    {"open mesh of a one-sided material: it is seen from behind, too",
     "open meshes of one-sided materials: they are seen from behind, too"},
    {"mesh with colours at its vertices besides a texture: their mean counts",
     "meshes with colours at their vertices besides a texture: their mean counts"},
    {"mesh with a skin stands in the pose that it is bound in",
     "meshes with a skin stand in the pose that they are bound in"},
    {"mesh that can change its shape (morph targets): it rests",
     "meshes that can change their shape (morph targets): they rest"},
    {"movement that changes a mesh's shape: left out", "movements that change a mesh's shape: left out"},
    {"movement of what is no place of a node (KHR_animation_pointer): left out",
     "movements of what is no place of a node (KHR_animation_pointer): left out"},
    {"spot light: it shines to all sides", "spot lights: they shine to all sides"},
    {"light that weakens with the distance: it is as bright everywhere as in the middle of the scene",
     "lights that weaken with the distance: they are as bright everywhere as in the middle of the scene"},
    {"camera besides the first: left out", "cameras besides the first: left out"},
    {"scene besides the one shown: left out", "scenes besides the one shown: left out"},
    {"texture that ends at its border (CLAMP_TO_EDGE), far beyond it: it is repeated",
     "textures that end at their border (CLAMP_TO_EDGE), far beyond it: they are repeated"},
    {"texture with hard texels (NEAREST): it is smooth",
     "textures with hard texels (NEAREST): they are smooth"},
    {"material with a picture of opacity, highlights or roughness: it is not shown",
     "materials with a picture of opacity, highlights or roughness: it is not shown"},
    {"node has the name of another: movements, cameras and lights may be mixed up",
     "nodes have the name of another: movements, cameras and lights may be mixed up"},
    {"movement of a node that another animation moves: left out",
     "movements of nodes that another animation moves: left out"},
}};

// Counts losses.
class ModelLosses {
 public:
  void add(ModelLoss loss, std::size_t count = 1) { counts_[static_cast<std::size_t>(loss)] += count; }

  // Appends a line for each kind of loss, in the order above.
  void tell(std::vector<std::string>& notes) const {
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      const auto& [one, many] = kModelLossWords[i];
      if (counts_[i] > 0) notes.push_back(counted(counts_[i], one, many));
    }
  }

 private:
  std::array<std::size_t, static_cast<std::size_t>(ModelLoss::kCount)> counts_{};
};

}  // namespace pprt
