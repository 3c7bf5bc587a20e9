#include "base/words.h"

#include <catch2/catch.hpp>

namespace pprt {
namespace {

enum class Axis { kX, kY, kNameless };

}  // namespace

template <>
inline constexpr std::array<Word<Axis>, 2> kWords<Axis>{{{Axis::kX, "x", "right"}, {Axis::kY, "y", "up"}}};

TEST_CASE("a word names its value, and a value its word") {
  static_assert(find_word<Axis>("y") == Axis::kY);
  static_assert(word_for(Axis::kX) == "x");
  CHECK((find_word<bool>("on") == true && find_word<bool>("off") == false));
}

TEST_CASE("an unknown word names no value") {
  for (const char* word : {"", "X", "x ", "z"}) CHECK_FALSE(find_word<Axis>(word));
}

TEST_CASE("a value without a word is an error of the program") {
  CHECK_THROWS_AS(word_for(Axis::kNameless), std::logic_error);
}

}  // namespace pprt
