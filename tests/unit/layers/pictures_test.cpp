#include "layers/pictures.h"

#include <catch2/catch.hpp>
#include <limits>

#include "unit/layers/hand_made.h"

namespace pprt::pictures_test {

using namespace pprt::test;

namespace {

const Color kBlack(0, 0, 0), kWhite(1, 1, 1);

FirstHit hit(float depth, const Vec3f& normal, std::uint32_t primitive, std::uint32_t material) {
  return {depth, normal, primitive, material};
}

}  // namespace

TEST_CASE("layer pictures: drawings have at least 1024 pixels on the longer side") {
  CHECK(drawing_scale(256, 256) == 4);
  CHECK(drawing_scale(160, 120) == 7);
  CHECK(drawing_scale(500, 1023) == 2);
  CHECK(drawing_scale(1024, 16) == 1);
  CHECK(drawing_scale(1920, 1080) == 1);
}

TEST_CASE("layer pictures: a sample is a black dot on white, where it lies") {
  const Image picture = black_on_white(sample_dots(triangulate_frame({sample(1, 3)}, kFourByFour)));
  REQUIRE((picture.width == 1024 && picture.height == 1024));
  CHECK(picture.at(256, 768) == kBlack);
  CHECK(picture.at(768, 256) == kWhite);
}

TEST_CASE("layer pictures: edges run from sample to sample, and nowhere else") {
  const Image picture = black_on_white(triangle_edges(triangulate_frame(corners_and_middle(), kFourByFour)));
  CHECK(picture.at(300, 300).x < 0.5f);  // on the diagonal
  CHECK(picture.at(300, 723).x < 0.5f);  // on the other one
  CHECK(picture.at(512, 200) == kWhite);
}

TEST_CASE("layer pictures: each region has a colour, with a border only between different ranks") {
  const Image frame(4, 4, Color(0.5f));
  const std::vector<std::int32_t> owners = {0, 1, 0, -1};  // two tiles of rank 0 on the left
  const Image picture = region_picture(frame, kFourByFour, owners);
  REQUIRE(picture.width == 1024);
  const Color left = picture.at(100, 100), right = picture.at(900, 100), nobody = picture.at(900, 900);
  CHECK(picture.at(100, 900) == left);
  CHECK(left != right);
  CHECK((nobody.x == nobody.y && nobody.y == nobody.z));
  CHECK(picture.at(512, 100) == kWhite);  // with black at its sides
  CHECK(picture.at(509, 100).x < 0.6f * left.x);
  CHECK(picture.at(100, 512) == left);
}

TEST_CASE("layer pictures: each region has its rank's number, on a tile of its own") {
  Image picture(64, 64, Color(0.5f));
  const std::vector<std::int32_t> owners = {0, 1, 1, -1};  // rank 1: the right upper and the left lower tile
  label_ranks(picture, kFourByFour, owners);
  const auto is_labelled = [&](int x, int y) {
    bool found = false;
    for (int j = 0; j < 32; ++j) {
      for (int i = 0; i < 32; ++i) found = found || picture.at(x + i, y + j) == kWhite;
    }
    return found;
  };
  CHECK(is_labelled(0, 0));
  CHECK(is_labelled(32, 0) != is_labelled(0, 32));
  CHECK_FALSE(is_labelled(32, 32));
}

TEST_CASE("layer pictures: heat grows lighter with every factor") {
  const std::vector<float> values = {0, 1, 10, 100, 1000};
  const Image picture = heat_picture(values, 5, 1, 1, 100);
  const auto light = [&](int x) { return picture.at(x, 0).x + picture.at(x, 0).y + picture.at(x, 0).z; };
  CHECK(light(0) == light(1));
  CHECK((light(1) < light(2) && light(2) < light(3)));
  CHECK(light(3) == light(4));
}

TEST_CASE("layer pictures: more rays are darker") {
  const std::vector<float> rays = {0, 1, 8, 64, 1000};
  const Image picture = cost_picture(rays, 5, 1);
  CHECK(picture.at(0, 0) == kWhite);
  CHECK(picture.at(1, 0) == kWhite);
  CHECK(picture.at(2, 0).x == Approx(0.5));
  CHECK(picture.at(3, 0) == kBlack);
  CHECK(picture.at(4, 0) == kBlack);
}

TEST_CASE("layer pictures: depths of any size make a picture, also in the eye's own plane") {
  constexpr float kMost = std::numeric_limits<float>::max(),
                  kLeast = std::numeric_limits<float>::denorm_min();
  const Vec3f up(0, 0, 1);
  for (const float nearest : {0.f, -1e-20f, kLeast, 1e-30f}) {
    for (const float farthest : {0.f, kLeast, 3.f, kMost}) {
      const std::vector<FirstHit> hits = {hit(nearest, up, 1, 1), hit(farthest, up, 2, 1)};
      const Image picture = depth_picture(hits, 2, 1);
      INFO(nearest << " and " << farthest);
      for (const Color& pixel : picture.pixels) CHECK((pixel.x >= 0.1f && pixel.x <= 1.001f));
    }
  }
  const std::vector<FirstHit> hits = {hit(0, up, 1, 1), hit(3, up, 2, 1)};
  CHECK(depth_picture(hits, 2, 1).at(0, 0).x == Approx(1));
  CHECK(depth_picture(hits, 2, 1).at(1, 0).x == Approx(0.1));
}

TEST_CASE("layer pictures: near depths are light, misses black") {
  const std::vector<FirstHit> hits = {hit(1, {0, 0, 1}, 1, 1), hit(2, {0, 0, 1}, 1, 1),
                                      hit(4, {0, 0, 1}, 1, 1), FirstHit()};
  const Image picture = depth_picture(hits, 4, 1);
  CHECK(picture.at(0, 0).x == Approx(1));
  CHECK(picture.at(1, 0).x == Approx(0.1 + 0.9 / 3));  // 1/2 - 1/4 of 1 - 1/4
  CHECK(picture.at(2, 0).x == Approx(0.1));
  CHECK(picture.at(3, 0) == kBlack);
  const std::vector<FirstHit> flat(4, hit(3, {0, 0, 1}, 1, 1));
  CHECK(depth_picture(flat, 4, 1).at(0, 0) == kWhite);
  CHECK(depth_picture(std::vector<FirstHit>(4), 4, 1).at(0, 0) == kBlack);
}

TEST_CASE("layer pictures: normals are colours, and ids show materials and primitives apart") {
  const std::vector<FirstHit> hits = {hit(1, {-1, 0, 1}, 1, 1), hit(1, {0, 0, 1}, 2, 1),
                                      hit(1, {0, 0, 1}, 2, 2), FirstHit()};
  const Image normals = normal_picture(hits, 4, 1);
  CHECK(normals.at(0, 0) == Color(0, 0.5f, 1));
  CHECK(normals.at(3, 0) == kBlack);
  const Image ids = id_picture(hits, 4, 1);
  CHECK((ids.at(0, 0) != ids.at(1, 0) && ids.at(1, 0) != ids.at(2, 0)));
  CHECK(ids.at(3, 0) == kBlack);
}

}  // namespace pprt::pictures_test
