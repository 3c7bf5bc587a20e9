// Error messages of the NFF grammar, and warnings of the lenient reading.
#pragma once

#include "parser/nff_grammar.h"

namespace pprt::nff {

// What a rule expects that must match; nullptr for rules that may fail. The report appends the entity and
// what was found: "expected a number for the radius of 's', found 'abc'".
template <typename Rule>
inline constexpr const char* expected = nullptr;

template <>
inline constexpr const char* expected<grammar::view_first_item> =
    "one of from, at, up, angle, hither and resolution";
template <>
inline constexpr const char* expected<grammar::view_value> = "a number for the view";
template <>
inline constexpr const char* expected<grammar::color_value> = "a number or a colour name for the colour";
template <>
inline constexpr const char* expected<grammar::fill_value> = expected<grammar::color_value>;
template <>
inline constexpr const char* expected<grammar::color_green> = "a number for green in the colour";
template <>
inline constexpr const char* expected<grammar::color_blue> = "a number for blue in the colour";
template <>
inline constexpr const char* expected<grammar::light_x> = "a number for x of the position";
template <>
inline constexpr const char* expected<grammar::light_y> = "a number for y of the position";
template <>
inline constexpr const char* expected<grammar::light_z> = "a number for z of the position";
template <>
inline constexpr const char* expected<grammar::sphere_x> = "a number for x of the centre";
template <>
inline constexpr const char* expected<grammar::sphere_y> = "a number for y of the centre";
template <>
inline constexpr const char* expected<grammar::sphere_z> = "a number for z of the centre";
template <>
inline constexpr const char* expected<grammar::sphere_radius> = "a number for the radius";
template <>
inline constexpr const char* expected<grammar::base_x> = "a number for x of the base";
template <>
inline constexpr const char* expected<grammar::base_y> = "a number for y of the base";
template <>
inline constexpr const char* expected<grammar::base_z> = "a number for z of the base";
template <>
inline constexpr const char* expected<grammar::base_radius> = "a number for the base radius";
template <>
inline constexpr const char* expected<grammar::apex_x> = "a number for x of the apex";
template <>
inline constexpr const char* expected<grammar::apex_y> = "a number for y of the apex";
template <>
inline constexpr const char* expected<grammar::apex_z> = "a number for z of the apex";
template <>
inline constexpr const char* expected<grammar::apex_radius> = "a number for the apex radius";
template <>
inline constexpr const char* expected<grammar::vertex_count> = "the number of vertices";
template <>
inline constexpr const char* expected<grammar::vertex_x> = "a number for x";
template <>
inline constexpr const char* expected<grammar::vertex_y> = "a number for y";
template <>
inline constexpr const char* expected<grammar::vertex_z> = "a number for z";
template <>
inline constexpr const char* expected<grammar::normal_x> = "a number for x of the normal";
template <>
inline constexpr const char* expected<grammar::normal_y> = "a number for y of the normal";
template <>
inline constexpr const char* expected<grammar::normal_z> = "a number for z of the normal";
template <>
inline constexpr const char* expected<grammar::end_of_entities> = "an entity (v, b, l, f, c, s, p or pp)";
template <>
inline constexpr const char* expected<grammar::block_comment_rest> = "'*/' to end this comment";

// Ways in which real files deviate from NFF.TXT. Strict reading reports each as an error. Lenient reading
// gives one warning per kind, with its first place and its count, or none where the meaning is clear.
enum class Deviation {
  kPercentComment,
  kBlockComment,
  kMailHeader,
  kViewAfterObject,
  kLightAfterObject,
  kViewRepeated,
  kViewItemRepeated,
  kViewYon,
  kViewWithoutHither,
  kViewWithoutResolution,
  kBackgroundRepeated,
  kColorName,
  kLightIntensity,
  kFillGrey,
  kFillShort,
  kFillLong,
  kFillTail,
  kNoFill,
  kSphereExtra,
  kSphereZeroRadius,
  kConeWithoutLength,
  kConeWithoutRadius,
  kConeMixedRadii,
  kFewVertices,
  kZeroArea,
  kGlassIndex,
  kCount
};

// What is said of a deviation: the problem, and what the lenient reading does.
struct DeviationText {
  const char* problem;
  const char* reading;  // what the lenient reading does; nullptr: no warning
};

// Returns the texts of a deviation.
constexpr DeviationText text_of(Deviation deviation) {
  switch (deviation) {
    case Deviation::kPercentComment:
      return {"a '%' comment belongs to AFF, not to NFF", nullptr};
    case Deviation::kBlockComment:
      return {"a '/* */' comment is not NFF", nullptr};
    case Deviation::kMailHeader:
      return {"a mail header is not part of a scene", "skipped"};
    case Deviation::kViewAfterObject:
      return {"'v' must come before all objects", nullptr};
    case Deviation::kLightAfterObject:
      return {"'l' must come before all objects", nullptr};
    case Deviation::kViewRepeated:
      return {"'v' is given again", "the last one counts"};
    case Deviation::kViewItemRepeated:
      return {"a part of 'v' is given twice", "the last one counts"};
    case Deviation::kViewYon:
      return {"'yon' is not NFF", "ignored"};
    case Deviation::kViewWithoutHither:
      return {"'v' lacks 'hither'", nullptr};
    case Deviation::kViewWithoutResolution:
      return {"'v' lacks 'resolution'", "512 x 512 is taken"};
    case Deviation::kBackgroundRepeated:
      return {"'b' is given again", "the last one counts"};
    case Deviation::kColorName:
      return {"a colour name belongs to MTV's dialect, not to NFF", nullptr};
    case Deviation::kLightIntensity:
      return {"'l' with 7 numbers is not NFF", "read as x y z intensity r g b"};
    case Deviation::kFillGrey:
      return {"'f' has fewer than the 3 numbers of a colour",
              "the last one stands for those missing; Kd 1, Ks 0, Shine 0, T 0, index 1"};
    case Deviation::kFillShort:
      return {"'f' has fewer than 8 numbers",
              "those missing are taken from Kd 1, Ks 0, Shine 0, T 0, index 1"};
    case Deviation::kFillLong:
      return {"'f' has more than 8 numbers", "those after the 8th are ignored"};
    case Deviation::kFillTail:
      return {"'f' takes only numbers", "the rest of the line is ignored"};
    case Deviation::kNoFill:
      return {"there is no 'f' before the first object", "white with Kd 1 is taken"};
    case Deviation::kSphereExtra:
      return {"'s' has 2 more numbers than x y z radius", "they are ignored"};
    case Deviation::kSphereZeroRadius:
      return {"the sphere's radius is 0", "left out"};
    case Deviation::kConeWithoutLength:
      return {"the cone's base and apex are the same point", "left out"};
    case Deviation::kConeWithoutRadius:
      return {"both radii of the cone are 0", "left out"};
    case Deviation::kConeMixedRadii:
      return {"one radius of the cone is negative and the other positive", "left out"};
    case Deviation::kFewVertices:
      return {"the polygon has fewer than 3 vertices", "left out"};
    case Deviation::kZeroArea:
      return {"the polygon's area is 0", "left out"};
    case Deviation::kGlassIndex:
      return {"T is above 0 but the index of refraction is not", "1 is taken"};
    case Deviation::kCount:
      break;
  }
  return {"", nullptr};
}

// Returns what a word means in a related format that has it; nullptr for other words. The text at hand need
// not be of that format.
constexpr const char* foreign_entity(std::string_view word) {
  struct Foreign {
    std::string_view word;
    const char* meaning;
  };
  constexpr Foreign kForeign[] = {
      {"fm", "in AFF an extended material"},
      {"la", "in AFF an animated light"},
      {"am", "in AFF an ambient light"},
      {"tt", "in AFF a textured triangle"},
      {"ttp", "in AFF a textured patch"},
      {"tpa", "in AFF an animated patch"},
      {"m", "in AFF a triangle mesh"},
      {"i", "in AFF an include"},
      {"d", "in AFF a detail level"},
      {"x", "in AFF an animated transformation"},
      {"xs", "in AFF a static transformation"},
      {"k", "in AFF key frames"},
      {"tpp", "in Assimp's dialect a textured patch"},
      {"tess", "in Assimp's dialect the tessellation"},
      {"shader", "in Assimp's dialect the texture"},
      {"tet", "in Assimp's dialect a tetrahedron"},
      {"hex", "in Assimp's dialect a cube"},
      {"oct", "in Assimp's dialect an octahedron"},
      {"dod", "in Assimp's dialect a dodecahedron"},
  };
  for (const Foreign& foreign : kForeign) {
    if (foreign.word == word) return foreign.meaning;
  }
  return nullptr;
}

}  // namespace pprt::nff
