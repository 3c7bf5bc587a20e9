// Movement, textures, cameras and lights in glTF, out and in.
#include <assimp/anim.h>
#include <assimp/scene.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "base/diagnostics.h"
#include "convert/mesh/mesh_animation.h"
#include "convert/mesh/mesh_reader.h"
#include "convert/mesh/mesh_writer.h"
#include "image/image_io.h"
#include "parser/aff_parser.h"
#include "scene/animation/resting_nodes.h"
#include "scene/writers/aff_writer.h"
#include "unit/image/temporary_directory.h"

namespace pprt::mesh_motion_test {

namespace {

// Writes a scene as a mesh and reads that.
ReadMesh there_and_back(const SceneDescription& scene, const std::string& extension) {
  const TemporaryDirectory folder;
  const WrittenMesh mesh = write_mesh(scene, extension, "m", {2, {}});
  for (const MeshFile& file : mesh.files)
    std::ofstream(folder.path() / file.name, std::ios::binary) << file.bytes;
  return read_mesh((folder.path() / mesh.files.back().name).string());
}

// Returns the box of all that is seen at a time, in the world.
Box3d seen(const SceneDescription& scene, double time) {
  Box3d box;
  const std::vector<Placement> placements = placements_at(scene.movement, time);
  for (std::size_t place = 0; place < scene.order.size(); ++place) {
    const Placement& p = placements[node_of(scene, place)];
    if (p.visible) box.extendBy(mapped(p.to_parent, bounds(scene, scene.order[place])));
  }
  return box;
}

// Axis-parallel boxes of turned things depend on how finely they are cut: the tolerance is that of a mesh.
void check_near(const Vec3d& a, const Vec3d& b, double tolerance) {
  CAPTURE(a.x, a.y, a.z, b.x, b.y, b.z);
  CHECK((a - b).length() <= tolerance);
}

constexpr const char* kCar = R"(
v from 0 1 9 at 0 0.1 0 up 0 1 0 angle 33.3 hither 1 resolution 64 48
a 0 4 97
l 1 2 3 .3 .4 .5
la lamp 4 5 6 1 1 1
k lamp { transl 4 -2 0 0 0 0 0 0 0 0 0 0 0 0 0 4 1 1 1 0 0 0 5 0 0 0 0 0 0 }
k camera { transl 5 -1 0 1 9 0 0 0  0 0 1 9 0 0 0  1 5 1 9 0 0 0 4 5 3 2 0 0 0 5 0 0 0 0 0 0
           rot 4 -1 0 1 0 0 0 0 0  0 0 1 0 0 0 0 0  4 0 1 .2 100 0 0 0  5 0 1 0 0 0 0 0 }
k car { transl 5 -1 0 0 0 0 0 0 0 0 0 0 0 0 0 1 3 1 0 0 0 .5 4 9 -2 1 0 0 0 5 0 0 0 0 0 0 }
k wheel { rot 5 -1 0 0 1 0 0 0 0 0 0 0 1 0 0 0 0 2 0 0 1 170 0 0 0 4 0 0 1 340 0 0 0 5 0 0 1 350 0 0 0 }
fm .1 .2 .3 .4 .5 .6 0 0 0 0 0 1
p 4  -9 -9 -9  9 -9 -9  9 9 -9  -9 9 -9
x car {
  m vertices 4  0 0 0  2 0 0  2 1 0  0 1 0
    texturecoords 4 wood.ppm  0 0  1 0  1 .25  0 .25
    triangles 2  0 1 2  0 1 2   0 2 3  0 2 3
  xs 1 1 1  0 1 0 90  1 0 0 { x wheel { p 3  0 0 0  1 0 0  0 .5 0 } }
}
)";

SceneDescription car() {
  SceneDescription scene = parse_aff(kCar, "car.aff").scene;
  Texture& wood = scene.textures.at(0);
  wood.width = 2, wood.height = 1;
  wood.rgb = {255, 0, 0, 0, 51, 102};
  return scene;
}

// A triangle that an animation moves, as a modeller would write it: one buffer of times and values.
std::string gltf(const std::string& node = R"("name":"arm","mesh":0)", const std::string& more_nodes = "") {
  // Positions (0 0 0) (1 0 0) (0 1 0); times 0 1 3; translations (0 0 0) (2 0 0) (2 4 0).
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{)" + node + "}" +
         more_nodes + R"(],
  "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
  "animations":[{"name":"first","channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}],
                 "samplers":[{"input":1,"output":2}]}],
  "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
               {"bufferView":1,"componentType":5126,"count":3,"type":"SCALAR","min":[0],"max":[3]},
               {"bufferView":2,"componentType":5126,"count":3,"type":"VEC3"}],
  "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":12},
                 {"buffer":0,"byteOffset":48,"byteLength":36}],
  "buffers":[{"byteLength":84,"uri":"numbers.bin"}]})";
}

