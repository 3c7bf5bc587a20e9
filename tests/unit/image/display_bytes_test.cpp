#include "image/display_bytes.h"

#include <catch2/catch.hpp>

#include <limits>

#include "image/image_io.h"

namespace pprt::display_bytes_test {

TEST_CASE("a display value is rounded to the nearest of 256 levels") {
  for (int level = 0; level < 256; ++level) CHECK(display_byte(static_cast<float>(level) / 255) == level);
  CHECK(display_byte(0.5f) == 128);  // 127.5: halves go up
  CHECK(display_byte(0.49999f) == 127);
}

TEST_CASE("display values outside 0 to 1 are clamped, and NaN is black") {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  CHECK((display_byte(-0.1f) == 0 && display_byte(-kInfinity) == 0));
  CHECK((display_byte(1.1f) == 255 && display_byte(kInfinity) == 255));
  CHECK(display_byte(std::numeric_limits<float>::quiet_NaN()) == 0);
}

TEST_CASE("display bytes of a picture are those that its PNG holds") {
  Image image(2, 1);
  image.at(0, 0) = Color(0.1f, 0.5f, 2);
  image.at(1, 0) = Color(0.9f, -1, 0.3333f);
  const std::vector<std::uint8_t> bytes = display_bytes(image);
  REQUIRE(bytes.size() == 6);
  CHECK(display_bytes(decode_png(encode_png(image))) == bytes);
}

}  // namespace pprt::display_bytes_test
