// AFF as plain values: every directive, and scenes of several files.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "base/diagnostics.h"
#include "parser/aff_parser.h"
#include "scene/animation/resting_nodes.h"
#include "unit/image/temporary_directory.h"

namespace pprt::aff_scene_test {

namespace {

SceneDescription parsed(const std::string& text, const AffOptions& options = {}) {
  return parse_aff(text, "a.aff", options).scene;
}

std::string report(const std::string& text, const AffOptions& options = {}) {
  try {
    parse_aff(text, "a.aff", options);
    return "";
  } catch (const InputError& e) {
    return e.what();
  }
}

// Files of a scene.
class Folder {
 public:
  void write(const std::string& name, const std::string& text) {
    std::filesystem::create_directories((directory_.path() / name).parent_path());
    std::ofstream(directory_.path() / name, std::ios::binary) << text;
  }
  std::string path(const std::string& name) const { return directory_.path() / name; }
  SceneDescription read(const std::string& name, const AffOptions& options = {}) const {
    return read_aff(path(name), options).scene;
  }
  std::string report(const std::string& name, const AffOptions& options = {}) const {
    try {
      read_aff(path(name), options);
      return "";
    } catch (const InputError& e) {
      return e.what();
    }
  }

 private:
  TemporaryDirectory directory_;
};

const std::string kMaterial = "fm .1 .2 .3 .4 .5 .6 .7 .8 .9 10 .11 1.2\n";

}  // namespace

TEST_CASE("aff: view, background, ambient light and frames") {
  const SceneDescription scene = parsed(R"(# a comment, and one with a byte of Latin-1: )"
                                        "\xe4\r\n"
                                        R"(v
from 1 2 3 at 4 5 6 up 0 1 0 angle 40 % half of it
hither 0.00001 resolution 800 600
b .1 .2 .3  am 2.5 2.5 2 a -1.5 4.5E0 300)");
  REQUIRE(scene.view);
  CHECK((scene.view->from == Vec3d(1, 2, 3) && scene.view->at == Vec3d(4, 5, 6) &&
         scene.view->angle_degrees == 40));
  CHECK((scene.view->hither == 1 && scene.view->width == 800 && scene.view->height == 600));
  CHECK(*scene.background == Rgb(.1, .2, .3));
  CHECK(*scene.ambient == Rgb(2.5, 2.5, 2));
  REQUIRE(scene.movement.times);
  CHECK(
      (time_of_frame(*scene.movement.times, 0) == -1.5 && time_of_frame(*scene.movement.times, 299) == 4.5));
  CHECK(time_of_frame({2, 9, 1}, 0) == 2);
}

TEST_CASE("aff: lights, named or not, with a colour or not") {
  const SceneDescription scene =
      parsed("l 1 2 3 l 4 5 6 .1 .2 .3\nla lamp 7 8 9 xs 1 1 1 0 0 1 0 1 0 0{l 0 0 0}");
  REQUIRE(scene.lights.size() == 4);
  CHECK((scene.lights[0].position == Vec3d(1, 2, 3) && !scene.lights[0].color));
  CHECK(*scene.lights[1].color == Rgb(.1, .2, .3));
  CHECK((scene.light_nodes[2].track == "lamp" && scene.light_nodes[2].node == 0));
  CHECK(scene.light_nodes[3].node == 1);
  CHECK(report("l 1 2 3 .5 .5").find("expected a number for blue of 'l', found the end of the file") !=
        std::string::npos);
}

TEST_CASE("aff: there is one current material, which braces do not bound") {
  const SceneDescription scene = parsed("f 1 .5 0 .5 .25 3 0 0\ns 0 0 0 1\nxs 1 1 1 0 0 1 0 0 0 0 {\n" +
                                        kMaterial + "s 0 0 0 2 }\ns 0 0 0 3 " + kMaterial + "s 0 0 0 4");
  REQUIRE(scene.materials.size() == 2);
  CHECK(scene.materials[0].terms->diffuse == Rgb(.5, .25, 0));
  CHECK(scene.materials[0].terms->specular == Rgb(.25, .25, .25));
  CHECK(scene.materials[0].refractive_index == 1);
  const Material& m = scene.materials[1];
  CHECK(*m.terms == TermColors{{.1, .2, .3}, {.4, .5, .6}, {.7, .8, .9}});
  CHECK(m.specular == .9);
  CHECK((m.shine == 10 && m.transmittance == .11 && m.refractive_index == 1.2));
  REQUIRE(scene.spheres.size() == 4);
  for (const int i : {1, 2, 3}) CHECK(scene.spheres[static_cast<std::size_t>(i)].material == 1);
  CHECK(scene.nodes == std::vector<NodeIndex>{0, 1, 0, 0});
}

TEST_CASE("aff: a mesh has rows of three, six or nine indices, from 0 on") {
  const SceneDescription scene = parsed(kMaterial + R"(
m vertices 4  0 0 0  1 0 0  0 1 0  1 1 0
  normals 2  0 0 1  0 0 -1
  texturecoords 3 wood.ppm  0 0  1 0  0.5 -2
  triangles 2
  0 1 2  0 0 1  2 1 0
  1 3 2  1 1 1  0 0 0
m vertices 3 0 0 0 1 0 0 0 1 0 triangles 1 2 1 0
m vertices 3 0 0 0 1 0 0 0 1 0 texturecoords 1 wood.ppm 0 0 triangles 1 0 1 2 0 0 0)");
  REQUIRE(scene.meshes.size() == 3);
  const TriangleMesh& mesh = scene.meshes[0];
  CHECK((mesh.positions.size() == 4 && mesh.normals.size() == 2 && mesh.texture_points[2] == Vec2d(0.5, -2)));
  REQUIRE(scene.triangles.size() == 4);
  const auto& t = scene.triangles;
  CHECK((t[0].mesh == 0 && t[1].mesh == 0 && t[2].mesh == 1 && t[3].mesh == 2));
  CHECK(t[1].corners.position == std::array<std::uint32_t, 3>{1, 3, 2});
  CHECK(t[0].corners.normal == std::array<std::uint32_t, 3>{0, 0, 1});
  CHECK(t[0].corners.texture_point == std::array<std::uint32_t, 3>{2, 1, 0});
  CHECK(t[2].corners.position == std::array<std::uint32_t, 3>{2, 1, 0});
  const auto texture_of = [&](std::size_t i) { return scene.materials[scene.meshes[i].material].texture; };
  CHECK_FALSE(texture_of(1));
  REQUIRE(scene.textures.size() == 1);
  CHECK(scene.textures[0].name == "wood.ppm");
  CHECK((texture_of(0) == TextureIndex{0} && texture_of(2) == TextureIndex{0}));
}

TEST_CASE("aff: polygons, patches, textured and moving triangles, spheres and cones") {
  const SceneDescription scene = parsed(kMaterial + R"(
p 4  0 0 0  1 0 0  1 1 0  0 1 0
pp 3  0 0 0 0 0 1  1 0 0 0 0 1  0 1 0 0 1 1
tt a.ppm  0 0 0 0 0  1 0 0 1 0  0 1 0 0 1
ttp b.ppm  0 0 0 0 0 1 0 0  1 0 0 0 0 1 1 0  0 1 0 0 0 1 0 1
tpa 2  0  0 0 0 0 0 1  1 0 0 0 0 1  0 1 0 0 0 1
       2  0 0 4 0 0 1  1 0 4 0 0 1  0 1 4 0 1 0
s 1 2 3 4
c 0 0 0 1 0 0 5 0.5)");
  REQUIRE(scene.meshes.size() == 4);
  CHECK((scene.triangles.size() == 5 && scene.triangles[1].mesh == 0 && scene.triangles[2].mesh == 1));
  CHECK(scene.meshes[1].normals.size() == 3);
  CHECK((scene.textures.size() == 2 && scene.materials[scene.meshes[3].material].texture == TextureIndex{1}));
  CHECK((scene.spheres.size() == 1 && scene.cones[0].apex_radius == 0.5));
  REQUIRE(scene.moving_triangles.size() == 1);
  const MovingTriangle& moving = scene.moving_triangles[0];
  CHECK(shape_at(moving, -1).positions[0] == Vec3d(0, 0, 0));
  CHECK(shape_at(moving, 0.5).positions[1] == Vec3d(1, 0, 1));
  CHECK(shape_at(moving, 1).normals[2].length() == Approx(1));
  CHECK(shape_at(moving, 9).positions[2] == Vec3d(0, 1, 4));
}

TEST_CASE("aff: transforms stand in each other, static and moving") {
  const SceneDescription scene = parsed(kMaterial + R"(
xs 2 2 2  0 0 1 90  1 0 0 {
  x wheel{ s 1 0 0 1 }
  x wheel { s 0 1 0 1 }
}
x nobody { s 0 0 0 1 }
k wheel { transl 4  0 0 0 0 0 0 0  1 0 0 5 0 0 0  2 0 0 7 0 0 0  3 0 0 7 0 0 0
          visibility 1 1.5 0 })");
  REQUIRE(scene.movement.nodes.size() == 5);
  CHECK((scene.movement.nodes[2].parent == 1 && scene.movement.nodes[3].parent == 1 &&
         scene.movement.nodes[4].parent == 0));
  const std::vector<Placement> start = placements_at(scene.movement, 0),
                               end = placements_at(scene.movement, 2);
  const Vec3d world = start[2].to_parent.point({1, 0, 0});
  CHECK((world - Vec3d(1, 2, 10)).length() < 1e-12);
  CHECK(start[3].to_parent == start[2].to_parent);
  CHECK((start[2].visible && !end[2].visible && end[1].visible && end[4].visible));
  CHECK(start[4].to_parent == Affine());
}

TEST_CASE("aff: the camera's track moves what it has keys of") {
  const std::string view = "v from 0 0 5 at 0 0 0 up 0 1 0 angle 40 hither 1 resolution 8 6\n";
  const std::string keys = "transl 4 0 1 2 3 0 0 0 1 1 2 3 0 0 0 2 1 2 3 0 0 0 3 1 2 3 0 0 0";
  const std::string turn = "rot 4 0 0 1 0 90 0 0 0 1 0 1 0 90 0 0 0 2 0 1 0 90 0 0 0 3 0 1 0 90 0 0 0";
  const auto seen = [&](const std::string& track) { return *view_at(parsed(view + track), 1); };
  const View both = seen("k camera {" + keys + " " + turn + "}");
  CHECK((both.from == Vec3d(1, 2, 3) && (both.at - Vec3d(0, 2, 3)).length() < 1e-12));
  const View moved = seen("k camera {" + keys + "}");
  CHECK((moved.from == Vec3d(1, 2, 3) && moved.at == Vec3d(1, 2, -2) && moved.up == Vec3d(0, 1, 0)));
  const View turned = seen("k camera {" + turn + "}");
  CHECK((turned.from == Vec3d(0, 0, 5) && (turned.at - Vec3d(-1, 0, 5)).length() < 1e-12));
  CHECK(seen("").at == Vec3d(0, 0, 0));
  CHECK_FALSE(view_at(parsed("k camera {" + keys + "}"), 1));
}

TEST_CASE("aff: a track that is given twice counts as the last, before or after its object") {
  const std::string row = " 0 0 0 0 ", four = "transl 4 ";
  const auto keys = [&](int x) {
    std::string text = four;
    for (int t = 0; t < 4; ++t) text += std::to_string(t) + " " + std::to_string(x) + " 0 0 0 0 0 ";
    return text;
  };
  const SceneDescription scene = parsed("k a {" + keys(1) + "} x a { l 0 0 0 } k a {" + keys(2) + "}");
  CHECK(placements_at(scene.movement, 1)[1].to_parent.origin == Vec3d(2, 0, 0));
}

TEST_CASE("aff: problems are told with their place, all of them") {
  const std::string all = report("v from 1 2 x\nfm 1 2 3\n" + kMaterial +
                                 "q 1 2\nm vertices 3 0 0 0 1 0 0 0 1 0 triangles 1\n0 1 3\n}\n");
  INFO(all);
  CHECK(all.find("a.aff:1:12: error: expected a number for z of 'v', found 'x'") != std::string::npos);
  CHECK(all.find("a.aff:3:1: error: expected a number for red of the diffuse colour of 'fm', found 'fm'") !=
        std::string::npos);
  CHECK(all.find("a.aff:4:1: error: expected a directive of AFF after 'fm', found 'q'") != std::string::npos);
  CHECK(all.find("error: 3 is no index of a vertex: 'm' has 3, from 0 on") != std::string::npos);
  CHECK(all.find("a.aff:7:1: error: '}' closes nothing that this file has opened") != std::string::npos);
  CHECK(report("xs 1 1 1 0 0 1 0 0 0 0 {\n").find("a.aff:1:1: error: '{' is not closed in this file") !=
        std::string::npos);
  CHECK(report("k a { transl 3 0 0 0 0 0 0 0 1 0 0 0 0 0 0 2 0 0 0 0 0 0 }")
            .find("a curve of 'k' needs at least 4 keys") != std::string::npos);
  CHECK(
      report("k a { rots 4 }").find("expected transl, rot, scale, visibility or '}' of 'k', found 'rots'") !=
      std::string::npos);
  CHECK(report("a 0 1 0").find("the number of frames of 'a' must be a whole number from 1 to 1000000") !=
        std::string::npos);
  CHECK(report("m vertices 1e9").find("are more than this file can hold") != std::string::npos);
  CHECK(report("m vertices 1.5").find("must be whole") != std::string::npos);
  CHECK(
      report("v from 0 0 0 at 0 0 0 up 0 1 0 angle 200 hither 1 resolution 8 6").find("between 0 and 180") !=
      std::string::npos);
  CHECK(report("tp 3").find("expected a directive of AFF, found 'tp'") != std::string::npos);
}

TEST_CASE("aff: every index of a mesh is judged, by the list that it is for") {
  const auto mesh = [](const std::string& lists, const std::string& indices) {
    return report("m vertices " + lists + " triangles 1 " + indices);
  };
  const std::string three = "3 0 0 0 1 0 0 0 1 0";
  CHECK(report("m vertices 1 0 0 0\ntriangles 1\n  0 1 0\n")
            .starts_with("a.aff:3:5: error: 1 is no index of a vertex: 'm' has 1, from 0 on\n"));
  CHECK(mesh("0", "0 1 2").find("0 is no index of a vertex: 'm' has none") != std::string::npos);
  CHECK(mesh("0 normals 1 0 0 1", "0 1 2 0 0 0").find("of a vertex: 'm' has none") != std::string::npos);
  CHECK(mesh(three + " normals 1 0 0 1", "0 1 2 0 0 1").find("1 is no index of a normal: 'm' has 1") !=
        std::string::npos);
  CHECK(mesh(three + " texturecoords 2 t 0 0 1 1", "0 1 2 0 1 2")
            .find("2 is no index of a texture coordinate: 'm' has 2") != std::string::npos);
  CHECK(mesh(three, "0 1 -1").find("-1 is no index of a vertex") != std::string::npos);
  CHECK(mesh(three, "0 1 .5").find("0.5 is no index of a vertex") != std::string::npos);
  CHECK(mesh(three + " normals 0 texturecoords 0 t", "0 1 2").empty());
  CHECK(report("m vertices 0 triangles 0").empty());
}

TEST_CASE("aff: deviations are warnings, or errors when reading is strict") {
  const std::string text =
      "s 0 0 0 1\nfm 1 1 1 1 1 1 1 1 1 1 .5 0\ns 0 0 0 0\ns 1 1 1 0\n"
      "k a { visibility 2 3 1 1 0 }";
  const ParsedScene lenient = parse_aff(text, "a.aff");
  CHECK(lenient.warnings.find(
            "a.aff:1:1: warning: there is no material before the first object: white is taken") !=
        std::string::npos);
  CHECK(lenient.warnings.find("the object has no extent: left out (2 times, first here)") !=
        std::string::npos);
  CHECK(lenient.warnings.find(
            "a.aff:2:1: warning: T is above 0 but the index of refraction is not: 1 is taken") !=
        std::string::npos);
  CHECK(lenient.warnings.find("the times of the keys decrease") != std::string::npos);
  CHECK((lenient.scene.spheres.size() == 1 && lenient.scene.materials[1].refractive_index == 1));
  const std::string strict = report(text, {.strict = true});
  CHECK(strict.find("a.aff:3:1: error: the object has no extent") != std::string::npos);
  CHECK(strict.find("a.aff:4:1: error: the object has no extent") != std::string::npos);
}

TEST_CASE("aff: included files stand where they are named, as often as they are named") {
  Folder folder;
  folder.write("main.aff", kMaterial +
                               "i 0 ball.aff xs 1 1 1 0 0 1 0 5 0 0 { i 0 ball.aff }\ni 1 detail.aff d 1 i 1 "
                               "parts/part.aff s 0 0 0 4\n");
  folder.write("ball.aff", "s 0 0 0 1\n");
  folder.write("detail.aff", "s 0 0 0 2\n");
  folder.write("parts/part.aff", "fm 0 0 0 0 0 0 0 0 0 0 0 0 i 0 near.aff i 0 ball.aff");
  folder.write("parts/near.aff", "s 0 0 0 3");
  const SceneDescription scene = folder.read("main.aff");
  REQUIRE(scene.spheres.size() == 5);
  CHECK(scene.nodes[0] == 0);
  CHECK(scene.nodes[1] == 1);
  CHECK((scene.spheres[2].radius == 3 && scene.spheres[3].radius == 1 && scene.spheres[4].radius == 4));
  CHECK(scene.spheres[4].material == 1);  // the included file's material stays
}

TEST_CASE("aff: a file that is included can fail in many ways") {
  Folder folder;
  folder.write("scene/main.aff",
               "i 0 lost.aff\ni 0 ../outside.aff\ni 0 self.aff\ni 0 open.aff\ni 0 close.aff\ni 0 "
               "wrong.aff\ni 0 wrong.aff\n");
  folder.write("outside.aff", "l 0 0 0\n");
  folder.write("scene/self.aff", "\ni 0 again.aff");
  folder.write("scene/again.aff", "i 0 self.aff");
  folder.write("scene/open.aff", "xs 1 1 1 0 0 1 0 0 0 0 {");
  folder.write("scene/close.aff", "\n  }");
  folder.write("scene/wrong.aff", "l 0 0 zero\nl 1 1 one\n");
  const std::string all = folder.report("scene/main.aff");
  INFO(all);
  CHECK(all.find("scene/main.aff:1:5: error: 'lost.aff': there is no such file") != std::string::npos);
  CHECK(all.find("scene/main.aff:2:5: error: '../outside.aff': the file lies outside the scene's folder") !=
        std::string::npos);
  CHECK(all.find("scene/again.aff:1:5: error: 'self.aff': the file includes itself") != std::string::npos);
  CHECK(all.find("scene/open.aff:1:1: error: '{' is not closed in this file") != std::string::npos);
  CHECK(all.find("scene/close.aff:2:3: error: '}' closes nothing that this file has opened") !=
        std::string::npos);
  CHECK(all.find("scene/wrong.aff:2:7: error: expected a number for z of 'l', found 'one'") !=
        std::string::npos);
  CHECK(all.find("wrong.aff:1:7") == all.rfind("wrong.aff:1:7"));  // read twice, told once
  AffOptions anywhere;
  anywhere.files_anywhere = true;
  folder.write("scene/far.aff", "i 0 ../outside.aff");
  CHECK(folder.report("scene/far.aff").find("outside the scene's folder") != std::string::npos);
  CHECK(folder.read("scene/far.aff", anywhere).lights.size() == 1);
  CHECK_THROWS_AS(folder.read("nothing.aff"), InputError);
}

TEST_CASE("aff: there are limits of everything") {
  Folder folder;
  folder.write("deep.aff", "i 0 b1.aff");
  for (int n = 1; n <= 9; ++n)
    folder.write("b" + std::to_string(n) + ".aff",
                 n < 9 ? "i 0 b" + std::to_string(n + 1) + ".aff" : "l 0 0 0");
  AffOptions few;
  few.max_depth = 5;
  CHECK(folder.report("deep.aff", few).find("more than 5 files in each other") != std::string::npos);
  CHECK(folder.read("deep.aff").lights.size() == 1);
  few = {};
  few.max_reads = 3;
  CHECK(folder.report("deep.aff", few).find("more than 3 files are read") != std::string::npos);
  few = {};
  few.max_transforms = 2;
  std::string nested;
  for (int n = 0; n < 3; ++n) nested += "x a { ";
  CHECK(report(nested, few).find("more than 2 transforms in each other") != std::string::npos);
  few = {};
  few.max_items = 1;
  CHECK(report(kMaterial + "p 4 0 0 0 1 0 0 1 1 0 0 1 0", few)
            .find("more than 1 objects, vertices, keys and transforms") != std::string::npos);
  few = {};
  few.max_memory = 100'000;
  folder.write("ball.aff", "s 0 0 0 1\n s 0 0 0 2\n");
  folder.write("many.aff", kMaterial + "i 0 nine.aff i 0 nine.aff i 0 nine.aff i 0 nine.aff i 0 nine.aff");
  std::string nine;
  for (int n = 0; n < 99; ++n) nine += "i 0 ball.aff\n";
  folder.write("nine.aff", nine);
  const std::string too_much = folder.report("many.aff", few);
  INFO(too_much);
  CHECK(too_much.find("ball.aff:") != std::string::npos);
  CHECK(too_much.find(
            "the scene takes more than 0.1 MB of memory, the most that reading may take (--memory)") !=
        std::string::npos);
  few.max_memory = 1'000'000;
  CHECK(folder.read("many.aff", few).spheres.size() == 990);
  CHECK(memory_of(folder.read("many.aff")) > 990 * sizeof(Sphere));
  few = {};
  few.max_errors = 3;
  CHECK(report("l x\nl x\nl x\nl x\n", few).find("reading stopped after 3 errors") != std::string::npos);
  few = {};
  few.max_bytes = 4;
  CHECK_THROWS_AS(folder.read("deep.aff", few), InputError);
}

TEST_CASE("aff: a scene that is cut short after any byte is read or refused, never worse") {
  const std::string whole = kMaterial + R"(v from 1 2 3 at 4 5 6 up 0 1 0 angle 40 hither 1 resolution 8 6
m vertices 3 0 0 0 1 0 0 0 1 0 normals 1 0 0 1 texturecoords 1 t 0 0 triangles 1 0 1 2 0 0 0 0 0 0
tpa 1 0 0 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1 x a{ l 1 2 3 }
k a { rot 4 0 0 0 1 0 0 0 0 1 0 0 1 0 0 0 0 2 0 0 1 0 0 0 0 3 0 0 1 0 0 0 0 visibility 1 0 1 } a 0 1 2)";
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::string text = whole.substr(0, size);
    try {
      for (const Placement& placement : placements_at(parsed(text).movement, 0.5))
        CHECK(placement.to_parent == Affine());
    } catch (const InputError& e) {
      CHECK(std::string(e.what()).find("a.aff:") == 0);
    }
  }
  CHECK(parsed(whole).meshes.size() == 1);
}

