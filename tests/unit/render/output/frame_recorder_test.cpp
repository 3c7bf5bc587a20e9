// Which frames are told of as finished when some could not be written.
#include "render/output/frame_recorder.h"

#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <string>
#include <thread>

#include "image/contact_sheet.h"
#include "image/image_io.h"
#include "parser/nff_parser.h"
#include "unit/image/temporary_directory.h"
#include "unit/render/records/printed_text.h"

namespace pprt::frame_recorder_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScene =
    "v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 8 8\n"
    "b 0 0 1\nl 5 5 5\nf 1 1 1 1 0 0 0 1\ns 0 0 0 1\n";

// A run of three frames into a directory of its own.
struct ThreeFrames {
  TemporaryDirectory directory;
  RenderPlan plan;
  CompiledScene scene;
  ProgressReporter progress{ProgressKind::kNone};

  ThreeFrames() : scene((plan.scene = parse_nff(kScene, "t.nff").scene, compile(plan.scene, {}))) {
    for (const int number : {1, 2, 3}) plan.frames.push_back({.number = number, .view = *plan.scene.view});
    plan.script_frames = plan.frames;
    const std::string name = (directory.path() / "out/%d.png").string();
    plan.output.pictures = {parse_frame_pattern(name, FrameCount::kMany)};
  }
  fs::path picture(int frame) const { return directory.path() / "out" / (std::to_string(frame) + ".png"); }

  static void record(FrameRecorder& recorder, int number) {
    FinishedFrame frame;
    frame.order.number = number;
    frame.image = Image(8, 8, Color(0.5F, 0.5F, 0.5F));
    recorder.record(std::move(frame));
  }

  // Numbers of the frames that the manifest tells of.
  std::set<int> told() const {
    std::set<int> frames;
    std::ifstream manifest(directory.path() / "out/manifest.ndjson");
    for (std::string line; std::getline(manifest, line);) {
      const Json record = Json::parse(line);
      if (record["record"] == "frame") frames.insert(record["frame"].get<int>());
    }
    return frames;
  }
};

}  // namespace

TEST_CASE("frames written after one that could not be are in the manifest") {
  ThreeFrames run;
  FrameRecorder recorder({run.plan, 1, "hash"}, run.scene, run.progress);
  fs::create_directory(run.picture(2));
  for (const int number : {1, 2, 3}) run.record(recorder, number);
  CHECK_THROWS_WITH(recorder.finish(false), Catch::Contains("2.png': it is a directory"));
  CHECK(run.told() == std::set<int>{1, 3});
}

TEST_CASE("frames whose directory is removed in mid-run are missed") {
  ThreeFrames run;
  FrameRecorder recorder({run.plan, 1, "hash"}, run.scene, run.progress);
  run.record(recorder, 1);
  while (!fs::exists(run.picture(1))) std::this_thread::yield();
  fs::remove_all(run.directory.path() / "out");
  for (const int number : {2, 3}) run.record(recorder, number);
  CHECK_THROWS_WITH(recorder.finish(false), Catch::Contains("removed, renamed or replaced"));
}

TEST_CASE("an EXR has its frame's figures in its header, but for those that rest on the frames before") {
  ThreeFrames run;
  const std::string name = (run.directory.path() / "out/%d.exr").string();
  run.plan.output.pictures.push_back(parse_frame_pattern(name, FrameCount::kMany));
  FrameRecorder recorder({run.plan, 1, "hash"}, run.scene, run.progress);
  // The third was measured by few probes, though by more with those of the frames before.
  for (const int number : {2, 3}) {
    FinishedFrame frame;
    frame.order.number = number, frame.order.cut = true;
    frame.image = Image(8, 8);
    frame.late_ranks = {3, 5};
    frame.late_ms = 1.25;
    frame.ranks.resize(1);
    frame.ranks[0].samples_new = 70, frame.ranks[0].rays.shadow = 90;
    frame.error.emplace();
    frame.error->frame = {.squared = 0.01, .variance = 1e-6, .probes = 100};
    frame.error->own = {.squared = 0.01, .variance = 1e-6, .probes = number == 2 ? 50.0 : 2.0};
    recorder.record(std::move(frame));
  }
  recorder.finish(false);
  const Imf::InputFile file((run.directory.path() / "out/2.exr").c_str());
  const Imf::Header& header = file.header();
  CHECK(header.typedAttribute<Imf::IntAttribute>("pprt.frame").value() == 2);
  CHECK(header.typedAttribute<Imf::IntAttribute>("pprt.cut").value() == 1);
  CHECK(header.typedAttribute<Imf::IntAttribute>("pprt.samples_new").value() == 70);
  CHECK(header.typedAttribute<Imf::IntAttribute>("pprt.rays.shadow").value() == 90);
  CHECK(header.typedAttribute<Imf::DoubleAttribute>("pprt.late_ms").value() == 1.25);
  CHECK(header.typedAttribute<Imf::StringAttribute>("pprt.late_ranks").value() == "[3,5]");
  CHECK(header.find("pprt.error.rmse") != header.end());
  CHECK(header.find("pprt.error.probes") != header.end());
  for (const char* left_out : {"pprt.record", "pprt.error.low", "pprt.error.high", "pprt.error.shot.rmse",
                               "pprt.error.unexpected"}) {
    INFO(left_out);
    CHECK(header.find(left_out) == header.end());
  }
  const Imf::InputFile third((run.directory.path() / "out/3.exr").c_str());
  CHECK(third.header().find("pprt.error.rmse") == third.header().end());
  CHECK(third.header().find("pprt.error.probes") != third.header().end());
}

