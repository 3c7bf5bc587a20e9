#include "study/word_list.h"

#include <catch2/catch.hpp>

#include "base/diagnostics.h"

namespace pprt::word_list_test {

TEST_CASE("word lists: in the order given, and an unknown word is refused by the option's name") {
  constexpr std::string_view kKnown[] = {"red", "green"};
  CHECK(words_in_list("--hue", "green,red", kKnown) == std::vector<std::string_view>{"green", "red"});
  CHECK_THROWS_WITH(words_in_list("--hue", "red,gren", kKnown),
                    "--hue red,gren: 'gren' is none of red, green; did you mean 'green'?");
  CHECK_THROWS_AS(words_in_list("--hue", "red,", kKnown), UsageError);
}

}  // namespace pprt::word_list_test
