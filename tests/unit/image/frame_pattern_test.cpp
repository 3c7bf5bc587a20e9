#include "image/frame_pattern.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "base/diagnostics.h"
#include "unit/image/temporary_directory.h"

namespace pprt::frame_pattern_test {

namespace {

std::string name(const char* pattern, int frame) {
  return file_name(parse_frame_pattern(pattern, FrameCount::kMany), frame).string();
}

std::string complaint(const char* pattern, FrameCount count = FrameCount::kMany) {
  try {
    parse_frame_pattern(pattern, count);
  } catch (const UsageError& e) {
    return e.what();
  }
  return "no complaint";
}

}  // namespace

TEST_CASE("a layer's picture is named after its frame") {
  const auto name = [](const char* pattern, int frame) {
    return file_name(beside(parse_frame_pattern(pattern, FrameCount::kOne), "depth"), frame).string();
  };
  CHECK(name("out/%04d.png", 7) == "out/0007.depth.png");
  CHECK(name("a.b/####_x.y.png", 7) == "a.b/0007_x.y.depth.png");
  CHECK(name("a.b/still.png", 7) == "a.b/still.depth.png");
}

TEST_CASE("a pattern names its frames") {
  CHECK(name("frame_%04d.png", 7) == "frame_0007.png");
  CHECK(name("out/####.exr", 12) == "out/0012.exr");
  CHECK(name("%d.exr", 0) == "0.exr");
  CHECK(name("#.exr", 123) == "123.exr");
  CHECK(name("f%02d.exr", 1234) == "f1234.exr");  // more digits than asked for are kept
  CHECK(name("take%03d/frame.png", 5) == "take005/frame.png");
  CHECK(name("100%%_%09d.png", 2147483) == "100%_002147483.png");
  CHECK(name("{}%d}.png", 1) == "{}1}.png");
}

TEST_CASE("one frame may do without a field") {
  CHECK(file_name(parse_frame_pattern("still.exr", FrameCount::kOne), 3) == "still.exr");
  CHECK(file_name(parse_frame_pattern("50%%.exr", FrameCount::kOne), 3) == "50%.exr");
  CHECK(file_name(parse_frame_pattern("still_%04d.exr", FrameCount::kOne), 3) == "still_0003.exr");
  CHECK(complaint("a/still.exr") ==
        "output 'a/still.exr': several frames need a field for the frame number, as in 'a/still_%04d.exr'");
}

TEST_CASE("an invalid pattern is rejected with its problem") {
  const std::string percent = "'%' must begin a frame number like %d or %04d, or be doubled: %%";
  for (const char* pattern :
       {"f%4d.png", "f%s.png", "f%04.png", "f%", "f%00d.png", "f%012d.png", "f%-4d.png"}) {
    CAPTURE(pattern);
    CHECK(complaint(pattern) == "output '" + std::string(pattern) + "': " + percent);
  }
  const std::string one_field = "only one field (%04d or ####) may stand in it";
  for (const char* pattern : {"%d%d.png", "#_#.png", "%04d/##.png"}) {
    CAPTURE(pattern);
    CHECK(complaint(pattern) == "output '" + std::string(pattern) + "': " + one_field);
  }
  CHECK(complaint("##########.png") == "output '##########.png': a frame number has at most 9 digits");
  for (const char* pattern : {"", "f%d", "f%d.jpg", "%d.PNG", "f.png%d", ".png", "out/"}) {
    CAPTURE(pattern);
    CHECK(complaint(pattern) == "output '" + std::string(pattern) + "': the name must end in .exr or .png");
  }
}

TEST_CASE("frame numbers are not negative") {
  CHECK_THROWS_AS(name("%d.png", -1), std::invalid_argument);
}

TEST_CASE("frames that are there are found by their numbers") {
  const TemporaryDirectory directory;
  const auto make = [&](const char* file) {
    const std::filesystem::path path = directory.path() / file;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << "x";
  };
  const auto found = [&](const char* pattern) {
    return frames_present(parse_frame_pattern((directory.path() / pattern).string(), FrameCount::kOne));
  };
  for (const char* file :
       {"a0010.png", "a0002.png", "a12345.png", "a7.png", "a0003.exr", "a0004.depth.png", "b0005.png",
        "a-001.png", "a+001.png", "a00x1.png", "a99999999999.png", "d1/f.png", "d3/f.png", "d2/g.png"}) {
    make(file);
  }
  CHECK(found("a%04d.png") == std::vector<int>{2, 10, 12345});
  CHECK(found("a#.png") == std::vector<int>{7, 12345});
  CHECK(found("d%d/f.png") == std::vector<int>{1, 3});
  CHECK(found("c%d.png").empty());
  CHECK(found("none/%d.png").empty());
  CHECK(found("a0010.png").empty());
}

}  // namespace pprt::frame_pattern_test