std::string numbers() {
  const float values[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, /* times */ 0, 1, 3, /* places */ 0,
                          0, 0, 2, 0, 0, 2, 4, 0};
  return {reinterpret_cast<const char*>(values), sizeof values};
}

ReadMesh read_gltf(const std::string& text, const std::string& bytes = numbers()) {
  const TemporaryDirectory folder;
  std::ofstream(folder.path() / "a.gltf") << text;
  std::ofstream(folder.path() / "numbers.bin", std::ios::binary) << bytes;
  return read_mesh((folder.path() / "a.gltf").string());
}

// Writes a scene as AFF and reads that, as the renderer does.
SceneDescription again(const SceneDescription& scene) {
  std::ostringstream out;
  write_aff(scene, out, std::vector<std::string>(scene.textures.size(), "t.png"));
  return parse_aff(out.str(), "again.aff").scene;
}

// glTF's angle spans the picture, that of a view the centres of its rows.
void check_angle(const SceneDescription& scene, double radians) {
  REQUIRE(scene.view);
  CHECK(std::tan(scene.view->angle_degrees * std::numbers::pi / 360) ==
        Approx(std::tan(radians / 2) * (scene.view->height - 1) / scene.view->height));
}

constexpr const char* kCameras =
    R"("cameras":[{"type":"perspective","perspective":{"yfov":0.5,"aspectRatio":2,"znear":0.1}}],)";

}  // namespace

TEST_CASE("what moves in glTF stands where it stood, at every time") {
  const SceneDescription scene = car();
  for (const char* extension : {".glb", ".gltf"}) {
    const SceneDescription back = there_and_back(scene, extension).scene;
    CHECK(back.movement.tracks.contains("car"));
    CHECK((back.movement.times->start == 0 && back.movement.times->end == 4 &&
           back.movement.times->frames == 97));
    for (double time = 0; time <= 4; time += 0.19) {
      CAPTURE(extension, time);
      const Box3d a = seen(scene, time), b = seen(back, time);
      check_near(a.min, b.min, 0.01);
      check_near(a.max, b.max, 0.01);
    }
  }
}

TEST_CASE("the box above tells times apart") {
  const SceneDescription scene = car();
  const Box3d before = seen(scene, 1), after = seen(scene, 1.19);
  CHECK((before.max - after.max).length() > 0.1);
}

TEST_CASE("the camera of glTF moves as the scene's") {
  const SceneDescription scene = car();
  const SceneDescription back = there_and_back(scene, ".glb").scene;
  REQUIRE(back.view);
  CHECK(back.view->angle_degrees ==
        Approx(33.3).epsilon(0.02));  // rows and centres of rows, of other numbers
  CHECK(back.view->width * 48 == Approx(back.view->height * 64).epsilon(0.01));
  for (double time = 0; time <= 4; time += 0.23) {
    CAPTURE(time);
    const View a = *view_at(scene, time), b = *view_at(back, time);
    check_near(a.from, b.from, 0.005);
    check_near((a.at - a.from).normalized(), (b.at - b.from).normalized(), 0.001);
    check_near(a.up.normalized(), b.up.normalized(), 0.001);
  }
  const View early = *view_at(back, 0), late = *view_at(back, 4);
  CHECK((early.from - late.from).length() > 5);
}

TEST_CASE("lights of glTF have their colours and move") {
  const SceneDescription back = there_and_back(car(), ".glb").scene;
  REQUIRE(back.lights.size() == 2);
  check_near(back.lights[0].position, {1, 2, 3}, 1e-6);
  const Rgb color = back.lights[0].color.value();
  CHECK((color.x == Approx(0.3) && color.y == Approx(0.4) && color.z == Approx(0.5)));
  const auto stands = [&](double time) {
    return placements_at(back.movement, time)[back.light_nodes[1].node].to_parent.point(
        back.lights[1].position);
  };
  check_near(stands(0), {0, 0, 0}, 1e-6);
  check_near(stands(4), {1, 1, 1}, 1e-6);
}

