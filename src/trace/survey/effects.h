// The effects a scene calls for. All others are neither built nor simulated.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene/description/scene_description.h"

namespace pprt {

// Effects that can be left out of the simulation, with what in a scene calls for each.
enum class Effect : std::uint8_t {
  kShadows = 1 << 0,        // the scene has a light; without shadow rays lights shine through objects
  kHighlights = 1 << 1,     // a light, and a material with Ks > 0 and a visible highlight
  kReflection = 1 << 2,     // a material with Ks > 0
  kRefraction = 1 << 3,     // a material with T > 0
  kSmoothNormals = 1 << 4,  // the scene has a patch, or a mesh with normals
  kTextures = 1 << 5,       // a material with a texture
  kEmission = 1 << 6,       // a material that gives off light
  kSky = 1 << 7,            // the background is a sky
};

// A set of effects, one bit each.
class EffectSet {
 public:
  constexpr EffectSet() = default;
  constexpr explicit EffectSet(unsigned bits) : bits_(bits) {}
  constexpr bool has(Effect e) const { return (bits_ & static_cast<unsigned>(e)) != 0; }
  constexpr void add(Effect e) { bits_ |= static_cast<unsigned>(e); }
  constexpr unsigned bits() const { return bits_; }
  static constexpr EffectSet all() { return EffectSet(255); }

  friend constexpr bool operator==(EffectSet, EffectSet) = default;
  friend constexpr EffectSet operator&(EffectSet a, EffectSet b) { return EffectSet(a.bits_ & b.bits_); }

 private:
  unsigned bits_ = 0;
};

// Returns the option's word: shadows, highlights, reflection, refraction, smooth-normals, textures,
// emission, sky.
std::string_view name(Effect effect);
// Returns all effects, in the order of their bits.
std::vector<Effect> every_effect();

// Parses "shadows,reflection", "none" or "all". Throws UsageError that names an unknown word.
EffectSet parse_effects(std::string_view list);
// Returns the words of a set, separated by commas, or "none". parse_effects reads it back.
std::string to_string(EffectSet effects);

// Returns the effects that the scene's lights, materials, patches and background call for.
EffectSet effects_called_for(const SceneDescription& scene);

}  // namespace pprt
