// What a page is told of each frame.
#include "live/frame_header.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

namespace pprt::frame_header_test {
namespace {

using Json = nlohmann::json;

TEST_CASE("frame header: every figure has its name, and what is not known is null") {
  FrameHeader header;
  LiveShot& shot = header.shot;
  shot.view.from = {1, 2, 3}, shot.view.at = {4, 5, 6}, shot.view.up = {7, 8, 9};
  shot.view.angle_degrees = 50, shot.view.width = 640, shot.view.height = 480;
  shot.script_frame = 11, shot.moment = 99, shot.position = 12, shot.by_hand = true;
  shot.camera = 13, shot.look = 14, shot.pilot = 15;
  header.is_at_rest = true, header.type = "image/png";
  header.frames = {
      {.number = 1, .slack_ms = 2.5, .samples = 3, .late_ranks = {2, 6}},
      {.number = 5, .slack_ms = -6, .samples = 7, .rmse = {{0.25, 0.125, 0.5}}, .advice = "fewer"}};
  Json expected = Json::parse(R"({
    "camera":13, "look":14, "pilot":15, "size":[640, 480], "script_frame":11, "position":12, "by_hand":true,
    "view":{"from":[1.0,2.0,3.0], "at":[4.0,5.0,6.0], "up":[7.0,8.0,9.0], "angle":50.0},
    "at_rest":true, "flip":null, "type":"image/png",
    "frames":[{"number":1, "slack_ms":2.5, "samples":3, "late":[2, 6], "rmse":null, "advice":""},
              {"number":5, "slack_ms":-6.0, "samples":7, "late":[], "rmse":[0.25, 0.125, 0.5], "advice":"fewer"}]})");
  CHECK(Json::parse(to_text(header)) == expected);
  header.flip = 0.125, expected["flip"] = 0.125;
  header.frames.clear(), expected.erase("frames");
  CHECK(Json::parse(to_text(header)) == expected);
}

}  // namespace
}  // namespace pprt::frame_header_test