TEST_CASE("textures go with a mesh, the right way up") {
  const SceneDescription scene = car();
  for (const char* extension : {".glb", ".gltf", ".obj", ".dae"}) {
    CAPTURE(extension);
    const ReadMesh read = there_and_back(still_at(scene, 0), extension);
    const SceneDescription& back = read.scene;
    REQUIRE(back.textures.size() == 1);
    CHECK(back.textures[0].rgb == scene.textures[0].rgb);
    REQUIRE(back.triangles.size() == 2);
    for (const Triangle& triangle : back.triangles) {
      const TriangleMesh& mesh = back.meshes[triangle.mesh];
      REQUIRE(back.materials[mesh.material].texture);
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d p = mesh.positions[triangle.corners.position[i]];
        const Vec2d t = mesh.texture_points[triangle.corners.texture_point[i]];
        CHECK((t.x == Approx(p.x / 2).margin(1e-6) && t.y == Approx(p.y / 4).margin(1e-6)));
      }
    }
  }
}

TEST_CASE("what is hidden has no extent in glTF, and times before 0 begin at 0") {
  SceneDescription scene = parse_aff(R"(
f 1 1 1 1 0 0 0 1
k a { transl 4 -3 0 0 0 0 0 0 -2 0 0 0 0 0 0 2 4 0 0 0 0 0 3 0 0 0 0 0 0  visibility 2 -1 0 1 1 }
x a { p 3 0 0 0 1 0 0 0 1 0 })",
                                     "a.aff")
                               .scene;
  const SceneDescription back = there_and_back(scene, ".glb").scene;
  for (const double time : {-1.5, 0.0, 1.5}) {
    const Box3d box = seen(back, time + 2);  // its first key is at -2 seconds
    CAPTURE(time);
    CHECK(box.size().x == Approx(time == 0 ? 0 : 1).margin(1e-3));
    if (time != 0) check_near(box.min, seen(scene, time).min, 1e-3);
  }
}

TEST_CASE("a modeller's glTF moves in straight lines") {
  const ReadMesh read = read_gltf(gltf());
  CHECK(read.notes.empty());
  check_near(seen(read.scene, -1).min, {0, 0, 0}, 1e-6);
  check_near(seen(read.scene, 0.25).min, {0.5, 0, 0}, 1e-6);
  check_near(seen(read.scene, 1).min, {2, 0, 0}, 1e-6);
  check_near(seen(read.scene, 2.5).min, {2, 3, 0}, 1e-6);
  check_near(seen(read.scene, 7).min, {2, 4, 0}, 1e-6);
  CHECK((read.scene.movement.times->end == 3 && read.scene.movement.times->frames == 73));
  for (const auto& [name, track] : read.scene.movement.tracks) CHECK(track.is_in_order);
  CHECK(read.scene.movement.tracks.size() == 1);
}

TEST_CASE("of two animations that move one node the first counts, and the others are told") {
  aiScene scene;
  scene.mNumAnimations = 3;
  scene.mAnimations = new aiAnimation*[3];
  for (unsigned i = 0; i < 3; ++i) {
    auto* const channel = new aiNodeAnim;
    channel->mNodeName = aiString(std::string("cube"));
    channel->mNumPositionKeys = 2;
    channel->mPositionKeys = new aiVectorKey[2];
    for (unsigned k = 0; k < 2; ++k)
      channel->mPositionKeys[k] =
          aiVectorKey(k, aiVector3D(static_cast<float>(i + 1) * static_cast<float>(k), 0, 0));
    scene.mAnimations[i] = new aiAnimation;
    scene.mAnimations[i]->mTicksPerSecond = 1;
    scene.mAnimations[i]->mNumChannels = 1;
    scene.mAnimations[i]->mChannels = new aiNodeAnim*[1];
    scene.mAnimations[i]->mChannels[0] = channel;
  }
  const ModelAnimation read = read_animation(scene, "");
  CHECK(read.notes ==
        std::vector<std::string>{"2 movements of nodes that another animation moves: left out"});
  CHECK(read.tracks.at("cube").translation.back().value == Vec3d(1, 0, 0));
}

TEST_CASE("movements of shapes are told, of meshes and of morph targets") {
  aiScene scene;
  scene.mNumAnimations = 1;
  scene.mAnimations = new aiAnimation*[1];
  scene.mAnimations[0] = new aiAnimation;
  scene.mAnimations[0]->mNumMeshChannels = 2, scene.mAnimations[0]->mNumMorphMeshChannels = 3;  // told unread
  const std::vector<std::string> notes = read_animation(scene, "").notes;
  REQUIRE(notes.size() == 1);
  CHECK(notes[0].starts_with("5 "));
}

