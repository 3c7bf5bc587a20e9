// Scenes put together from a model's parts, and what is added to models.
#include "convert/model/model_builder.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "convert/model/model_animation.h"
#include "convert/model_scene.h"
#include "convert/surfaces/material_meshes.h"
#include "scene/animation/resting_nodes.h"
#include "unit/convert/gltf_sample.h"

namespace pprt::model_builder_test {
namespace {

// A unit square in the plane z = 0, seen from above.
ModelMesh square() {
  ModelMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.corners = {0, 1, 2, 3}, mesh.ends = {4};
  return mesh;
}

ModelSpace world() {
  return {};
}

ModelSpace scaled(double x, double y, double z) {
  return {0, Affine{{x, 0, 0}, {0, y, 0}, {0, 0, z}, {0, 0, 0}}};
}

SceneDescription built(const ModelMesh& mesh, const Material& material, const ModelSpace& space) {
  ModelBuilder builder("model");
  builder.add(mesh, material, space);
  return std::move(builder).finish({}).scene;
}

Vec3d normal_of(const SceneDescription& scene, std::size_t polygon) {
  const auto v = scene.vertices(scene.polygons.at(polygon));
  return (v[1] - v[0]).cross(v[2] - v[1]).normalized();
}

}  // namespace

TEST_CASE("model builder: faces become polygons, or patches where normals differ from the face's") {
  ModelMesh mesh = square();
  CHECK(built(mesh, {}, world()).polygons.size() == 1);
  mesh.normals.assign(4, Vec3d(0, 0, 2));
  CHECK(built(mesh, {}, world()).polygons.size() == 1);
  const auto leaning = [](double degrees) {
    const double a = degrees * std::numbers::pi / 180;
    return Vec3d(std::sin(a), 0, std::cos(a));
  };
  mesh.normals[2] = leaning(0.4);
  CHECK(built(mesh, {}, world()).polygons.size() == 1);
  mesh.normals[2] = leaning(0.7);
  const SceneDescription smooth = built(mesh, {}, world());
  REQUIRE((smooth.polygons.empty() && smooth.patches.size() == 1));
  CHECK((smooth.vertices(smooth.patches[0])[2].normal - leaning(0.7)).length() < 1e-12);
  mesh.normals.assign(4, Vec3d(0, 0, 0));  // none of their own
  CHECK(built(mesh, {}, world()).polygons.size() == 1);
}

TEST_CASE("model builder: what a node mirrors shows its front, and normals stay outward") {
  ModelMesh mesh = square();
  for (const auto& space : {world(), scaled(-1, 1, 1), scaled(-1, -1, 1), scaled(2, -3, 1)})
    CHECK((normal_of(built(mesh, {}, space), 0) - Vec3d(0, 0, 1)).length() < 1e-12);
  CHECK((normal_of(built(mesh, {}, scaled(1, 1, -1)), 0) - Vec3d(0, 0, -1)).length() < 1e-12);
  mesh.normals.assign(4, Vec3d(1, 0, 1));
  const SceneDescription scene = built(mesh, {}, scaled(-2, 1, 1));
  const Vec3d normal = scene.vertices(scene.patches.at(0))[0].normal;
  CHECK((normal - Vec3d(-0.5, 0, 1).normalized()).length() < 1e-12);  // askew of what is stretched
}

TEST_CASE("model builder: triangles of a textured mesh share its corners, mirrored or not") {
  ModelMesh mesh = square();
  mesh.texture_points = {{0, 0}, {1, 0}, {1, std::nan("")}, {0, 1}};
  Material material;
  material.texture = 0;
  for (const bool is_mirrored : {false, true}) {
    ModelBuilder builder("model");
    builder.scene().textures.resize(1);
    builder.add(mesh, material, is_mirrored ? scaled(-1, 1, 1) : world());
    const SceneDescription scene = std::move(builder).finish({}).scene;
    REQUIRE((scene.triangles.size() == 2 && scene.meshes.size() == 1));
    CHECK((scene.meshes[0].positions.size() == 4 && scene.meshes[0].normals.empty()));
    CHECK(scene.meshes[0].texture_points[2] == Vec2d(0, 0));
    for (const Triangle& t : scene.triangles) {
      const auto c = corners_of(scene, t);
      CHECK((c[1].position - c[0].position).cross(c[2].position - c[0].position).z > 0);
    }
  }
  mesh.normals.assign(4, Vec3d(0.6, 0, 0.8));
  {
    ModelBuilder builder("model");
    builder.scene().textures.resize(1);
    builder.add(mesh, material, world());
    const SceneDescription smooth = std::move(builder).finish({}).scene;
    REQUIRE(smooth.meshes.at(0).normals.size() == 4);
    for (const Triangle& t : smooth.triangles)
      for (const auto& corner : corners_of(smooth, t))
        CHECK((corner.normal - Vec3d(0.6, 0, 0.8)).length() < 1e-6);
  }
  mesh.normals.clear();
  // Without texture points there is no texture, and polygons stay whole.
  mesh.texture_points.clear();
  const SceneDescription plain = built(mesh, material, world());
  CHECK((plain.polygons.size() == 1 && !plain.materials[0].texture));
}

TEST_CASE("model builder: faces without extent are counted, corners that are not there are refused") {
  ModelBuilder builder("model");
  ModelMesh mesh = square();
  mesh.corners = {0, 1, 0, 1, 2, 3}, mesh.ends = {3, 6};
  builder.add(mesh, {}, world());
  builder.skip();
  const ReadMesh read = std::move(builder).finish({"a"});
  CHECK(read.scene.polygons.size() == 1);
  CHECK(read.notes == std::vector<std::string>{"2 points, lines and faces without extent left out"});
  CHECK(read.files == std::vector<std::string>{"a"});
  mesh.corners[5] = 4;
  CHECK_THROWS_WITH(built(mesh, {}, world()), "model: error: a face names a vertex that is not there");
  CHECK_THROWS_WITH(built(square(), {}, scaled(1e101, 1, 1)),
                    "model: error: a coordinate is not finite, or beyond 1e100");
  ModelBuilder silent("model");
  silent.add(square(), {}, world());
  CHECK(std::move(silent).finish({}).notes.empty());
}

TEST_CASE("model builder: the first camera with a perspective is the view, as its node places it") {
  ModelBuilder builder("model");
  builder.add(square(), {}, world());
  builder.add(ModelCamera{.name = "flat", .half_height = 0}, world());
  builder.add(ModelCamera{.name = "a", .half_height = 0.5, .aspect = 2, .near = 0.25, .from = {1, 2, 3}},
              scaled(2, 2, 2));
  builder.add(ModelCamera{.name = "b", .half_height = 5}, world());
  const ReadMesh read = std::move(builder).finish({});
  CHECK(read.notes == std::vector<std::string>{"the camera 'flat' has no perspective: left out"});
  const View view = read.scene.view.value();
  CHECK((view.width == 2 * view.height && view.hither == 0.25));
  const double rows = view.height;
  CHECK(std::tan(view.angle_degrees * std::numbers::pi / 360) == Approx(0.5 * (rows - 1) / rows));
  CHECK((view.from == Vec3d(2, 4, 6) && view.at == Vec3d(2, 4, 5) && view.up == Vec3d(0, 1, 0)));
}

TEST_CASE("model builder: lights stand where their nodes do, and a sun has a direction") {
  ModelBuilder builder("model");
  builder.add(square(), {}, world());
  ModelSpace aside = scaled(2, 2, 2);
  aside.map.origin = {10, 0, 0};
  builder.add(Light{.position = {1, 2, 3}}, aside);
  builder.add(Light{.position = {0, 0, 1}, .is_sun = true}, aside);
  for (int i = 0; i < 2; ++i) builder.add(Light{.position = {0, 0, 0}, .is_sun = true}, aside);
  const ReadMesh read = std::move(builder).finish({});
  REQUIRE(read.scene.lights.size() == 2);
  CHECK(read.scene.lights[0].position == Vec3d(12, 4, 6));
  CHECK(read.scene.lights[1].position.normalized() == Vec3d(0, 0, 1));
  CHECK(read.notes == std::vector<std::string>{"2 suns without a direction: left out"});
}

TEST_CASE("model animation: frames are 24 a second from the first key to the last") {
  const auto frames = [](const std::vector<double>& times) {
    KeySpan span;
    for (const double t : times) span.add(t);
    std::vector<std::string> notes;
    const std::optional<FrameTimes> found = span.frames(notes);
    CHECK(notes.empty());
    return found;
  };
  CHECK_FALSE(frames({}));
  CHECK_FALSE(frames({3}));
  const FrameTimes second = *frames({1.5, 0.5, 1});
  CHECK((second.start == 0.5 && second.end == 1.5 && second.frames == 25));
  CHECK(frames({0, 1.01})->frames == 26);
  CHECK(frames({0, 1 + 1e-5})->frames == 25);                           // a float's rounding
  CHECK(frames({0, (kMostFrames - 1) / 24.0})->frames == kMostFrames);  // no more: nothing to tell
}

TEST_CASE("model animation: the one that is shown is named, and ten of the others") {
  std::vector<std::string> names = {"walk", "run", "jump"};
  CHECK(animation_taken(names, 1) ==
        "of 3 animations 'run' is shown; --animation takes another: 'walk', 'jump'");
  CHECK((animation_called(names, "") == 0 && animation_called(names, "jump") == 2));
  CHECK_THROWS_WITH(animation_called(names, "fly"), "it has no animation 'fly', but 'walk', 'run', 'jump'");
  CHECK_THROWS_WITH(animation_called({}, "fly"), "it has no animation 'fly'");
  names.clear();
  for (int i = 0; i < 12; ++i) names.push_back(std::to_string(i));
  CHECK(animation_taken(names, 0).ends_with("'1', '2', '3', '4', '5', '6', '7', '8', '9', '10' ..."));
  names.pop_back();
  CHECK(animation_taken(names, 0).ends_with("'9', '10'"));
}

TEST_CASE("model scene: whatever changes with time moves the scene") {
  SceneDescription scene = built(square(), {}, world());
  CHECK_FALSE(moves(scene));
  scene.movement.tracks["a"].translation = {{0, {0, 0, 0}}, {1, {1, 0, 0}}};
  CHECK_FALSE(moves(scene));  // of nothing
  SceneDescription node = scene, light = scene, camera = scene, triangle = scene;
  node.movement.nodes.push_back({.parent = 0, .track = "a"});
  CHECK(moves(node));
  light.light_nodes.push_back({.node = 0, .track = "a"});
  CHECK(moves(light));
  camera.movement.tracks[kCameraTrack] = camera.movement.tracks["a"];
  CHECK_FALSE(moves(camera));  // there is none
  camera.view = View();
  CHECK(moves(camera));
  triangle.moving_triangles.resize(1);
  CHECK(moves(triangle));
}

TEST_CASE("model scene: a view and a background are added where there are none, and told") {
  SceneDescription scene = built(square(), {}, world());
  CHECK(complete_view(scene, UpAxis::kZ) ==
        "no camera: one that shows everything is added, with z up (--up y for the other)");
  REQUIRE(scene.view);
  CHECK(scene.view->up == Vec3d(0, 0, 1));
  CHECK_FALSE(complete_view(scene, UpAxis::kY));
  scene.view.reset();
  CHECK(complete_view(scene, UpAxis::kY) ==
        "no camera: one that shows everything is added, with y up (--up z for the other)");
  SceneDescription empty;
  CHECK_FALSE(complete_view(empty, UpAxis::kY));
  CHECK(complete_background(scene) == "no background: a grey one is added");
  CHECK(scene.background == Rgb(0.18, 0.2, 0.23));
  CHECK_FALSE(complete_background(scene));
  empty.sky = Sky();
  CHECK_FALSE(complete_background(empty));
}

TEST_CASE("model scene: a turn goes once round in four seconds, with its lights where they were added") {
  for (const UpAxis up : {UpAxis::kY, UpAxis::kZ}) {
    SceneDescription scene = built(square(), {}, world());
    complete_view(scene, up);
    const View first = *scene.view;
    const Vec3d center = bounds(scene).center(), axis = up == UpAxis::kY ? Vec3d(0, 1, 0) : Vec3d(0, 0, 1);
    scene.lights = {{.position = first.from + Vec3d(1, 2, 3)}};
    SceneDescription own = scene;
    add_turn(scene, up, 10, true);
    REQUIRE(scene.movement.times);
    CHECK((scene.movement.times->frames == 40 && scene.movement.times->end == Approx(3.9)));
    for (const double time : {0.0, 0.7, 1.0, 2.0, 3.9}) {
      const double angle = 2 * std::numbers::pi * time / 4;
      const auto turned = [&](const Vec3d& p) {
        const Vec3d arm = p - center, along = axis * arm.dot(axis), across = arm - along;
        return center + along + across * std::cos(angle) + axis.cross(across) * std::sin(angle);
      };
      INFO("at " << time << " s");
      const SceneDescription now = still_at(scene, time);
      CHECK((now.view->from - turned(first.from)).length() < 0.02);
      REQUIRE(now.lights.size() == 1);
      CHECK((now.lights[0].position - turned(first.from + Vec3d(1, 2, 3))).length() < 0.02);
    }
    add_turn(own, up, 10, false);
    CHECK((still_at(own, 2).lights[0].position - first.from - Vec3d(1, 2, 3)).length() < 1e-9);
    SceneDescription slow = own;
    add_turn(slow, up, 0.1, false);
    CHECK(slow.movement.times->frames == 2);
  }
}

TEST_CASE("material meshes: triangles are sorted by node and material, with a normal at each vertex") {
  SceneDescription scene;
  scene.materials = {{}, {.color = {1, 0, 0}}};
  const Vec3d triangle[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, line[] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  const PatchVertex patch[] = {{{0, 0, 0}, {0, 0, 0}}, {{0, 2, 0}, {0, 0, 3}}, {{2, 0, 0}, {0, 0, -1}}};
  add_polygon(scene, triangle, 1);
  add_polygon(scene, line, 1);
  add_patch(scene, patch, 1);
  add_polygon(scene, triangle, 0);
  add_sphere(scene, {{0, 0, 0}, 0, 0, {}});
  add_sphere(scene, {{0, 0, 0}, 1, 0, {}});
  std::size_t degenerate = 99;
  const MaterialMeshes meshes = material_meshes(scene, {2, {}}, degenerate);
  CHECK(degenerate == 2);
  REQUIRE(meshes.size() == 2);
  const MaterialMesh& red = meshes.at({0, 1});
  REQUIRE((red.vertices.size() == 6 && red.triangles.size() == 2));
  CHECK(red.vertices[0].normal == Vec3d(0, 0, 1));
  CHECK(red.vertices[3].normal == Vec3d(0, 0, -1));  // the polygon's, which is seen from below
  CHECK((red.vertices[4].normal == Vec3d(0, 0, 1) && red.vertices[5].normal == Vec3d(0, 0, -1)));
  for (const std::uint32_t corner : red.triangles[1]) CHECK(corner >= 3);
  CHECK(meshes.at({0, 0}).triangles.size() == 1 + 48);
}

TEST_CASE("model scene: a model's own lights stay, and one without gets two, if they are asked for") {
  const auto load = [](bool has_light, bool adds_lights) {
    GltfSample sample;
    sample.node({{"mesh", sample.triangle()}});
    sample.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    if (has_light)
      sample.node({{"translation", {0, 0, 2}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    return load_model(sample.write(), {.adds_lights = adds_lights});
  };
  const Model own = load(true, true), added = load(false, true), dark = load(false, false);
  CHECK((own.parsed.scene.lights.size() == 1 && !own.is_lit_anew));
  CHECK((added.parsed.scene.lights.size() == 2 && added.is_lit_anew));
  CHECK((dark.parsed.scene.lights.empty() && !dark.is_lit_anew));
  const std::string told = "no lights: a key light and a fill light are added\n";
  CHECK(added.parsed.warnings.ends_with(told));
  for (const Model* other : {&own, &dark}) CHECK(other->parsed.warnings.find(told) == std::string::npos);
}

TEST_CASE(
    "model scene: a process that reads has four times its processor's time, and memory for a library's "
    "scene") {
  const MeshLimits limits{.seconds = 7, .memory_bytes = 100};
  const CallLimits plenty = call_limits(limits, 1000);
  CHECK((plenty.cpu_seconds == 7 && plenty.wall_seconds == 28 && plenty.memory_bytes == 400));
  CHECK(call_limits(limits, 399).memory_bytes == 399);
  CHECK(call_limits({.memory_bytes = ~std::uint64_t{0}}, 1000).memory_bytes == 1000);
}

}  // namespace pprt::model_builder_test
