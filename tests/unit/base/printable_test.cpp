#include "base/printable.h"

#include <catch2/catch.hpp>

namespace pprt::printable_test {

TEST_CASE("control characters in messages are written as escapes") {
  CHECK(printable("scenes/ball (1).nff") == "scenes/ball (1).nff");
  CHECK(printable("a\x1b[31mb\x7f\r") == "a\\x1b[31mb\\x7f\\x0d");
  CHECK(printable("a\nb\tc") == "a\\nb\\tc");
  CHECK(printable(std::string_view("\0x", 2)) == "\\x00x");
  CHECK(printable("\xc2\x9b"
                  "2J") == "\\xc2\\x9b2J");                            // CSI in UTF-8
  CHECK(printable("\xc3\xa4\xc2\xa0\xc2") == "\xc3\xa4\xc2\xa0\xc2");  // letters beyond ASCII stay
  CHECK(printable_lines("a\nb\x1b") == "a\nb\\x1b");
  CHECK(printable(printable("\x1b")) == printable("\x1b"));
}

}  // namespace pprt::printable_test
