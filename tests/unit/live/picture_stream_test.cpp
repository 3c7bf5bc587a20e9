// How pictures are sent, and how good they are said to be.
#include "live/picture_stream.h"

#include <catch2/catch.hpp>

namespace pprt {
namespace {

// Stripes, of which `share` of 16 columns is wrong.
Image picture(int wrong_columns) {
  Image image(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) image.at(x, y) = Color(x % 16 < wrong_columns ? 1.0f : 0.2f);
  return image;
}

TEST_CASE("rest watch: a camera is at rest when it has not moved for half a second") {
  RestWatch watch;
  CHECK_FALSE(watch.is_at_rest(true, 10));
  CHECK_FALSE(watch.is_at_rest(true, 10.4));
  CHECK(watch.is_at_rest(true, 10.5));
  CHECK_FALSE(watch.is_at_rest(false, 10.6));
  CHECK_FALSE(watch.is_at_rest(true, 10.7));
}

TEST_CASE("picture stream: JPEG while the camera moves, at rest PNG four times a second") {
  PictureStream stream;
  const Image image = picture(3);
  CHECK(stream.encode(image, false, 0).type == "image/jpeg");
  CHECK(stream.encode(image, false, 0).bytes.starts_with("\xff\xd8"));
  const EncodedPicture png = stream.encode(image, true, 1);
  CHECK(png.type == "image/png");
  CHECK(png.bytes.substr(1, 3) == "PNG");
  CHECK(stream.encode(image, true, 1.2).type.empty());
  CHECK(stream.encode(image, true, 1.3).type == "image/png");
  CHECK(stream.encode(image, false, 1.31).type == "image/jpeg");
  CHECK(stream.encode(image, true, 1.32).type == "image/png");
}

TEST_CASE("rest estimate: nothing is known of a moving camera, nor before the samples have doubled") {
  RestEstimate estimate;
  CHECK_FALSE(estimate.add(picture(4), 100, false, false));
  CHECK_FALSE(estimate.add(picture(4), 150, true, true));
  CHECK_FALSE(estimate.add(picture(4), 500, true, false));
  CHECK(estimate.add(picture(2), 500, true, true));
  CHECK_FALSE(estimate.add(picture(2), 900, false, true));
}

TEST_CASE("rest estimate: it is the change while the samples doubled, and falls as more come") {
  RestEstimate estimate;
  estimate.add(picture(4), 100, true, true);
  const auto doubled = estimate.add(picture(2), 200, true, true);
  const double change = mean_flip(picture(2), picture(4));
  REQUIRE(doubled);
  CHECK(*doubled == Approx(0.9 * change));
  const auto more = estimate.add(picture(2), 300, true, true);
  REQUIRE(more);
  CHECK(*more < *doubled);
  const auto same = estimate.add(picture(2), 400, true, true);
  REQUIRE(same);
  CHECK(*same == 0);
}

}  // namespace
}  // namespace pprt
