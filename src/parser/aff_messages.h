// Error messages of the AFF grammar, and warnings of the lenient reading.
#pragma once

#include <algorithm>
#include <array>

#include "parser/aff_grammar.h"

namespace pprt::aff {

// A text before another, at compile time.
template <grammar::Text First, grammar::Text Second>
inline constexpr auto joined = [] {
  std::array<char, sizeof First.text + sizeof Second.text - 1> text{};
  std::copy_n(First.text, sizeof First.text - 1, text.begin());
  std::copy_n(Second.text, sizeof Second.text, text.begin() + sizeof First.text - 1);
  return text;
}();

// What a rule expects that must match; nullptr for rules that may fail. The report appends the directive and
// what was found: "expected a number for the radius of 's', found 'abc'".
template <typename Rule>
inline constexpr const char* expected = nullptr;

template <grammar::Text What>
inline constexpr const char* expected<grammar::num<What>> = joined<"a number for ", What>.data();
template <grammar::Text What>
inline constexpr const char* expected<grammar::count<What>> = joined<"the number of ", What>.data();
template <grammar::Text What>
inline constexpr const char* expected<grammar::name<What>> = What.text;
template <grammar::Text What>
inline constexpr const char* expected<grammar::word<What>> = joined<"the word ", What>.data();
template <>
inline constexpr const char* expected<grammar::open_brace> = "'{'";
template <>
inline constexpr const char* expected<grammar::track_end> = "transl, rot, scale, visibility or '}'";
template <>
inline constexpr const char* expected<grammar::end_of_directives> = "a directive of AFF";

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