TEST_CASE("a node called camera does not move the view, and one that does moves it in the world") {
  const ReadMesh named = read_gltf(gltf(R"("name":"camera","mesh":0)"));
  CHECK(!named.scene.movement.tracks.contains(kCameraTrack));
  check_near(seen(named.scene, 1).min, {2, 0, 0}, 1e-6);

  std::string text =
      gltf(R"("name":"arm","mesh":0,"children":[1])", R"(,{"name":"eye","camera":0,"translation":[0,0,5]})");
  text.insert(1, kCameras);
  const SceneDescription scene = read_gltf(text).scene;
  check_angle(scene, 0.5);
  check_near(view_at(scene, 0)->from, {0, 0, 5}, 1e-6);
  check_near(view_at(scene, 2)->from, {2, 2, 5}, 1e-3);
  check_near(view_at(scene, 2)->at, {2, 2, 4}, 1e-3);
}

TEST_CASE("keys that are not finite, and pictures elsewhere, are told") {
  std::string bytes = numbers();
  const float nothing = std::nanf("");
  bytes.replace(52, 4, reinterpret_cast<const char*>(&nothing), 4);
  CHECK_THROWS_AS(read_gltf(gltf(), bytes), InputError);

  const TemporaryDirectory folder;
  std::ofstream(folder.path() / "a.obj") << "mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n"
                                            "f 1/1 2/1 3/1\n";
  for (const char* file : {"../a.png", "/etc/passwd", "no.png"}) {
    std::ofstream(folder.path() / "a.mtl") << "newmtl m\nKd 1 0.5 0.25\nmap_Kd " << file << "\n";
    const ReadMesh read = read_mesh((folder.path() / "a.obj").string());
    CAPTURE(file);
    REQUIRE(read.notes.size() == 1);
    CHECK(read.notes[0].find(file) != std::string::npos);
    CHECK(read.scene.polygons.size() == 1);
    CHECK(read.scene.materials[0].color.y == 0.5);
  }
}

TEST_CASE("a glTF file that is cut off is refused or read, never worse") {
  const TemporaryDirectory folder;
  const std::string whole = write_mesh(car(), ".glb", "m", {2, {}}).files.back().bytes;
  const std::string path = folder.path() / "m.glb";
  for (std::size_t size = 0; size < whole.size(); size += 97) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << whole.substr(0, size);
    CHECK_THROWS_AS(read_mesh(path), InputError);
  }
}

TEST_CASE("a movement called light_1 leaves the light where it is") {
  const SceneDescription scene = parse_aff(R"(
l 7 8 9
f 1 1 1 1 0 0 0 1
k light_1 { transl 4 -1 0 0 0 0 0 0 0 0 0 0 0 0 0 2 4 0 0 0 0 0 3 0 0 0 0 0 0 }
x light_1 { p 3 0 0 0 1 0 0 0 1 0 })",
                                           "a.aff")
                                     .scene;
  const SceneDescription back = there_and_back(scene, ".glb").scene;
  REQUIRE(back.lights.size() == 1);
  check_near(back.lights[0].position, {7, 8, 9}, 1e-6);
  CHECK(back.light_nodes.empty());
  check_near(seen(back, 2).min, {4, 0, 0}, 1e-6);
}

TEST_CASE("names that are not UTF-8 can be written as glTF") {
  SceneDescription scene = car();
  scene.textures[0].name = "h\xf6lzern.ppm";
  scene.movement.tracks["w\xe4gen"] = scene.movement.tracks.at("car");
  for (SceneNode& node : scene.movement.nodes) {
    if (node.track == "car") node.track = "w\xe4gen";
  }
  scene.movement.tracks.erase("car");
  const SceneDescription back = there_and_back(scene, ".gltf").scene;
  CHECK(back.movement.tracks.contains("w_gen"));
  CHECK(back.textures.size() == 1);
}

TEST_CASE("pictures are found under the spellings of URIs and of Windows") {
  const TemporaryDirectory folder;
  std::filesystem::create_directory(folder.path() / "textures");
  write_image(folder.path() / "textures/my wood.png", Image(2, 1, Color(1, 0, 0)));
  std::ofstream(folder.path() / "a.obj") << "mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n"
                                            "f 1/1 2/1 3/1\n";
  for (const char* file : {"textures/my%20wood.png", "textures\\my wood.png"}) {
    CAPTURE(file);
    std::ofstream(folder.path() / "a.mtl") << "newmtl m\nmap_Kd " << file << "\n";
    CHECK(read_mesh((folder.path() / "a.obj").string()).scene.textures.size() == 1);
  }
}

