#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "base/diagnostics.h"
#include "image/checksum.h"
#include "render/records/manifest.h"
#include "unit/image/temporary_directory.h"

namespace pprt::manifest_test {
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

constexpr const char* kFirstLine = "{\"record\":\"run\",\"format\":2,\"key\":\"key\"}\n";

// Any bytes will do for a picture.
constexpr const char* kPng = "as a PNG";
constexpr const char* kExr = "as an EXR";

Manifest begun(const fs::path& path, const std::string& key, ExistingFiles existing,
               const std::set<std::string>& rewritten = {}) {
  return Manifest(EarlierManifest(path, key, existing, rewritten));
}

// A frame of these files as they are now.
WrittenFrame written(int frame, const std::vector<fs::path>& files, std::vector<std::string> layers = {}) {
  WrittenFrame result{frame, {}, std::move(layers)};
  for (const fs::path& file : files) result.files.push_back({file, crc32_of_file(file).value()});
  return result;
}

// A run that has written frames 1 to 3, with the pictures.
struct FinishedRun {
  TemporaryDirectory directory;
  fs::path path = directory.path() / "manifest.ndjson";

  FinishedRun() {
    Manifest manifest = begun(path, "key", ExistingFiles::kReplace);
    for (const int frame : {1, 2, 3}) {
      append(picture(frame), kPng);
      manifest.add({written(frame, {picture(frame)})});
    }
  }
  fs::path picture(int frame) const { return directory.path() / (std::to_string(frame) + ".png"); }
  std::vector<FramePattern> outputs(const std::string& extension = "png") const {
    return {parse_frame_pattern((directory.path() / "#.").string() + extension, FrameCount::kMany)};
  }
  std::set<int> finished(const EarlierManifest& manifest) const {
    std::set<int> frames;
    for (int frame = 1; frame < 10; ++frame) {
      if (manifest.has(frame, outputs())) frames.insert(frame);
    }
    return frames;
  }
  std::set<int> resumed() const { return finished(EarlierManifest(path, "key", ExistingFiles::kResume)); }
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
  begun(run.path, "key", ExistingFiles::kResume).add({written(7, {run.picture(7)})});
  CHECK(run.resumed() == std::set<int>{1, 2, 3, 7});
}

TEST_CASE("a frame whose files are all written anew is listed no more") {
  const FinishedRun run;
  std::set<std::string> rewritten;
  for (const int frame : {1, 2, 3}) rewritten.insert(run.picture(frame).string());
  Manifest(EarlierManifest(run.path, "key", ExistingFiles::kReplace, rewritten));
  CHECK(text_of(run.path) == kFirstLine);
}

TEST_CASE("a frame whose picture was deleted is not finished") {
  const FinishedRun run;
  fs::remove(run.picture(2));
  CHECK(run.resumed() == std::set<int>{1, 3});
}

TEST_CASE("a frame is finished when it was written under every output that is wanted now") {
  const FinishedRun run;
  std::vector<FramePattern> both = run.outputs();
  both.push_back(run.outputs("exr").front());
  // Runs that wrote one format each have together written both.
  const fs::path exr = run.directory.path() / "1.exr";
  append(exr, kExr);
  {
    EarlierManifest earlier(run.path, "key", ExistingFiles::kResume);
    CHECK((earlier.has(1, run.outputs()) && !earlier.has(1, run.outputs("exr")) && !earlier.has(1, both)));
    Manifest(std::move(earlier)).add({written(1, {exr})});
  }
  const EarlierManifest later(run.path, "key", ExistingFiles::kResume);
  CHECK(later.has(1, both));
  CHECK_FALSE(later.has(2, both));
}

TEST_CASE("an EXR is finished only when it holds all layers that are wanted now") {
  const FinishedRun run;
  const fs::path exr = run.directory.path() / "1.exr";
  append(exr, kExr);
  begun(run.path, "key", ExistingFiles::kResume).add({written(1, {exr}, {"age", "depth"})});
  const EarlierManifest later(run.path, "key", ExistingFiles::kResume);
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
    EarlierManifest earlier(run.path, "key", ExistingFiles::kResume);
    CHECK(run.finished(earlier) == std::set<int>{1, 2, 3});
    Manifest(std::move(earlier)).add({written(5, {run.picture(5)})});
  }
  CHECK(run.resumed() == std::set<int>{1, 2, 3, 5});
}

TEST_CASE("a manifest of another scene or other options cannot be resumed") {
  const FinishedRun run;
  CHECK_THROWS_AS(EarlierManifest(run.path, "other", ExistingFiles::kResume), UsageError);
  CHECK(run.resumed().size() == 3);  // nothing was lost by trying
}

