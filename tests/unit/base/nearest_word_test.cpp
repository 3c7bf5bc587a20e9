#include "base/nearest_word.h"

#include <catch2/catch.hpp>
#include <string_view>

namespace pprt::nearest_word_test {
namespace {

constexpr std::string_view kWords[] = {"from", "frames", "fps", "at", "camera", "R"};

TEST_CASE("a changed, added, dropped or swapped letter is found") {
  CHECK(nearest_word("frim", kWords) == "from");
  CHECK(nearest_word("fromm", kWords) == "from");
  CHECK(nearest_word("frm", kWords) == "from");
  CHECK(nearest_word("form", kWords) == "from");
  CHECK(nearest_word("camrea", kWords) == "camera");
  CHECK(nearest_word("FRAMES", kWords) == "frames");
}

TEST_CASE("what is far from all words has no suggestion") {
  CHECK(nearest_word("turntable", kWords).empty());
  CHECK(nearest_word("x", kWords).empty());
  CHECK(nearest_word("r", kWords) == "R");
  CHECK(nearest_word("", kWords).empty());
  CHECK(nearest_word(std::string_view("camera camera camera camera camera"), kWords).empty());
  CHECK(did_you_mean("turntable", kWords).empty());
}

TEST_CASE("the suggestion continues the message") {
  CHECK(did_you_mean("frm", kWords) == "; did you mean 'from'?");
}

}  // namespace
}  // namespace pprt::nearest_word_test
