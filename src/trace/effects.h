// Which effects a scene calls for: the rest is neither built nor simulated.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene_description.h"

namespace pprt {

enum class Effect : std::uint8_t {
  kShadows = 1 << 0,        // some light: shadow rays (without them lights shine through)
  kHighlights = 1 << 1,     // some material with Ks > 0 and a finite highlight, and a light
  kReflection = 1 << 2,     // some Ks > 0
  kRefraction = 1 << 3,     // some T > 0
  kSmoothNormals = 1 << 4,  // some patch
};

// A set of effects, as bits.
class EffectSet {
 public:
  constexpr EffectSet() = default;
  constexpr explicit EffectSet(unsigned bits) : bits_(bits) {}
  constexpr bool has(Effect e) const { return (bits_ & static_cast<unsigned>(e)) != 0; }
  constexpr void add(Effect e) { bits_ |= static_cast<unsigned>(e); }
  constexpr unsigned bits() const { return bits_; }
  static constexpr EffectSet all() { return EffectSet(31); }

  friend constexpr bool operator==(EffectSet, EffectSet) = default;
  friend constexpr EffectSet operator&(EffectSet a, EffectSet b) { return EffectSet(a.bits_ & b.bits_); }

 private:
  unsigned bits_ = 0;
};

// The option's words: shadows, highlights, reflection, refraction, smooth-normals.
std::string_view name(Effect effect);
std::vector<Effect> every_effect();

// "shadows,reflection", "none" or "all" to a set; throws UsageError naming the unknown word.
EffectSet parse_effects(std::string_view list);
std::string to_string(EffectSet effects);

// What the scene's own contents call for.
EffectSet effects_called_for(const SceneDescription& scene);

}  // namespace pprt