TEST_CASE("frames that are removed in mid-run are missed, though the manifest stays") {
  ThreeFrames run;
  FrameRecorder recorder({run.plan, 1, "hash"}, run.scene, run.progress);
  run.record(recorder, 1);
  while (!fs::exists(run.picture(1))) std::this_thread::yield();
  fs::remove(run.picture(1));
  for (const int number : {2, 3}) run.record(recorder, number);
  CHECK_THROWS_WITH(recorder.finish(false), "of 3 frames written, 1 is not there any more");
}

TEST_CASE("a frame is missed as soon as one of its files is removed") {
  ThreeFrames run;
  const std::string twin = (run.directory.path() / "out/b%d.png").string();
  run.plan.output.pictures.push_back(parse_frame_pattern(twin, FrameCount::kMany));
  FrameRecorder recorder({run.plan, 1, "hash"}, run.scene, run.progress);
  run.record(recorder, 1);
  const fs::path second = run.directory.path() / "out/b1.png";
  while (!fs::exists(second)) std::this_thread::yield();
  fs::remove(second);
  for (const int number : {2, 3}) run.record(recorder, number);
  CHECK_THROWS_WITH(recorder.finish(false), "of 3 frames written, 1 is not there any more");
}

TEST_CASE("frames that the manifest does not tell of do not count as written") {
  ThreeFrames run;
  ProgressReporter told(ProgressKind::kAuto);
  const std::string text = printed_by([&] {
    FrameRecorder recorder({run.plan, 1, "hash"}, run.scene, told);
    fs::rename(run.directory.path() / "out/manifest.ndjson", run.directory.path() / "elsewhere");
    for (const int number : {1, 2, 3}) run.record(recorder, number);
    CHECK_THROWS_WITH(recorder.finish(false), Catch::Contains("removed, renamed or replaced"));
  });
  CHECK(text.starts_with("failed: 0 of 3 frames in "));
  for (const int number : {1, 2, 3}) CHECK(fs::exists(run.picture(number)));
}

TEST_CASE("at the end people are told the first and the last file, in each format") {
  ThreeFrames run;
  const std::string second = (run.directory.path() / "out/b%d.png").string();
  run.plan.output.pictures.push_back(parse_frame_pattern(second, FrameCount::kMany));
  ProgressReporter told(ProgressKind::kAuto);
  const std::string text = printed_by([&] {
    FrameRecorder recorder({run.plan, 1, "hash"}, run.scene, told);
    for (const int number : {1, 2, 3}) run.record(recorder, number);
    recorder.finish(false);
  });
  const std::string out = (run.directory.path() / "out").string();
  CHECK(text.starts_with("done: 3 of 3 frames in " + out + "/1.png to " + out + "/3.png, " + out +
                         "/b1.png to " + out + "/b3.png;"));
}

TEST_CASE("a contact sheet shows the frames as the first format has them, numbered as they are") {
  // Stripes of nothing and of four times white: where both are cut to what a display shows their mean is
  // grey.
  ThreeFrames run;
  const std::string second = (run.directory.path() / "out/%d.exr").string();
  run.plan.output.pictures.push_back(parse_frame_pattern(second, FrameCount::kMany));
  run.plan.output.contact_sheet = run.directory.path() / "sheet.png";
  FrameRecorder recorder({run.plan, 1, "hash"}, run.scene, run.progress);
  const int width = 4 * ContactSheetLayout().thumbnail_width;
  for (const int number : {1, 2}) {
    FinishedFrame frame;
    frame.order.number = number;
    frame.image = Image(width, 8);
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < width; ++x) frame.image.at(x, y) = Color(x % 2 == 0 ? 0.0F : 4.0F);
    recorder.record(std::move(frame));
  }
  recorder.finish(false);
  const Image sheet = read_image(run.plan.output.contact_sheet);
  std::vector<Image> expected;
  for (const int number : {1, 2})
    expected.push_back(thumbnail(read_image(run.picture(number)), ContactSheetLayout().thumbnail_width));
  const std::filesystem::path other = run.directory.path() / "expected.png";
  write_image(other, contact_sheet(expected, ContactSheetLayout(), std::vector{1, 2}));
  CHECK(sheet.pixels == read_image(other).pixels);
}

