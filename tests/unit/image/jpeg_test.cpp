#include <turbojpeg.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "image/display_bytes.h"
#include "image/image_io.h"

namespace pprt::jpeg_test {

namespace {

Image smooth_picture() {
  Image image(48, 32);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      image.at(x, y) = Color(static_cast<float>(x) / 48, static_cast<float>(y) / 32, 0.25f);
  return image;
}

// Red, green and blue of every pixel.
std::vector<std::uint8_t> shown(const std::string& jpeg, int width, int height) {
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width * height * 3));
  tjhandle reader = tjInitDecompress();
  const int failed = tjDecompress2(reader, reinterpret_cast<const unsigned char*>(jpeg.data()), jpeg.size(),
                                   pixels.data(), width, 0, height, TJPF_RGB, 0);
  tjDestroy(reader);
  REQUIRE(failed == 0);
  return pixels;
}

int largest_difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  int largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

}  // namespace

TEST_CASE("a JPEG shows the picture, the better the higher its quality") {
  const Image image = smooth_picture();
  const std::vector<std::uint8_t> wanted = display_bytes(image);
  const std::string fine = encode_jpeg(image, 95), coarse = encode_jpeg(image, 20);
  CHECK(coarse.size() < fine.size());
  CHECK(largest_difference(shown(fine, 48, 32), wanted) <= 4);
  CHECK(largest_difference(shown(coarse, 48, 32), wanted) > 4);
}

TEST_CASE("a JPEG keeps saturated colours apart at an edge between two pixels") {
  Image image(16, 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) image.at(x, y) = x % 8 < 4 ? Color(1, 0, 0) : Color(0, 0, 1);
  CHECK(largest_difference(shown(encode_jpeg(image, 95), 16, 16), display_bytes(image)) < 40);
}

TEST_CASE("no JPEG is made of an empty picture, nor of a value that is not finite") {
  CHECK_THROWS_AS(encode_jpeg(Image(), 90), std::runtime_error);
  Image image = smooth_picture();
  image.at(3, 3).x = NAN;
  CHECK_THROWS_AS(encode_jpeg(image, 90), std::runtime_error);
}

}  // namespace pprt::jpeg_test
