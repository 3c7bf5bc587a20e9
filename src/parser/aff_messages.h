// Error messages of the AFF grammar, and warnings of the lenient reading.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "parser/aff_grammar.h"

namespace pprt::aff {

// A text before another, at compile time.
template <grammar::Text First, grammar::Text Second>
inline constexpr auto joined_text = [] {
  std::array<char, sizeof First.text + sizeof Second.text - 2> text{};
  std::copy_n(First.text, sizeof First.text - 1, text.begin());
  std::copy_n(Second.text, sizeof Second.text - 1, text.begin() + sizeof First.text - 1);
  return text;
}();
template <grammar::Text First, grammar::Text Second>
inline constexpr std::string_view joined{joined_text<First, Second>.data(),
                                         joined_text<First, Second>.size()};

// What a rule expects that must match; empty for rules that may fail. The report appends the directive and
// what was found: "expected a number for the radius of 's', found 'abc'".
template <typename Rule>
inline constexpr std::string_view expected = {};

template <grammar::Text What>
inline constexpr std::string_view expected<grammar::num<What>> = joined<"a number for ", What>;
template <grammar::Text What>
inline constexpr std::string_view expected<grammar::count<What>> = joined<"the number of ", What>;
template <grammar::Text What>
inline constexpr std::string_view expected<grammar::name<What>>{What.text, sizeof What.text - 1};
template <grammar::Text What>
inline constexpr std::string_view expected<grammar::word<What>> = joined<"the word ", What>;
template <>
inline constexpr std::string_view expected<grammar::open_brace> = "'{'";
template <>
inline constexpr std::string_view expected<grammar::track_end> = "transl, rot, scale, visibility or '}'";
template <>
inline constexpr std::string_view expected<grammar::end_of_directives> = "a directive of AFF";

// What real files do that the format does not say. Strict reading reports each as an error. Lenient reading
// gives one warning per kind, with its first place and its count.
enum class Deviation {
  kNoMaterial,
  kGlassIndex,
  kNoExtent,
  kDecreasingTimes,
  kViewRepeated,
  kTimesRepeated,
  kCount
};

struct DeviationText {
  const char* problem;
  const char* reading;
};

constexpr DeviationText text_of(Deviation deviation) {
  switch (deviation) {
    case Deviation::kNoMaterial:
      return {"there is no material before the first object", "white is taken"};
    case Deviation::kGlassIndex:
      return {"T is above 0 but the index of refraction is not", "1 is taken"};
    case Deviation::kNoExtent:
      return {"the object has no extent", "left out"};
    case Deviation::kDecreasingTimes:
      return {"the times of the keys decrease", "at each time the first segment counts that ends later"};
    case Deviation::kViewRepeated:
      return {"'v' is given again", "the last one counts"};
    case Deviation::kTimesRepeated:
      return {"'a' is given again", "the last one counts"};
    case Deviation::kCount:
      break;
  }
  return {"", ""};
}

}  // namespace pprt::aff