TEST_CASE("a run that fails tells of no film, and of the frames by their pattern") {
  ThreeFrames run;
  run.plan.output.film =
      run.directory.path() / "out/1.png/film.mp4";  // below a picture: it cannot be written
  run.plan.output.film_rate = 24;
  ProgressReporter told(ProgressKind::kAuto);
  const std::string text = printed_by([&] {
    FrameRecorder recorder({run.plan, 1, "hash"}, run.scene, told);
    for (const int number : {1, 2, 3}) run.record(recorder, number);
    CHECK_THROWS(recorder.finish(false));
  });
  const std::string out = (run.directory.path() / "out").string();
  CHECK(text.starts_with("failed: 3 of 3 frames in " + out + "/%d.png; "));
  CHECK(text.find("film.mp4") == std::string::npos);
}

TEST_CASE("a run that is stopped says so, and how many of its frames are there") {
  ThreeFrames run;
  ProgressReporter told(ProgressKind::kAuto);
  const std::string text = printed_by([&] {
    FrameRecorder recorder({run.plan, 1, "hash"}, run.scene, told);
    run.record(recorder, 2);
    recorder.finish(true);
  });
  const std::string out = (run.directory.path() / "out").string();
  CHECK(text.starts_with("stopped: 1 of 3 frames in " + out + "/2.png; "));
  ProgressReporter of_none(ProgressKind::kAuto);
  const std::string nothing = printed_by([&] {
    ThreeFrames other;
    FrameRecorder recorder({other.plan, 1, "hash"}, other.scene, of_none);
    recorder.finish(true);
  });
  CHECK(nothing.starts_with("stopped: 0 of 3 frames in "));
  CHECK(nothing.ends_with("/out/%d.png\n"));
}

TEST_CASE("frames that an earlier run has finished are neither written again nor counted, but shown") {
  ThreeFrames run;
  {
    FrameRecorder first({run.plan, 1, "hash"}, run.scene, run.progress);
    CHECK_FALSE(first.finished_before(1));
    for (const int number : {1, 3}) run.record(first, number);
    first.finish(true);
  }
  const auto written = fs::last_write_time(run.picture(1));
  run.plan.output.existing = ExistingFiles::kResume;
  run.plan.output.contact_sheet = run.directory.path() / "sheet.png";
  ProgressReporter told(ProgressKind::kAuto);
  const std::string text = printed_by([&] {
    FrameRecorder recorder({run.plan, 1, "hash"}, run.scene, told);
    CHECK((recorder.finished_before(1) && !recorder.finished_before(2) && recorder.finished_before(3)));
    for (const int number : {1, 2, 3}) run.record(recorder, number);
    CHECK(recorder.totals().frames() == 1);
    recorder.finish(false);
  });
  const std::string out = (run.directory.path() / "out").string();
  CHECK(text.starts_with("done: 1 of 3 frames (2 were there already) in " + out + "/1.png to " + out +
                         "/3.png; "));
  CHECK(fs::last_write_time(run.picture(1)) == written);
  CHECK(run.told() == std::set<int>{1, 2, 3});
  const ContactSheetLayout layout;
  const Image one(8, 8, Color(0.5F, 0.5F, 0.5F));
  const std::vector<Image> three(3, thumbnail(one, layout.thumbnail_width));
  CHECK(read_image(run.plan.output.contact_sheet).width ==
        contact_sheet(three, layout, std::vector{1, 2, 3}).width);
}

TEST_CASE("a frame without the layers that are asked for now is not finished") {
  ThreeFrames run;
  const std::string name = (run.directory.path() / "out/%d.exr").string();
  run.plan.output.pictures = {parse_frame_pattern(name, FrameCount::kMany)};
  {
    FrameRecorder first({run.plan, 1, "hash"}, run.scene, run.progress);
    run.record(first, 1);
    first.finish(true);
  }
  run.plan.output.existing = ExistingFiles::kResume;
  CHECK(FrameRecorder({run.plan, 1, "hash"}, run.scene, run.progress).finished_before(1));
  run.plan.output.layers = {Layer::kDepth};
  CHECK_FALSE(FrameRecorder({run.plan, 1, "hash"}, run.scene, run.progress).finished_before(1));
}

TEST_CASE("the balancing trace has the frames of an earlier run, too") {
  ThreeFrames run;
  const fs::path trace = run.directory.path() / "run.trace";
  run.plan.report.trace = trace;
  const auto traced = [&] {
    std::vector<int> frames;
    std::ifstream lines(trace);
    for (std::string line; std::getline(lines, line);) {
      const Json record = Json::parse(line);
      if (record["record"] == "frame") frames.push_back(record["frame"].get<int>());
    }
    return frames;
  };
  const auto record = [&](const std::vector<int>& numbers) {
    FrameRecorder recorder({run.plan, 1, "hash"}, run.scene, run.progress);
    for (const int number : numbers) run.record(recorder, number);
    recorder.finish(false);
  };
  record({1, 2});
  CHECK(traced() == std::vector{1, 2});
  run.plan.output.existing = ExistingFiles::kResume;
  record({1, 2, 3});
  CHECK(traced() == std::vector{1, 2, 1, 2, 3});
}

}  // namespace pprt::frame_recorder_test
