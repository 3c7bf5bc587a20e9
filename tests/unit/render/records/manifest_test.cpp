#include <catch2/catch.hpp>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "base/diagnostics.h"
#include "render/records/manifest.h"
#include "unit/image/temporary_directory.h"

namespace pprt {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

void append(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::app) << text;
}

constexpr const char* kFirstLine = "{\"record\":\"run\",\"format\":1,\"key\":\"key\"}\n";

// As little as a picture needs to look whole.
constexpr const char* kPng = "\x89PNG\r\n\x1a\n....IEND\xae\x42\x60\x82";
constexpr const char* kExr = "\x76\x2f\x31\x01....";

// A run that has written frames 1 to 3, with the pictures.
struct FinishedRun {
  TemporaryDirectory directory;
  fs::path path = directory.path() / "manifest.ndjson";

  FinishedRun() {
    Manifest manifest(path, "key", ExistingFiles::kReplace);
    for (const int frame : {1, 2, 3}) {
      append(picture(frame), kPng);
      manifest.add({{frame, {picture(frame)}}});
    }
  }
  fs::path picture(int frame) const { return directory.path() / (std::to_string(frame) + ".png"); }
  std::vector<FramePattern> outputs(const std::string& extension = "png") const {
    return {parse_frame_pattern((directory.path() / "#.").string() + extension, FrameCount::kMany)};
  }
  std::set<int> finished(const Manifest& manifest) const {
    std::set<int> frames;
    for (int frame = 1; frame < 10; ++frame) {
      if (manifest.has(frame, outputs())) frames.insert(frame);
    }
    return frames;
  }
  std::set<int> resumed() const { return finished(Manifest(path, "key", ExistingFiles::kResume)); }
};

}  // namespace

TEST_CASE("the manifest's path is derived from the frames' pattern") {
  const auto path = [](const char* pattern) {
    return manifest_path(parse_frame_pattern(pattern, FrameCount::kOne));
  };
  CHECK(path("out/%04d.exr") == "out/manifest.ndjson");
  CHECK(path("frame_####.png") == "frame_manifest.ndjson");
  CHECK(path("out/a%db.png") == "out/amanifest.ndjson");
}

TEST_CASE("a resumed run knows the frames that the manifest lists as finished") {
  const FinishedRun run;
  CHECK(run.resumed() == std::set<int>{1, 2, 3});
  append(run.picture(7), kPng);
  Manifest(run.path, "key", ExistingFiles::kResume).add({{7, {run.picture(7)}}});
  CHECK(run.resumed() == std::set<int>{1, 2, 3, 7});
}

TEST_CASE("a frame whose files are all written anew is listed no more") {
  const FinishedRun run;
  std::set<std::string> rewritten;
  for (const int frame : {1, 2, 3}) rewritten.insert(run.picture(frame).string());
  Manifest(run.path, "key", ExistingFiles::kReplace, rewritten);
  CHECK(text_of(run.path) == kFirstLine);
}

TEST_CASE("a frame whose picture was deleted is not finished") {
  const FinishedRun run;
  fs::remove(run.picture(2));
  CHECK(run.resumed() == std::set<int>{1, 3});
}

TEST_CASE("a frame is finished when it was written under every output that is wanted now") {
  const FinishedRun run;
  Manifest manifest(run.path, "key", ExistingFiles::kResume);
  std::vector<FramePattern> both = run.outputs();
  both.push_back(run.outputs("exr").front());
  CHECK((manifest.has(1, run.outputs()) && !manifest.has(1, run.outputs("exr")) && !manifest.has(1, both)));
  // Runs that wrote one format each have together written both.
  const fs::path exr = run.directory.path() / "1.exr";
  append(exr, kExr);
  manifest.add({{1, {exr}}});
  const Manifest later(run.path, "key", ExistingFiles::kResume);
  CHECK(later.has(1, both));
  CHECK_FALSE(later.has(2, both));
}

TEST_CASE("an EXR is finished only when it holds all layers that are wanted now") {
  const FinishedRun run;
  const fs::path exr = run.directory.path() / "1.exr";
  append(exr, kExr);
  Manifest(run.path, "key", ExistingFiles::kResume).add({{1, {exr}, {"age", "depth"}}});
  const Manifest later(run.path, "key", ExistingFiles::kResume);
  CHECK(later.has(1, run.outputs("exr")));
  CHECK(later.has(1, run.outputs("exr"), {"depth"}));
  CHECK_FALSE(later.has(1, run.outputs("exr"), {"depth", "id"}));
  // A PNG holds none: its layers are files of their own.
  CHECK(later.has(1, run.outputs(), {"depth"}));
}

TEST_CASE("an incomplete line of a manifest is skipped, and lines after it are read") {
  const FinishedRun run;
  append(run.path, R"({"record":"frame","frame":4,"fi)");
  append(run.picture(5), kPng);
  {
    Manifest manifest(run.path, "key", ExistingFiles::kResume);
    CHECK(run.finished(manifest) == std::set<int>{1, 2, 3});
    manifest.add({{5, {run.picture(5)}}});
  }
  CHECK(run.resumed() == std::set<int>{1, 2, 3, 5});
}

