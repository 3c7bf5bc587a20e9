#include "convert/convert.h"

#include <catch2/catch.hpp>

#include <iostream>
#include <optional>
#include <sstream>
#include <string>

#include "base/diagnostics.h"
#include "cli/scenes/scene_source.h"
#include "convert/model_scene.h"
#include "image/atomic_file.h"
#include "image/image_io.h"
#include "scene/writers/nff_writer.h"
#include "spd/spd.h"
#include "unit/image/temporary_directory.h"

namespace pprt::convert_test {

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

// A textured triangle, a ball that moves from x = 0 to 3 within three seconds, and a stretched ball.
void write_moving_scene(const Folder& folder) {
  write_whole_file(folder.file("t.ppm"), "P3 2 1 255 255 0 0 0 255 102\n");
  write_whole_file(folder.file("a.aff"), R"(
v from 0 0 9 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 8 8
am 1 1 1  l 0 0 20 .5 .25 1  a 1 3 5
fm .5 .5 .5 .5 .5 .5 0 0 0 0 0 0
m vertices 3 0 0 0 1 0 0 0 1 0 texturecoords 1 t.ppm 0 0 triangles 1 0 1 2 0 0 0
fm 0 0 0 .25 .5 0 .5 .25 .125 5 0 0
x ball { s 0 0 0 1 }
k ball { transl 6 -1 -1 0 0 0 0 0 0 0 0 0 0 0 0 1 1 0 0 0 0 0 2 2 0 0 0 0 0 3 3 0 0 0 0 0 4 4 0 0 0 0 0 }
xs 1 2 1 0 0 1 0 0 5 0 { s 0 0 0 1 }
)");
}

// What is told on standard error meanwhile.
class Told {
 public:
  Told() : before_(std::cerr.rdbuf(text_.rdbuf())) {}
  ~Told() { std::cerr.rdbuf(before_); }
  Told(const Told&) = delete;
  Told& operator=(const Told&) = delete;
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::streambuf* before_;
};

ConvertOptions at(const Folder& folder, const std::string& output, std::optional<double> time) {
  return {.input = folder.file("a.aff"),
          .output = folder.file(output),
          .tessellate = {},
          .chord_error = {},
          .at = time};
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
  // The middle is looked at from afar, but for the shift that makes the margins even.
  CHECK((scene.view->at - Vec3d(0.5, 0, 0)).length() < 0.2 * (scene.view->at - scene.view->from).length());
  CHECK(scene.lights.empty());
}

TEST_CASE("what moves is fitted into the view where it is when it begins") {
  SceneDescription scene;
  scene.materials = {{}};
  add_sphere(scene, {{0, 0, 0}, 1, 0, {}});
  scene.nodes = {1};
  scene.movement.nodes.push_back({.parent = 0, .track = "away"});
  MotionTrack& track = scene.movement.tracks["away"];
  for (const double time : {-10.0, 0.0, 10.0, 20.0, 30.0}) {
    VectorKey& key = track.translation.emplace_back();
    key.time = time, key.value = {10 * time, 0, 0};
  }
  scene.movement.times = FrameTimes{.start = 10, .end = 12, .frames = 3};
  REQUIRE(complete_view(scene, UpAxis::kY));
  CHECK((scene.view->at - Vec3d(100, 0, 0)).length() < 1);
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

TEST_CASE("a scene that moves is converted as it is at a time, by default at its start") {
  const Folder folder;
  write_moving_scene(folder);
  const auto ball_at = [&](std::optional<double> time) {
    convert(at(folder, "b.nff", time));
    return read_nff(folder.file("b.nff")).scene.spheres.at(0).center.x;
  };
  CHECK(ball_at({}) == Approx(1));
  CHECK(ball_at(1) == Approx(1));
  CHECK(ball_at(2.5) == Approx(2.5));
  CHECK(ball_at(1000) == Approx(3));
}

TEST_CASE("a time for a scene in which nothing moves is a usage error") {
  const Folder folder;
  write_whole_file(folder.file("a.aff"), "fm 0 0 0 1 1 1 0 0 0 0 0 0 s 0 0 0 1\n");
  CHECK_THROWS_WITH(convert(at(folder, "b.nff", 1)), "--at: nothing moves in " + folder.file("a.aff"));
  CHECK_NOTHROW(convert(at(folder, "b.nff", {})));
}

TEST_CASE(
    "NFF gets mean colours of textures, lights that its readers weaken, and stretched balls as triangles") {
  const Folder folder;
  write_moving_scene(folder);
  const Told told;
  convert(at(folder, "b.nff", {}));
  CHECK(told.text().find(folder.file("a.aff") + ": 1 stretched sphere or cone becomes triangles\n") !=
        std::string::npos);
  const SceneDescription scene = read_nff(folder.file("b.nff")).scene;
  REQUIRE(scene.lights.size() == 1);
  CHECK(scene.lights[0].color == Rgb(1, 0.5, 2));
  REQUIRE(scene.materials.size() == 2);
  const Rgb seen = scene.materials[0].color * scene.materials[0].diffuse;  // half of (0.5, 0.5, 0.2)
  CHECK((seen.x == Approx(0.25) && seen.y == Approx(0.25) && seen.z == Approx(0.1)));
  CHECK(scene.materials[1].specular == 0.5);
  CHECK((scene.spheres.size() == 1 && scene.patches.size() == 432));
  CHECK(bounds(scene).max.y == Approx(7).epsilon(0.01));
}

TEST_CASE("stretched balls are told by their number, where they become triangles and only there") {
  const Folder folder;
  const std::string plain = "fm 0 0 0 1 1 1 0 0 0 0 0 0 s 0 0 0 1 s 3 0 0 1\n";
  const std::string stretched = "xs 1 2 1 0 0 1 0 0 5 0 { s 0 0 0 1 s 2 0 0 1 c 0 0 0 1 0 1 0 1 }\n";
  const auto told_of = [&](const std::string& scene, const std::string& output) {
    write_whole_file(folder.file("a.aff"), scene);
    const Told told;
    convert(at(folder, output, {}));
    return told.text();
  };
  const std::string words = "stretched spheres or cones become triangles";
  for (const char* output : {"b.nff", "b.obj", "b.ply"}) {
    INFO(output);
    CHECK(told_of(plain + stretched, output).find(": 3 " + words) != std::string::npos);
    CHECK(told_of(plain, output).find("stretched") == std::string::npos);
  }
  for (const char* output : {"b.glb", "b.aff", "b.pov"}) {
    INFO(output);
    CHECK(told_of(plain + stretched, output).find("stretched") == std::string::npos);
  }
}

TEST_CASE("stretched balls become as many triangles as asked for, like the others") {
  const Folder folder;
  write_whole_file(folder.file("a.aff"),
                   "fm 0 0 0 1 1 1 0 0 0 0 0 0 s 3 0 0 1\nxs 1 2 1 0 0 1 0 0 5 0 { s 0 0 0 1 }\n");
  const auto triangles = [&](std::optional<int> tessellate, std::optional<double> chord_error) {
    const Told told;
    convert({.input = folder.file("a.aff"),
             .output = folder.file("b.obj"),
             .tessellate = tessellate,
             .chord_error = chord_error});
    std::istringstream lines(read_whole_file(folder.file("b.obj")));
    int faces = 0;
    for (std::string line; std::getline(lines, line);) faces += line.starts_with("f ") ? 1 : 0;
    return faces;
  };
  CHECK(triangles({}, {}) == 2 * 432);
  CHECK(triangles(2, {}) == 2 * 48);
  CHECK(triangles({}, 2) == 2 * 12);  // more than the radius: faces of a cube
}

TEST_CASE("a mesh of a moving scene has its materials' colours and its stretched balls") {
  const Folder folder;
  write_moving_scene(folder);
  convert(at(folder, "b.obj", 2));
  const std::string materials = read_whole_file(folder.file("b.mtl"));
  CHECK(materials.find("Kd 0.5 0.5 0.5") != std::string::npos);
  CHECK(materials.find("Ks 0.5 0.25 0.125") != std::string::npos);
  CHECK(materials.find("Ka 0.5 0.5 0.5") != std::string::npos);
  CHECK(materials.find("map_Kd b-t.png") != std::string::npos);
  CHECK(read_image(folder.file("b-t.png")).width == 2);
  convert(
      {.input = folder.file("b.obj"), .output = folder.file("b.nff"), .tessellate = {}, .chord_error = {}});
  const SceneDescription back = read_nff(folder.file("b.nff")).scene;
  CHECK(back.polygons.size() + back.patches.size() == 1 + 2 * 432);
  CHECK(bounds(back).max.x == Approx(3));
}

TEST_CASE("what reading a scene or a mesh may take is as much as is asked for") {
  const Folder folder;
  std::string vertices;
  for (int i = 0; i < 10'000; ++i)
    vertices += "v " + std::to_string(i) + " 1 2\nv 3 4 5\nv 6 7 9\nf -1 -2 -3\n";
  write_whole_file(folder.file("a.obj"), vertices);
  write_whole_file(folder.file("a.nff"), nff(make_spd("balls", 3)));
  for (const char* input : {"a.obj", "a.nff"}) {
    INFO(input);
    ConvertOptions options{
        .input = folder.file(input), .output = folder.file("b.aff"), .tessellate = {}, .chord_error = {}};
    options.memory = 20'000;
    const Told told;
    CHECK_THROWS_AS(convert(options), InputError);
    options.memory = std::uint64_t{1} << 30;
    CHECK_NOTHROW(convert(options));
  }
}

TEST_CASE("AFF keeps all that moves, also by way of glTF") {
  const Folder folder;
  write_moving_scene(folder);
  convert(at(folder, "b.aff", {}));
  convert(at(folder, "b.glb", {}));
  convert(
      {.input = folder.file("b.glb"), .output = folder.file("c.aff"), .tessellate = {}, .chord_error = {}});
  for (const char* name : {"a.aff", "b.aff", "c.aff"}) {
    CAPTURE(name);
    const SceneDescription scene = load_scene(folder.file(name)).scene;
    CHECK(scene.textures.at(0).rgb == std::vector<std::uint8_t>{255, 0, 0, 0, 255, 102});
    REQUIRE(scene.movement.tracks.contains("ball"));
    CHECK(track_at(scene.movement, "ball", 2.5)->to_parent.origin.x == Approx(2.5));
    CHECK(scene.movement.times->frames == (name[0] == 'c' ? 73 : 5));
  }
  convert(at(folder, "still.aff", 2));
  CHECK(load_scene(folder.file("still.aff")).scene.movement.tracks.empty());
}

TEST_CASE("POV-Ray's scene has its textures beside it") {
  const Folder folder;
  write_moving_scene(folder);
  convert(at(folder, "b.pov", {}));
  CHECK(read_whole_file(folder.file("b.pov")).find("png \"b-t.png\"") != std::string::npos);
  const Image picture = read_image(folder.file("b-t.png"));
  CHECK((picture.width == 2 && picture.height == 1));
  CHECK(picture.at(1, 0).z == Approx(102 / 255.0));
}

TEST_CASE("a scene is loaded from a database or from a file") {
  const Folder folder;
  write_whole_file(folder.file("one.nff"), "f 1 1 1 1 0 0 0 1\ns 0 0 0 1\n");
  CHECK(load_scene("spd:tree:2").scene.name == "spd:tree:2");
  CHECK(load_scene(folder.file("one.nff")).scene.spheres.size() == 1);
  CHECK_THROWS_AS(load_scene("spd:nothing"), InputError);
  CHECK_THROWS_AS(load_scene(folder.file("missing.nff")), InputError);
}

TEST_CASE("NFF gets a light far away for a sun, the ground's colour for a sky, and no lamps") {
  const Folder folder;
  write_whole_file(folder.file("a.aff"), R"(
v from 0 0 9 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 8 8
am 1 1 1  ls 0 2 0  b .25 .5 .75  bs 0 1 0 1 1 1 0 0 1
fm .5 .5 .5 .5 .5 .5 0 0 0 0 0 0 fe 1 1 1 s 0 0 0 1
)");
  const Told told;
  convert(at(folder, "b.nff", {}));
  const SceneDescription back = load_scene(folder.file("b.nff")).scene;
  REQUIRE(back.lights.size() == 1);
  CHECK((!back.lights[0].is_sun && back.lights[0].position.y > 1e4));
  CHECK(back.background == Rgb(.25, .5, .75));
  CHECK(told.text().find("1 sun becomes a light far away") != std::string::npos);
  CHECK(told.text().find("the sky is not kept: the background has the colour below its horizon") !=
        std::string::npos);
  CHECK(told.text().find("1 material that gives off light: NFF has none, so it does not glow") !=
        std::string::npos);
}

}  // namespace pprt::convert_test