TEST_CASE("aff: a sun has a direction, in the space of its transform, and a sky its horizon and zenith") {
  const SceneDescription scene =
      parsed("bs 0 0 2 .9 .8 .7 .1 .2 .5 ls 0 1 0 xs 1 1 1 0 0 1 90 5 6 7 { ls 1 0 0 .5 .5 .5 } l 0 1 0");
  CHECK(scene.sky == Sky{.up = {0, 0, 2}, .horizon = {.9, .8, .7}, .zenith = {.1, .2, .5}});
  CHECK_FALSE(scene.background);
  CHECK(ground_color(scene) == Rgb(.9, .8, .7));
  REQUIRE(scene.lights.size() == 3);
  CHECK((scene.lights[0].is_sun && !scene.lights[0].color && scene.lights[1].is_sun &&
         !scene.lights[2].is_sun));
  const SceneDescription settled = without_resting_nodes(scene);
  CHECK((settled.lights[1].position - Vec3d(0, 1, 0)).length() < 1e-12);  // turned, and not moved
  CHECK(report("ls 0 0 0").find("a.aff:1:1: error: the direction to the sun is zero") == 0);
  CHECK(report("bs 0 0 0 1 1 1 1 1 1").find("a.aff:1:1: error: the direction to the zenith is zero") == 0);
  CHECK(report("bs 0 1 0 1 1 1 1 1").find("expected a number for blue of the zenith of 'bs'") !=
        std::string::npos);
}