TEST_CASE("a manifest of another scene or other options cannot be resumed") {
  const FinishedRun run;
  CHECK_THROWS_AS(Manifest(run.path, "other", ExistingFiles::kResume), UsageError);
  CHECK(run.resumed().size() == 3);  // nothing was lost by trying
}

TEST_CASE("a manifest of another format cannot be resumed") {
  const FinishedRun run;
  std::string text = text_of(run.path);
  text.replace(text.find("\"format\":1"), 10, "\"format\":2");
  std::ofstream(run.path, std::ios::trunc) << text;
  CHECK_THROWS_WITH(Manifest(run.path, "key", ExistingFiles::kResume),
                    Catch::Contains("another version of pprt-render"));
  CHECK(text_of(run.path) == text);
  Manifest(run.path, "key", ExistingFiles::kRefuse);  // a run of its own
  CHECK(text_of(run.path) == kFirstLine);
}

TEST_CASE("a manifest whose first line never came counts as none") {
  const FinishedRun run;
  for (const std::string& text : {std::string(), std::string("{\"record\":\"ru"), std::string(100, '\0')}) {
    for (const ExistingFiles existing : {ExistingFiles::kRefuse, ExistingFiles::kResume}) {
      std::ofstream(run.path, std::ios::trunc) << text;
      CHECK(run.finished(Manifest(run.path, "key", existing)).empty());
      CHECK(text_of(run.path) == kFirstLine);
    }
  }
}

TEST_CASE("a file that is no manifest is replaced only when asked for") {
  const FinishedRun run;
  for (const char* text : {"\n\n", "[1, 2]\n", "{\"record\":\"frame\",\"frame\":1}\n", "notes\nof mine\n"}) {
    INFO("text '" << text << "'");
    std::ofstream(run.path, std::ios::trunc) << text;
    CHECK_THROWS_AS(Manifest(run.path, "key", ExistingFiles::kRefuse), UsageError);
    CHECK_THROWS_AS(Manifest(run.path, "key", ExistingFiles::kResume), UsageError);
    CHECK(text_of(run.path) == text);
    const Manifest manifest(run.path, "key", ExistingFiles::kReplace);
    CHECK(text_of(run.path) == kFirstLine);
  }
}

TEST_CASE("a frame whose picture is empty or torn is not finished") {
  const FinishedRun run;
  std::ofstream(run.picture(1), std::ios::trunc) << "";
  std::ofstream(run.picture(2), std::ios::trunc) << std::string(kPng).substr(0, 19);
  CHECK(run.resumed() == std::set<int>{3});
}

TEST_CASE("a manifest grows with every run of the same key and forgets files that are written anew") {
  const FinishedRun run;
  for (const ExistingFiles existing : {ExistingFiles::kRefuse, ExistingFiles::kReplace}) {
    Manifest manifest(run.path, "key", existing, {run.picture(2).string()});
    CHECK(run.finished(manifest) == std::set<int>{1, 3});
    CHECK(run.resumed() == std::set<int>{1, 3});
    manifest.add({{2, {run.picture(2)}}});
    CHECK(run.resumed() == std::set<int>{1, 2, 3});
  }
  // A resumed run keeps what it finds.
  CHECK(run.finished(Manifest(run.path, "key", ExistingFiles::kResume, {run.picture(2).string()})) ==
        std::set<int>{1, 2, 3});
}

TEST_CASE("of a frame that is written anew in one format the other format stays finished") {
  const FinishedRun run;
  const fs::path exr = run.directory.path() / "1.exr";
  append(exr, kExr);
  Manifest(run.path, "key", ExistingFiles::kResume).add({{1, {run.picture(1), exr}, {"age"}}});
  const Manifest manifest(run.path, "key", ExistingFiles::kReplace, {run.picture(1).string()});
  const Manifest later(run.path, "key", ExistingFiles::kResume);
  CHECK_FALSE(later.has(1, run.outputs()));
  CHECK(later.has(1, run.outputs("exr"), {"age"}));
}

TEST_CASE("a file name that is no UTF-8 is found again") {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "manifest.ndjson";
  const std::string name = (directory.path() / "K\xe4se\xff").string();
  const std::vector<FramePattern> outputs = {parse_frame_pattern(name + "#.png", FrameCount::kMany)};
  append(name + "1.png", kPng);
  Manifest(path, "key", ExistingFiles::kRefuse).add({{1, {name + "1.png"}}});
  CHECK(Manifest(path, "key", ExistingFiles::kResume).has(1, outputs));
}

TEST_CASE("lines of a manifest that are JSON but not records are skipped") {
  const FinishedRun run;
  append(run.path, "17\n{\"record\":\"frame\"}\n{\"record\":\"frame\",\"frame\":\"x\",\"files\":3}\n");
  CHECK(run.resumed() == std::set<int>{1, 2, 3});
}

TEST_CASE("without --resume a manifest of another key is replaced") {
  const FinishedRun run;
  CHECK(run.finished(Manifest(run.path, "other", ExistingFiles::kReplace)).empty());
  CHECK(text_of(run.path) == "{\"record\":\"run\",\"format\":1,\"key\":\"other\"}\n");
}

TEST_CASE("resuming without a manifest begins a new run") {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "manifest.ndjson";
  const Manifest manifest(path, "key", ExistingFiles::kResume);
  CHECK(text_of(path) == kFirstLine);
}

}  // namespace pprt
