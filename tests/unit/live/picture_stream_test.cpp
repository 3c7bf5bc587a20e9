// How pictures are sent, and how good they are said to be.
#include "live/picture_stream.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace pprt::picture_stream_test {
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

TEST_CASE(
    "picture stream: JPEG while the camera moves, at rest PNG four times a second, or for something new") {
  PictureStream stream;
  CHECK(stream.next(false, true, 0) == PictureCoding::kJpeg);
  CHECK(stream.next(false, false, 0) == PictureCoding::kJpeg);
  CHECK(stream.next(true, false, 1) == PictureCoding::kPng);
  CHECK(stream.next(true, false, 1.2) == PictureCoding::kNone);
  CHECK(stream.next(true, true, 1.2) == PictureCoding::kPng);
  CHECK(stream.next(true, false, 1.3) == PictureCoding::kNone);
  CHECK(stream.next(true, false, 1.5) == PictureCoding::kPng);
  CHECK(stream.next(false, false, 1.51) == PictureCoding::kJpeg);
  CHECK(stream.next(true, false, 1.52) == PictureCoding::kPng);
}

TEST_CASE("picture stream: what is encoded is what it says") {
  const EncodedPicture jpeg = encoded(picture(3), PictureCoding::kJpeg),
                       png = encoded(picture(3), PictureCoding::kPng);
  CHECK((jpeg.type == "image/jpeg" && jpeg.bytes.starts_with("\xff\xd8")));
  CHECK((png.type == "image/png" && png.bytes.substr(1, 3) == "PNG"));
  CHECK(encoded(picture(3), PictureCoding::kNone).type.empty());
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

TEST_CASE("rest estimate: a picture of another size is another picture") {
  RestEstimate estimate;
  estimate.add(picture(4), 100, true, true);
  CHECK_FALSE(estimate.add(Image(32, 32), 300, true, true));
  CHECK(estimate.add(Image(32, 32), 900, true, true));
}

TEST_CASE("rest estimate: it is a power of the samples, whatever of them lies between two pictures") {
  const double change = mean_flip(picture(2), picture(4));
  RestEstimate estimate;
  estimate.add(picture(4), 100, true, true);
  // Ten times the samples: nearly all of that change was the first picture's error.
  CHECK(*estimate.add(picture(2), 1000, true, true) == Approx(0.9 * change * std::pow(5.0, -0.65)));
  CHECK(*estimate.add(picture(2), 1999, true, true) ==
        Approx(0.9 * change * std::pow(5.0, -0.65) * std::pow(1.999, -0.65)));
  CHECK(*estimate.add(picture(3), 2000, true, true) == Approx(0.9 * mean_flip(picture(3), picture(2))));
}

TEST_CASE("rest estimate: a picture of a camera that moves is compared with none after it") {
  RestEstimate estimate;
  estimate.add(picture(4), 100, true, true);
  REQUIRE(estimate.add(picture(2), 200, true, true));
  CHECK_FALSE(estimate.add(picture(2), 250, false, false));
  CHECK_FALSE(estimate.add(picture(2), 499, true, true));
  CHECK(*estimate.add(picture(2), 500, true, true) == 0);  // twice those of the moving one, which begins anew
  CHECK_FALSE(estimate.add(Image(64, 32), 5000, true, true));
}

TEST_CASE("rest watch: the half second begins with the first frame at rest, each time") {
  RestWatch watch;
  for (const double begin : {0.0, 3.0}) {
    CHECK_FALSE(watch.is_at_rest(false, begin));
    CHECK_FALSE(watch.is_at_rest(true, begin + 0.3));
    CHECK_FALSE(watch.is_at_rest(true, begin + 0.7));
    CHECK(watch.is_at_rest(true, begin + 0.81));
    CHECK(watch.is_at_rest(true, begin + 2));
  }
}

}  // namespace
}  // namespace pprt::picture_stream_test