TEST_CASE("aff: a material gives off light until the next, with a picture or without") {
  const SceneDescription scene = parsed(
      kMaterial + "s 0 0 0 1 fe .1 .2 3 s 0 0 0 1 fet glow .5 .5 .5 s 0 0 0 1\n" +
      "tt wood 0 0 0 0 0 1 0 0 1 0 0 1 0 0 1 tt - 0 0 0 0 0 1 0 0 1 0 0 1 0 0 1\n" + kMaterial + "s 0 0 0 1");
  const auto of = [&](std::size_t i) { return scene.materials[material_of(scene, scene.order[i])]; };
  REQUIRE(scene.order.size() == 6);
  CHECK((of(0).emission == Rgb(0, 0, 0) && of(5) == of(0)));
  CHECK((of(1).emission == Rgb(.1, .2, 3) && of(1).terms == of(0).terms));
  CHECK((of(2).emission == Rgb(.5, .5, .5) && !of(2).has_picture()));  // a ball has no place for a picture
  CHECK((of(3).emission_texture && of(3).texture && *of(3).texture != *of(3).emission_texture));
  CHECK((of(4).emission_texture == of(3).emission_texture && !of(4).texture));
  CHECK(scene.textures.size() == 2);
}

}  // namespace pprt::aff_scene_test
