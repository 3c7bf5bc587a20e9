#include "convert/convert.h"

#include <catch2/catch.hpp>

#include <sstream>
#include <string>

#include "base/diagnostics.h"
#include "cli/scene_source.h"
#include "image/atomic_file.h"
#include "scene/nff_writer.h"
#include "spd/spd.h"
#include "unit/image/temporary_directory.h"

using namespace pprt;

namespace {

// Names in a folder that is gone with its scope.
struct Folder {
  TemporaryDirectory directory;

  std::string file(const std::string& name) const { return (directory.path() / name).string(); }
};

std::string nff(const SceneDescription& scene) {
  std::ostringstream out;
  write_nff(scene, out);
  return out.str();
}

}  // namespace

TEST_CASE("every database is unchanged to the byte after writing and reading NFF") {
  for (const SpdDatabase& database : spd_databases()) {
    CAPTURE(database.name);
    const std::string canonical = nff(make_spd(database.name, 3));
    const ParsedScene read = parse_nff(canonical, "canonical.nff", {.strict = true});
    CHECK(read.warnings.empty());
    CHECK((nff(read.scene) == canonical));
  }
}

TEST_CASE("a database converts to NFF, and that file to an equal one") {
  const Folder folder;
  convert({"spd:mount:3", folder.file("a.nff"), false, {}, {}});
  convert({folder.file("a.nff"), folder.file("b.NFF"), true, {}, {}});
  const std::string expected = nff(make_spd("mount", 3));
  CHECK((read_whole_file(folder.file("a.nff")) == expected));
  CHECK((read_whole_file(folder.file("b.NFF")) == expected));
}

TEST_CASE("a scene file may be converted in place") {
  const Folder folder;
  const std::string view = "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\nresolution 8 8\n";
  write_whole_file(folder.file("a.nff"), "# a comment\n" + view + "s 0.50 0 0 1.000\n");
  convert({folder.file("a.nff"), folder.file("a.nff"), false, {}, {}});
  CHECK(read_whole_file(folder.file("a.nff")) == view + "f 1 1 1 1 0 0 0 1\ns 0.5 0 0 1\n");
}

TEST_CASE("a scene without a view gets one, but no lights") {
  const Folder folder;
  write_whole_file(folder.file("a.nff"), "s 0.5 0 0 1\n");
  convert({folder.file("a.nff"), folder.file("b.nff"), false, {}, {}});
  const SceneDescription scene = read_nff(folder.file("b.nff")).scene;
  REQUIRE(scene.view);
  CHECK(scene.view->at == Vec3d(0.5, 0, 0));
  CHECK(scene.lights.empty());
}

TEST_CASE("an output name that ends in .pov is written in POV-Ray's language") {
  const Folder folder;
  convert({"spd:jacks:1", folder.file("a.POV"), false, {}, {}});
  CHECK(read_whole_file(folder.file("a.POV")).find("#version 3.7;") != std::string::npos);
}

TEST_CASE("a rejected scene leaves the existing output as it was") {
  const Folder folder;
  write_whole_file(folder.file("in.nff"), "s 0 0 zero 1\n");
  write_whole_file(folder.file("out.nff"), "older");
  CHECK_THROWS_AS(convert({folder.file("in.nff"), folder.file("out.nff"), false, {}, {}}), InputError);
  CHECK(read_whole_file(folder.file("out.nff")) == "older");
}

TEST_CASE("an unknown format is a usage error before anything is read") {
  CHECK_THROWS_AS(convert({"missing.png", "out.nff", false, {}, {}}), UsageError);
  CHECK_THROWS_AS(convert({"missing", "out.nff", false, {}, {}}), UsageError);
  CHECK_THROWS_AS(convert({"missing.nff", "out.mov", false, {}, {}}), UsageError);
  CHECK_THROWS_AS(convert({"missing.nff", "spd:tree", false, {}, {}}), UsageError);
  CHECK_THROWS_AS(convert({"missing.nff", "", false, {}, {}}), UsageError);
}

TEST_CASE("a scene is loaded from a database or from a file") {
  const Folder folder;
  write_whole_file(folder.file("one.nff"), "f 1 1 1 1 0 0 0 1\ns 0 0 0 1\n");
  CHECK(load_scene("spd:tree:2").scene.name == "spd:tree:2");
  CHECK(load_scene(folder.file("one.nff")).scene.spheres.size() == 1);
  CHECK_THROWS_AS(load_scene("spd:nothing"), InputError);
  CHECK_THROWS_AS(load_scene(folder.file("missing.nff")), InputError);
}
