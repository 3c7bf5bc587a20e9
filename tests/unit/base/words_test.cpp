#include "base/words.h"

#include <catch2/catch.hpp>

namespace pprt::words_test {

enum class Axis { kX, kY, kNameless };

}  // namespace pprt::words_test

template <>
inline constexpr std::array<pprt::Word<pprt::words_test::Axis>, 2> pprt::kWords<pprt::words_test::Axis>{
    {{pprt::words_test::Axis::kX, "x", "right"}, {pprt::words_test::Axis::kY, "y", "up"}}};

namespace pprt::words_test {

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

}  // namespace pprt::words_test