TEST_CASE("there are as many frames as the modeller's, whatever a float makes of the time") {
  for (int frames = 2; frames < 500; ++frames) {
    std::string bytes = numbers();
    const float last = static_cast<float>(frames - 1) / 24;
    bytes.replace(44, 4, reinterpret_cast<const char*>(&last), 4);
    const float middle = last / 2;
    bytes.replace(40, 4, reinterpret_cast<const char*>(&middle), 4);
    CHECK(read_gltf(gltf(), bytes).scene.movement.times->frames == frames);
  }
}

TEST_CASE("nodes without end, and cameras without perspective") {
  std::string deep = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)";
  for (int i = 1; i <= 5000; ++i) deep += R"({"children":[)" + std::to_string(i) + "]},";
  CHECK_THROWS_WITH(read_gltf(deep + "{}]}"), Catch::Contains("deep in each other"));
  CHECK_THROWS_WITH(read_gltf(gltf(R"("children":[1,1])", ",{}")), Catch::Contains("two parents"));
  for (const char* camera :
       {R"({"type":"orthographic","orthographic":{"xmag":1,"ymag":1,"zfar":9,"znear":0}})",
        R"({"type":"perspective","perspective":{"yfov":0,"znear":0.1}})"}) {
    std::string text = gltf(R"("mesh":0,"camera":0)");
    text.insert(1, std::string(R"("cameras":[)") + camera + "],");
    const ReadMesh read = read_gltf(text);
    CAPTURE(camera);
    CHECK(!read.scene.view);
    REQUIRE(!read.notes.empty());
    CHECK(read.notes[0].find("no perspective") != std::string::npos);
  }
  std::string unnamed = gltf(R"("mesh":0)", R"(,{"camera":0})");
  unnamed.replace(unnamed.find(R"("nodes":[0])"), 11, R"("nodes":[0,1])");
  unnamed.insert(1, kCameras);
  const SceneDescription scene = read_gltf(unnamed).scene;
  check_angle(scene, 0.5);
}

TEST_CASE("an animation of any length gets as many frames as a scene may have") {
  std::string bytes = numbers();
  const float last = 1e7F;
  bytes.replace(44, 4, reinterpret_cast<const char*>(&last), 4);
  const ReadMesh read = read_gltf(gltf(), bytes);
  CHECK(read.scene.movement.times->end == 1e7);
  CHECK(read.scene.movement.times->frames == 1'000'000);
  CHECK(read.notes == std::vector<std::string>{
                          "it would have more than 1000000 frames at 24 a second: these are further apart"});
  CHECK(again(read.scene).movement.times->frames == 1'000'000);
}

TEST_CASE("nodes as deep in each other as they may be can be written and read") {
  // Every other node moves; the others shear, which takes two transforms of AFF.
  std::string nodes, channels;
  for (int i = 0; i < 1000; ++i) {
    const std::string n = std::to_string(i), comma = i > 0 ? "," : "";
    nodes += comma + R"({"name":"n)" + n + "\"";
    if (i < 999) nodes += R"(,"children":[)" + std::to_string(i + 1) + "]";
    nodes += i % 2 == 0 ? R"(,"mesh":0})" : R"(,"matrix":[1,0,0,0,1,1,0,0,0,0,1,0,0,0,0,1]})";
    if (i % 2 == 0)
      channels += comma + R"({"sampler":0,"target":{"node":)" + n + R"(,"path":"translation"}})";
  }
  std::string text = gltf();
  const auto put_in = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  put_in(R"({"name":"arm","mesh":0})", nodes);
  put_in(R"({"sampler":0,"target":{"node":0,"path":"translation"}})", channels);
  const SceneDescription scene = read_gltf(text).scene;
  CHECK(scene.primitive_count() == 500);
  const SceneDescription back = again(scene);
  CHECK(back.primitive_count() == 500);
  check_near(seen(back, 1).max, seen(scene, 1).max, 1e-6 * seen(scene, 1).max.length());
}

TEST_CASE("a mesh whose numbers no scene file can hold is refused") {
  std::string text = gltf(R"("name":"a","mesh":0,"scale":[1e38,1,1],"children":[1])",
                          R"(,{"name":"b","mesh":0,"scale":[1e38,1,1],"children":[2]}
                             ,{"name":"c","mesh":0,"scale":[1e38,1,1]})");
  text.replace(text.find("animations"), 10, "animation_");
  CHECK_THROWS_WITH(read_gltf(text), Catch::EndsWith("a transform is not finite, or beyond 1e100"));
}

}  // namespace pprt::mesh_motion_test
