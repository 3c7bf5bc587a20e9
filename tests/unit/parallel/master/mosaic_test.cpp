#include "parallel/master/mosaic.h"

#include <catch2/catch.hpp>

namespace pprt::mosaic_test {
namespace {

// Four tiles of 4x4 pixels in a row.
const TileGrid kGrid(16, 4, 4);

// All pixels of these tiles have this colour.
PixelMessage pixels(int frame, std::initializer_list<int> own, std::initializer_list<int> given,
                    float value) {
  PixelMessage message;
  message.frame_index = frame;
  for (const int tile : own) message.tiles.push_back({tile, 0, 0, 0, 0});
  message.given = given;
  message.colors.assign(16 * (own.size() + given.size()), Color(value));
  return message;
}

float value_of(const Mosaic& mosaic, int tile) {
  return mosaic.image().at(4 * tile + 3, 3).y;
}

}  // namespace

TEST_CASE("mosaic: an owner's pixels replace those of a former owner, in whatever order they come") {
  for (const bool owner_first : {true, false}) {
    Mosaic mosaic(kGrid);
    if (owner_first) mosaic.paste(1, pixels(0, {2}, {}, 0.5f));
    mosaic.paste(0, pixels(0, {0, 1}, {2}, 0.25f));
    if (!owner_first) {
      CHECK(value_of(mosaic, 2) == 0.25f);  // fills the gap
      mosaic.paste(1, pixels(0, {2}, {}, 0.5f));
    }
    CHECK(value_of(mosaic, 1) == 0.25f);
    CHECK(value_of(mosaic, 2) == 0.5f);
    CHECK(mosaic.shown_ranks() == std::vector<std::int32_t>{0, 0, 1, -1});
  }
}

TEST_CASE("mosaic: gaps are filled from an earlier picture, and nothing else is") {
  Mosaic before(kGrid);
  before.paste(0, pixels(3, {0, 1}, {}, 0.125f));
  before.paste(1, pixels(3, {2, 3}, {}, 0.25f));
  Mosaic now(kGrid);
  now.paste(0, pixels(4, {0, 1, 2}, {}, 0.5f));
  CHECK(now.fill_gaps(before) == 1);
  CHECK(value_of(now, 2) == 0.5f);
  CHECK(value_of(now, 3) == 0.25f);
  CHECK(now.shown_ranks() == std::vector<std::int32_t>{0, 0, 0, 1});
  CHECK(now.fill_gaps(before) == 0);
}

TEST_CASE("mosaic: late pixels replace older ones only") {
  Mosaic shown(kGrid);
  shown.paste(0, pixels(7, {0}, {}, 0.5f));
  shown.paste(1, pixels(4, {1}, {}, 0.25f));
  shown.paste(1, pixels(6, {0, 1}, {2}, 0.75f));
  CHECK(value_of(shown, 0) == 0.5f);
  CHECK(value_of(shown, 1) == 0.75f);
  CHECK(value_of(shown, 2) == 0.75f);
}

TEST_CASE("mosaic: pixels that are not those of their tiles are refused") {
  Mosaic mosaic(kGrid);
  CHECK_THROWS_AS(mosaic.paste(0, pixels(0, {4}, {}, 0)), ProtocolError);
  CHECK_THROWS_AS(mosaic.paste(0, pixels(0, {}, {-1}, 0)), ProtocolError);
  PixelMessage message = pixels(0, {0, 1}, {}, 0);
  message.colors.pop_back();
  CHECK_THROWS_AS(mosaic.paste(0, message), ProtocolError);
}

}  // namespace pprt::mosaic_test
