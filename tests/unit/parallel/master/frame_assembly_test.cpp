// A frame while the pixels of its ranks come in, whole and in parts.
#include "parallel/master/frame_assembly.h"

#include <catch2/catch.hpp>

namespace pprt::frame_assembly_test {
namespace {

constexpr int kRanks = 3;
const TileGrid kGrid(12, 4, 4);  // three tiles in a row

FrameOrder order_without(const std::vector<std::int32_t>& lost) {
  FrameOrder order;
  order.index = 5;
  order.lost = lost;
  return order;
}

// A tile in one colour. The last part comes with a report, and as many samples as the tile's number.
PixelMessage part(int tile, bool is_last) {
  PixelMessage message;
  message.frame_index = 5;
  message.tiles = {{.tile = tile, .triangles = 7}};
  message.colors.assign(16, Color(0.25F * static_cast<float>(tile + 1)));
  message.is_last = is_last;
  message.report.samples_new = static_cast<std::uint64_t>(100 + tile);
  message.samples.resize(static_cast<std::size_t>(tile));
  return message;
}

}  // namespace

TEST_CASE("frame assembly: a frame is whole when the last part of each rank has come") {
  FrameAssembly frame(order_without({}), kGrid, kRanks);
  CHECK(frame.order().index == 5);
  CHECK(frame.late_ranks() == std::vector<std::int32_t>{0, 1, 2});
  frame.add(2, part(2, true));
  frame.add(0, part(0, false));
  CHECK((frame.awaits(0) && frame.awaits(1) && !frame.awaits(2)));
  CHECK(frame.late_ranks() == std::vector<std::int32_t>{0, 1});
  frame.add(0, part(1, true));
  CHECK_FALSE(frame.is_whole());
  CHECK(frame.late_ranks() == std::vector<std::int32_t>{1});
  PixelMessage without_tiles;
  without_tiles.frame_index = 5;
  frame.add(1, without_tiles);
  CHECK((frame.is_whole() && frame.late_ranks().empty()));
}

TEST_CASE("frame assembly: tiles come with each part, report and samples with the last") {
  FrameAssembly frame(order_without({}), kGrid, kRanks);
  frame.add(0, part(1, false));
  CHECK((frame.samples.empty() && frame.reports()[0].samples_new == 0));
  CHECK(frame.picture.image().at(5, 1) == Color(0.5F));
  frame.add(0, part(2, true));
  REQUIRE(frame.tiles[0].size() == 2);
  CHECK((frame.tiles[0][0].tile == 1 && frame.tiles[0][1].tile == 2 && frame.tiles[1].empty()));
  CHECK((frame.samples.size() == 2 && frame.reports()[0].samples_new == 102));
  frame.add(1, part(0, true));
  frame.add(2, part(1, true));
  CHECK(frame.samples.size() == 3);
  CHECK((frame.reports()[1].samples_new == 100 && frame.reports()[2].samples_new == 101));
}

TEST_CASE("frame assembly: nothing is expected of lost ranks, and nothing twice") {
  FrameAssembly frame(order_without({1}), kGrid, kRanks);
  CHECK((frame.awaits(0) && !frame.awaits(1) && frame.awaits(2)));
  CHECK(frame.late_ranks() == std::vector<std::int32_t>{0, 2});
  CHECK_THROWS_AS(frame.add(1, part(1, true)), ProtocolError);
  frame.add(0, part(0, true));
  CHECK_THROWS_AS(frame.add(0, part(0, true)), ProtocolError);
  CHECK_THROWS_AS(frame.add(0, part(1, false)), ProtocolError);
  CHECK_FALSE(frame.is_whole());
  frame.add(2, part(2, true));
  CHECK(frame.is_whole());
}

}  // namespace pprt::frame_assembly_test