TEST_CASE("a manifest of another format cannot be resumed") {
  const FinishedRun run;
  std::string text = text_of(run.path);
  text.replace(text.find("\"format\":2"), 10, "\"format\":1");
  std::ofstream(run.path, std::ios::trunc) << text;
  CHECK_THROWS_WITH(EarlierManifest(run.path, "key", ExistingFiles::kResume),
                    Catch::Contains("another version of pprt-render"));
  CHECK(text_of(run.path) == text);
  begun(run.path, "key", ExistingFiles::kRefuse);  // a run of its own
  CHECK(text_of(run.path) == kFirstLine);
}

TEST_CASE("a manifest whose first line never came counts as none") {
  const FinishedRun run;
  for (const std::string& text : {std::string(), std::string("{\"record\":\"ru"), std::string(100, '\0')}) {
    for (const ExistingFiles existing : {ExistingFiles::kRefuse, ExistingFiles::kResume}) {
      std::ofstream(run.path, std::ios::trunc) << text;
      EarlierManifest earlier(run.path, "key", existing);
      CHECK(run.finished(earlier).empty());
      const Manifest manifest(std::move(earlier));
      CHECK(text_of(run.path) == kFirstLine);
    }
  }
}

TEST_CASE("a file that is no manifest is replaced only when asked for") {
  const FinishedRun run;
  for (const char* text : {"\n\n", "[1, 2]\n", "{\"record\":\"frame\",\"frame\":1}\n", "notes\nof mine\n"}) {
    INFO("text '" << text << "'");
    std::ofstream(run.path, std::ios::trunc) << text;
    CHECK_THROWS_AS(EarlierManifest(run.path, "key", ExistingFiles::kRefuse), UsageError);
    CHECK_THROWS_AS(EarlierManifest(run.path, "key", ExistingFiles::kResume), UsageError);
    CHECK(text_of(run.path) == text);
    begun(run.path, "key", ExistingFiles::kReplace);
    CHECK(text_of(run.path) == kFirstLine);
  }
}

TEST_CASE("a frame whose picture is empty, cut, zeroed or changed inside is not finished") {
  const FinishedRun run;
  const std::string whole = kPng;
  std::string changed = whole;
  changed[4] ^= 1;
  for (const std::string& damaged : {std::string(), whole.substr(0, 4),
                                     whole.substr(0, 4) + std::string(4, '\0'), changed, whole + "more"}) {
    INFO("picture '" << damaged << "'");
    std::ofstream(run.picture(1), std::ios::trunc) << damaged;
    CHECK(run.resumed() == std::set<int>{2, 3});
  }
  std::ofstream(run.picture(1), std::ios::trunc) << whole;
  CHECK(run.resumed() == std::set<int>{1, 2, 3});
}

TEST_CASE("a frame whose name belongs to a pipe or a directory is not finished, and nothing waits for it") {
  const FinishedRun run;
  fs::remove(run.picture(1)), fs::remove(run.picture(2));
  REQUIRE(mkfifo(run.picture(1).c_str(), 0600) == 0);
  fs::create_directory(run.picture(2));
  CHECK(run.resumed() == std::set<int>{3});
}

TEST_CASE("a manifest that is a pipe is refused, and nothing waits for it") {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "manifest.ndjson";
  REQUIRE(mkfifo(path.c_str(), 0600) == 0);
  CHECK_THROWS_WITH(EarlierManifest(path, "key", ExistingFiles::kResume),
                    Catch::Contains("it is not a regular file"));
}

TEST_CASE("frames of another run in the same manifest are not finished") {
  const FinishedRun run;
  std::string text = text_of(run.path);
  const std::size_t of_frame_2 = text.find("\"key\":\"key\"", text.find("\"frame\":2"));
  text.replace(of_frame_2, 11, "\"key\":\"other\"");
  std::ofstream(run.path, std::ios::trunc) << text;
  CHECK(run.resumed() == std::set<int>{1, 3});
}

TEST_CASE("a run keeps others from its manifest as long as it lasts") {
  const auto expect_refusal = [](const fs::path& path, ExistingFiles existing) {
    CHECK_THROWS_WITH(EarlierManifest(path, "key", existing),
                      Catch::Contains("another run is writing to it"));
  };
  const FinishedRun run;
  {
    const EarlierManifest earlier(run.path, "key", ExistingFiles::kResume);
    expect_refusal(run.path, ExistingFiles::kResume);  // before it has begun
  }
  {
    const Manifest manifest = begun(run.path, "key", ExistingFiles::kResume);
    expect_refusal(run.path, ExistingFiles::kResume);
    expect_refusal(run.path, ExistingFiles::kReplace);
  }
  CHECK(run.resumed() == std::set<int>{1, 2, 3});

  // Two that begin together: neither has found a manifest.
  const fs::path path = run.directory.path() / "new.ndjson";
  EarlierManifest one(path, "one", ExistingFiles::kRefuse), two(path, "two", ExistingFiles::kRefuse);
  const Manifest first(std::move(one));
  const std::string text = text_of(path);
  CHECK_THROWS_WITH(Manifest(std::move(two)), Catch::Contains("another run is writing to it"));
  CHECK(text_of(path) == text);
}

