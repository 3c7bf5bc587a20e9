#include "parser/colour_names.h"

#include <catch2/catch.hpp>

namespace pprt::colour_names_test {
namespace {

Rgb bytes(int r, int g, int b) {
  return {r / 255.0, g / 255.0, b / 255.0};
}

}  // namespace

TEST_CASE("colour names have the values of X11, not of CSS") {
  CHECK(color_by_name("red") == bytes(255, 0, 0));
  CHECK(color_by_name("green") == bytes(0, 255, 0));
  CHECK(color_by_name("gray") == bytes(190, 190, 190));
  CHECK(color_by_name("maroon") == bytes(176, 48, 96));
  CHECK(color_by_name("purple") == bytes(160, 32, 240));
  CHECK(color_by_name("aliceblue") == bytes(240, 248, 255));
  CHECK(color_by_name("yellowgreen") == bytes(154, 205, 50));
  CHECK(color_by_name("tomato3") == bytes(205, 79, 57));
  CHECK(color_by_name("DarkSlateGrey4") == bytes(82, 139, 139));
}

TEST_CASE("colour names may be written in any case and with grey for gray") {
  CHECK(color_by_name("LightSteelBlue") == bytes(176, 196, 222));
  CHECK(color_by_name("RED") == bytes(255, 0, 0));
  CHECK(color_by_name("DarkSlateGrey") == color_by_name("darkslategray"));
}

TEST_CASE("numbered greys are rounded as in rgb.txt") {
  CHECK(color_by_name("gray0") == bytes(0, 0, 0));
  CHECK(color_by_name("gray10") == bytes(26, 26, 26));
  CHECK(color_by_name("gray50") == bytes(127, 127, 127));
  CHECK(color_by_name("grey90") == bytes(229, 229, 229));
  CHECK(color_by_name("gray100") == bytes(255, 255, 255));
}

TEST_CASE("a word that is no colour name has no colour") {
  for (const char* name : {"", "redd", "re", "gray101", "gray-1", "gray05", "gray5x", "light blue", "tomato0",
                           "tomato5", "beige1", "1", "4"}) {
    CAPTURE(name);
    CHECK_FALSE(color_by_name(name));
  }
}

}  // namespace pprt::colour_names_test
