#include "image/frame_writer.h"

#include <catch2/catch.hpp>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <thread>

#include "image/atomic_file.h"
#include "image/checksum.h"
#include "unit/image/temporary_directory.h"

namespace fs = std::filesystem;
namespace pprt::frame_writer_test {

namespace {

FramePattern pattern_in(const fs::path& directory, const char* name) {
  return parse_frame_pattern((directory / name).string(), FrameCount::kMany);
}

// A level of the frame's own, exact in 8 bits and, up to 2^-11, in half.
Image picture_of(int frame) {
  return Image(8, 8, Color(static_cast<float>(frame) / 255));
}

std::vector<int> numbers(const std::vector<WrittenFrame>& frames) {
  std::vector<int> result;
  result.reserve(frames.size());
  for (const WrittenFrame& frame : frames) result.push_back(frame.frame);
  return result;
}

std::vector<fs::path> paths(const WrittenFrame& frame) {
  std::vector<fs::path> result;
  for (const WrittenFile& file : frame.files) result.push_back(file.path);
  return result;
}

}  // namespace

TEST_CASE("all frames are written in order, to all outputs") {
  const TemporaryDirectory directory;
  FrameWriter writer(
      {pattern_in(directory.path(), "out/%04d.exr"), pattern_in(directory.path(), "p_##.png")});
  std::vector<int> expected;
  for (int frame = 1; frame <= 40; ++frame) {
    writer.submit({frame, picture_of(frame), {{"pprt.frame", std::int64_t{frame}}}});
    expected.push_back(frame);
  }
  writer.finish();

  const std::vector<WrittenFrame> finished = writer.take_finished();
  CHECK(numbers(finished) == expected);
  CHECK(paths(finished[6]) ==
        std::vector<fs::path>{directory.path() / "out/0007.exr", directory.path() / "p_07.png"});
  for (const WrittenFrame& frame : finished) {
    CHECK(read_image(frame.files[1].path).pixels == picture_of(frame.frame).pixels);
    for (const WrittenFile& file : frame.files) CHECK(crc32_of_file(file.path) == file.crc32);
    CHECK(read_image(frame.files[0].path).at(0, 0).x == Approx(frame.frame / 255.0).epsilon(1e-3));
  }
  CHECK(writer.take_finished().empty());
  CHECK(!writer.error());
}

TEST_CASE("layers are channels of an EXR and pictures beside a PNG, made when they are written") {
  const TemporaryDirectory directory;
  std::thread::id maker;
  LayerMaker layers;
  layers.names = {"a", "b"};
  layers.channels = [&] {
    maker = std::this_thread::get_id();
    return std::vector<Channel>{{"a.Y", std::vector<float>(64, 2.0f)}};
  };
  layers.picture = [](std::size_t layer, const Image& frame) {
    return Image(4, 2, layer == 0 ? Color(1, 1, 1) : frame.at(0, 0));
  };
  FrameWriter writer({pattern_in(directory.path(), "%d.exr"), pattern_in(directory.path(), "%d.png")});
  writer.submit({3, picture_of(3), {}, layers});
  writer.finish();
  const std::vector<WrittenFrame> finished = writer.take_finished();
  REQUIRE(finished.size() == 1);
  CHECK(finished[0].layers == layers.names);
  CHECK(paths(finished[0]) == std::vector<fs::path>{directory.path() / "3.exr", directory.path() / "3.png",
                                                    directory.path() / "3.a.png",
                                                    directory.path() / "3.b.png"});
  CHECK(read_whole_file(directory.path() / "3.png") == encode_png(picture_of(3)));
  CHECK(read_whole_file(directory.path() / "3.a.png") ==
        encode_png(Image(4, 2, Color(1, 1, 1)), {}, PictureKind::kDrawn));
  CHECK(read_image(directory.path() / "3.a.png").at(3, 1) == Color(1, 1, 1));
  CHECK(read_image(directory.path() / "3.b.png").at(0, 0) == picture_of(3).at(0, 0));
  CHECK(maker != std::this_thread::get_id());
}

TEST_CASE("a writer that may hold one frame only loses none") {
  const TemporaryDirectory directory;
  FrameWriter writer({pattern_in(directory.path(), "%d.png")}, {.overwrite = false, .memory_bound = 1});
  for (int frame = 0; frame < 20; ++frame) writer.submit({frame, picture_of(frame), {}});
  writer.finish();
  CHECK(directory.entries() == 20);
}

TEST_CASE("the destructor writes what waits") {
  const TemporaryDirectory directory;
  {
    FrameWriter writer({pattern_in(directory.path(), "%d.png")});
    for (int frame = 0; frame < 10; ++frame) writer.submit({frame, picture_of(frame), {}});
  }
  CHECK(directory.entries() == 10);
}

TEST_CASE("the first error is kept, and later frames are tried all the same") {
  const TemporaryDirectory directory;
  write_whole_file(directory.path() / "2", "a file where frames 2 want a directory");
  FrameWriter writer({pattern_in(directory.path(), "%d/f.png")});
  for (int frame = 1; frame <= 3; ++frame) writer.submit({frame, picture_of(frame), {}});
  const std::string message =
      "cannot write '" + (directory.path() / "2/f.png").string() + "': Not a directory";
  CHECK_THROWS_WITH(writer.finish(), message);
  CHECK(writer.error() == message);
  CHECK(numbers(writer.take_finished()) == std::vector<int>{1, 3});
  CHECK_THROWS_WITH(writer.finish(), message);
}

TEST_CASE("an error is reported while the frame loop runs") {
  FrameWriter writer({parse_frame_pattern("/dev/null/%d.png", FrameCount::kMany)});
  CHECK(!writer.error());
  writer.submit({1, picture_of(1), {}});
  for (int i = 0; i < 1000 && !writer.error(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  CHECK(writer.error() == "cannot write '/dev/null/1.png': Not a directory");
}

TEST_CASE("frames in a hurry are compressed by run lengths alone") {
  const TemporaryDirectory directory;
  Image image(64, 64);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)  // repeats, but not from pixel to pixel
    image.pixels[i] = Color(static_cast<float>(i % 7), static_cast<float>(i % 5), static_cast<float>(i % 3));
  const auto bytes_of = [&](const char* name, bool is_hurried) {
    const fs::path folder = directory.path() / name;
    FrameWriter writer({pattern_in(folder, "%d.exr")}, {.is_hurried = is_hurried});
    writer.submit({1, image, {}});
    writer.finish();
    return fs::file_size(folder / "1.exr");
  };
  CHECK(bytes_of("hurried", true) > 2 * bytes_of("small", false));
}

TEST_CASE("files that are there are kept unless overwriting is asked for") {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "5.png";
  write_image(path, picture_of(1));
  FrameWriter careful({pattern_in(directory.path(), "%d.png")});
  careful.submit({5, picture_of(2), {}});
  CHECK_THROWS_WITH(careful.finish(), "cannot write '" + path.string() + "': the file is there already");
  CHECK(read_image(path).pixels == picture_of(1).pixels);

  FrameWriter careless({pattern_in(directory.path(), "%d.png")}, {.overwrite = true});
  careless.submit({5, picture_of(2), {}});
  careless.finish();
  CHECK(read_image(path).pixels == picture_of(2).pixels);
}

TEST_CASE("a frame with values that are not finite never reaches a file") {
  const TemporaryDirectory directory;
  FrameWriter writer({pattern_in(directory.path(), "%d.exr")});
  Image image = picture_of(1);
  image.at(3, 3).x = std::numeric_limits<float>::infinity();
  writer.submit({1, image, {}});
  CHECK_THROWS_WITH(writer.finish(), Catch::Contains("1 pixel is not finite"));
  CHECK(directory.entries() == 0);
}

TEST_CASE("nothing can be submitted after the end") {
  FrameWriter writer({});
  writer.finish();
  CHECK_THROWS_AS(writer.submit({1, picture_of(1), {}}), std::logic_error);
}

}  // namespace pprt::frame_writer_test