TEST_CASE("a manifest that is removed, renamed or replaced in mid-run is missed") {
  const FinishedRun run;
  const WrittenFrame frame = written(1, {run.picture(1)});
  for (const bool is_replaced : {false, true}) {
    Manifest manifest = begun(run.path, "key", ExistingFiles::kReplace);
    manifest.add({frame});
    fs::rename(run.path, run.directory.path() / "elsewhere");
    if (is_replaced) append(run.path, "notes\n");
    CHECK_THROWS_WITH(manifest.add({frame}), Catch::Contains("removed, renamed or replaced"));
  }
}

TEST_CASE("a manifest grows with every run of the same key and forgets files that are written anew") {
  const FinishedRun run;
  for (const ExistingFiles existing : {ExistingFiles::kRefuse, ExistingFiles::kReplace}) {
    EarlierManifest earlier(run.path, "key", existing, {run.picture(2).string()});
    CHECK(run.finished(earlier) == std::set<int>{1, 3});
    { const Manifest manifest(std::move(earlier)); }
    CHECK(run.resumed() == std::set<int>{1, 3});
    begun(run.path, "key", ExistingFiles::kResume).add({written(2, {run.picture(2)})});
    CHECK(run.resumed() == std::set<int>{1, 2, 3});
  }
  // A resumed run keeps what it finds.
  CHECK(run.finished(EarlierManifest(run.path, "key", ExistingFiles::kResume, {run.picture(2).string()})) ==
        std::set<int>{1, 2, 3});
}

TEST_CASE("of a frame that is written anew in one format the other format stays finished") {
  const FinishedRun run;
  const fs::path exr = run.directory.path() / "1.exr";
  append(exr, kExr);
  begun(run.path, "key", ExistingFiles::kResume).add({written(1, {run.picture(1), exr}, {"age"})});
  begun(run.path, "key", ExistingFiles::kReplace, {run.picture(1).string()});
  const EarlierManifest later(run.path, "key", ExistingFiles::kResume);
  CHECK_FALSE(later.has(1, run.outputs()));
  CHECK(later.has(1, run.outputs("exr"), {"age"}));
}

TEST_CASE("a file name that is no UTF-8 is found again") {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "manifest.ndjson";
  const std::string name = (directory.path() / "K\xe4se\xff").string();
  const std::vector<FramePattern> outputs = {parse_frame_pattern(name + "#.png", FrameCount::kMany)};
  append(name + "1.png", kPng);
  begun(path, "key", ExistingFiles::kRefuse).add({written(1, {name + "1.png"})});
  CHECK(EarlierManifest(path, "key", ExistingFiles::kResume).has(1, outputs));
}

TEST_CASE("lines of a manifest that are JSON but not records are skipped") {
  const FinishedRun run;
  append(run.path, "17\n{\"record\":\"frame\"}\n{\"record\":\"frame\",\"frame\":\"x\",\"files\":3}\n");
  CHECK(run.resumed() == std::set<int>{1, 2, 3});
}

TEST_CASE("of a manifest's records only those of frames tell of frames") {
  const FinishedRun run;
  append(run.picture(7), kPng);
  begun(run.path, "key", ExistingFiles::kResume).add({written(7, {run.picture(7)})});
  REQUIRE(run.resumed() == std::set<int>{1, 2, 3, 7});
  std::string text = text_of(run.path);
  const std::string frame = R"("record":"frame")";
  text.replace(text.rfind(frame), frame.size(), R"("record":"other")");
  std::ofstream(run.path) << text;
  CHECK(run.resumed() == std::set<int>{1, 2, 3});
}

TEST_CASE("without --resume a manifest of another key is replaced") {
  const FinishedRun run;
  EarlierManifest earlier(run.path, "other", ExistingFiles::kReplace);
  CHECK(run.finished(earlier).empty());
  const Manifest manifest(std::move(earlier));
  CHECK(text_of(run.path) == "{\"record\":\"run\",\"format\":2,\"key\":\"other\"}\n");
}

TEST_CASE("resuming without a manifest begins a new run") {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "manifest.ndjson";
  begun(path, "key", ExistingFiles::kResume);
  CHECK(text_of(path) == kFirstLine);
}

}  // namespace pprt::manifest_test
