#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "base/counted.h"
#include "base/diagnostics.h"
#include "convert/mesh/mesh_reader.h"
#include "convert/mesh/mesh_writer.h"
#include "convert/model/model_losses.h"
#include "spd/spd.h"
#include "unit/image/temporary_directory.h"

namespace pprt::mesh_files_test {

namespace {

std::string put(const TemporaryDirectory& folder, const WrittenMesh& mesh) {
  std::string last;
  for (const MeshFile& file : mesh.files) {
    last = (folder.path() / file.name).string();
    std::ofstream(last, std::ios::binary) << file.bytes;
  }
  return last;
}

void put(const TemporaryDirectory& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder.path() / name, std::ios::binary) << text;
}

// As Assimp alone sees a file; the scenes here have no transformed meshes.
struct Census {
  std::size_t triangles = 0;
  Box3d box;
};

Census census(const std::string& path) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, 0);
  REQUIRE(scene != nullptr);
  Census result;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      CHECK(mesh.mFaces[f].mNumIndices == 3);
      ++result.triangles;
    }
    CHECK(mesh.mNormals != nullptr);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      result.box.extendBy(Vec3d(mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z));
    }
  }
  return result;
}

void check_near(const Vec3d& a, const Vec3d& b, double tolerance) {
  CAPTURE(a.x, a.y, a.z, b.x, b.y, b.z);
  CHECK((a - b).length() <= tolerance);
}

// Gears: 144-cornered concave polygons, two materials, no curved surface.
std::size_t gears_triangles(const SceneDescription& gears) {
  std::size_t count = 0;
  for (const Polygon& p : gears.polygons) count += p.vertex_count - 2;
  return count;
}

}  // namespace

TEST_CASE("Assimp reads back the counts and bounds of every database in every mesh format") {
  const TemporaryDirectory folder;
  for (const std::string& extension : mesh_output_extensions()) {
    for (const SpdDatabase& database : spd_databases()) {
      CAPTURE(extension, database.name);
      const SceneDescription scene = make_spd(database.name, 1);
      const WrittenMesh written = write_mesh(scene, extension, "mesh", {9, {}});
      const Census read = census(put(folder, written));
      CHECK(read.triangles == written.triangles);
      const Box3d whole = bounds(scene);
      // Chords fall short of a curve by less than a hundredth of its radius, floats by far less.
      const double tolerance = scene.spheres.empty() && scene.cones.empty() ? 1e-5 : 0.02;
      check_near(read.box.min, whole.min, tolerance * whole.size().length());
      check_near(read.box.max, whole.max, tolerance * whole.size().length());
    }
  }
}

TEST_CASE("concave polygons keep their area in the triangles of a mesh") {
  const SceneDescription gears = make_spd("gears", 1);
  CHECK(write_mesh(gears, ".ply", "mesh", {}).triangles == gears_triangles(gears));
}

TEST_CASE("a scene read back from a mesh file is the tessellated scene") {
  const TemporaryDirectory folder;
  SceneDescription scene = make_spd("mount", 3);
  scene.lights[0].color = Rgb(1, 0.5, 0);
  for (const std::string& extension : mesh_output_extensions()) {
    CAPTURE(extension);
    const ReadMesh read = read_mesh(put(folder, write_mesh(scene, extension, "mesh", {6, {}})));
    CHECK(read.notes.empty() == !extension.starts_with(".gl"));  // whose lights weaken with the distance
    CHECK(read.scene.polygons.size() == 128);                    // the mountain is flat, facet by facet
    CHECK(read.scene.patches.size() == 4 * 432);                 // the spheres are smooth
    for (std::size_t i = 0; i < read.scene.patches.size(); i += 100) {
      for (const PatchVertex& v : read.scene.vertices(read.scene.patches[i])) {
        CHECK(v.normal.length() == Approx(1).epsilon(1e-3));
      }
    }
  }
}

TEST_CASE("materials are kept by the mesh formats that have them") {
  const TemporaryDirectory folder;
  const SceneDescription scene = make_spd("mount", 2);
  const auto glass = [&](const std::string& extension) {
    const ReadMesh read = read_mesh(put(folder, write_mesh(scene, extension, "mesh", {1, {}})));
    REQUIRE(read.scene.materials.size() == 2);
    Material m = read.scene.materials[0];
    if (m.transmittance == 0) m = read.scene.materials[1];
    // Colour and Kd come back as their product. In glTF what is mirrored or let through is not reflected.
    CHECK(m.color.x == Approx(extension.starts_with(".gl") ? 0.1 * 0.9 : 0.1));
    CHECK(m.diffuse == 1);
    CHECK(m.specular == Approx(0.1));
    CHECK(m.transmittance == Approx(0.9));
    CHECK(m.refractive_index == 1.5);
    return m;
  };
  CHECK(glass(".obj").shine == Approx(scene.materials[0].shine));
  CHECK(glass(".dae").shine == Approx(scene.materials[0].shine));
  CHECK(glass(".glb").shine == 0);
  CHECK(glass(".gltf").shine == 0);
  for (const std::string extension : {".ply", ".stl"}) {
    const ReadMesh read = read_mesh(put(folder, write_mesh(scene, extension, "mesh", {1, {}})));
    CHECK(read.scene.materials == std::vector<Material>{{}});
  }
}

TEST_CASE("camera and lights are kept by Collada") {
  const TemporaryDirectory folder;
  SceneDescription scene = make_spd("tree", 1);
  scene.view->width = 640;
  scene.view->height = 400;
  scene.view->angle_degrees = 30;
  scene.lights[1].color = Rgb(1, 0.5, 0);
  const ReadMesh read = read_mesh(put(folder, write_mesh(scene, ".dae", "mesh", {1, {}})));
  REQUIRE(read.scene.view);
  const View& view = *read.scene.view;
  check_near(view.from, scene.view->from, 1e-5);
  check_near((view.at - view.from).normalized(), (scene.view->at - scene.view->from).normalized(), 1e-6);
  const double ratio = static_cast<double>(view.width) / view.height;
  CHECK(ratio == Approx(1.6).epsilon(0.002));
  // The tangents of the pictures' upper edges, half a pixel beyond the rows' centres.
  const auto edge = [](const View& v) {
    return std::tan(v.angle_degrees * M_PI / 360) * v.height / (v.height - 1);
  };
  CHECK(edge(view) == Approx(edge(*scene.view)).epsilon(0.002));
  REQUIRE(read.scene.lights.size() == 7);
  for (std::size_t i = 0; i < 7; ++i)
    check_near(read.scene.lights[i].position, scene.lights[i].position, 1e-4);
  CHECK_FALSE(read.scene.lights[0].color);
  REQUIRE(read.scene.lights[1].color);
  CHECK(*read.scene.lights[1].color == Rgb(1, 0.5, 0));
}

TEST_CASE("lamps and suns are kept by the mesh formats that have them") {
  const TemporaryDirectory folder;
  SceneDescription scene = make_spd("mount", 2);
  for (Material& m : scene.materials) m.emission = {0.5, 0.25, 0};
  scene.lights = {{{1, 2, 2}, Rgb(1, 0.5, 0), {}, true}};
  for (const std::string extension : {".obj", ".dae", ".gltf", ".glb"}) {
    CAPTURE(extension);
    const ReadMesh read = read_mesh(put(folder, write_mesh(scene, extension, "mesh", {1, {}})));
    CHECK(read.notes.empty());
    for (const Material& m : read.scene.materials) {
      CHECK(m.emission.x == Approx(0.5).epsilon(1e-5));
      CHECK(m.emission.y == Approx(0.25).epsilon(1e-5));
      CHECK(m.emission.z == 0);
    }
    if (extension == ".obj") continue;  // has no lights
    REQUIRE(read.scene.lights.size() == 1);
    CHECK(read.scene.lights[0].is_sun);
    check_near(read.scene.lights[0].position.normalized(), Vec3d(1, 2, 2) / 3, 1e-6);
    CHECK(read.scene.lights[0].color->z == 0);
  }
  for (Material& m : scene.materials) m.emission = {0, 0, 0};  // the control
  const ReadMesh dark = read_mesh(put(folder, write_mesh(scene, ".glb", "mesh", {1, {}})));
  CHECK(dark.scene.materials[0].emission == Rgb(0, 0, 0));
}

namespace {

// A triangle, libraries, and further nodes.
std::string collada(const std::string& libraries, const std::string& nodes) {
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Y_UP</up_axis></asset>)" +
         libraries +
         R"(<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0
</float_array><technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="1">
<input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><!-- <node id="n"> --><node id="n"><instance_geometry url="#g"/></node>
)" + nodes +
         R"(</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

// A node that holds something, in front of the triangle.
std::string node_of(const std::string& id, const std::string& content) {
  return "<node id=\"" + id + "\"><translate>0 0 8</translate>" + content + "</node>";
}

std::string camera_of(const std::string& id, const std::string& optics) {
  return "<camera id=\"" + id + "\"><optics><technique_common><perspective>" + optics +
         "</perspective></technique_common></optics></camera>";
}

bool tells(const ReadMesh& read, ModelLoss loss, std::size_t count) {
  const auto& [one, many] = kModelLossWords[static_cast<std::size_t>(loss)];
  return std::count(read.notes.begin(), read.notes.end(), counted(count, one, many)) == 1;
}

}  // namespace

TEST_CASE("a camera of Collada has its angle, whether or not that has a sid") {
  const TemporaryDirectory folder;
  const auto edges = [&](const std::string& optics) {
    put(folder, "a.dae",
        collada(
            "<library_cameras>" + camera_of("c", optics) + "</library_cameras>",
            R"(<node id="eye" name="The eye"><translate>0 0 8</translate><instance_camera url="#c"/></node>)"));
    const View view = read_mesh((folder.path() / "a.dae").string()).scene.view.value();
    const double half = std::tan(view.angle_degrees * M_PI / 360) * view.height / (view.height - 1);
    return std::pair(2 * std::atan(half) * 180 / M_PI, static_cast<double>(view.width) / view.height);
  };
  const double height = 2 * std::atan(std::tan(43.8 * M_PI / 360) / 1.5) * 180 / M_PI;  // 30.0 degrees
  for (const std::string optics :
       {"<xfov>43.8</xfov><aspect_ratio>1.5</aspect_ratio><znear>.1</znear>",
        "<xfov sid=\"x\">43.8</xfov><aspect_ratio sid=\"a\">1.5</aspect_ratio><znear>.1</znear>"}) {
    CHECK(edges(optics).first == Approx(height));
    CHECK(edges(optics).second == Approx(1.5));
  }
  CHECK(edges("<yfov> 30 </yfov><znear>1</znear>").first == Approx(30));
  CHECK(edges("<xfov>40</xfov><yfov>20</yfov>").second ==
        Approx(std::tan(M_PI / 9) / std::tan(M_PI / 18)).epsilon(0.002));
}

TEST_CASE("an OBJ with a quadrilateral, a mirror and a line is read without the line") {
  const TemporaryDirectory folder;
  put(folder, "a.mtl", "newmtl red\nKd 0.5 0 0\nKs 0.25 0.25 0.25\nNs 40\nd 1\n");
  put(folder, "a.obj",
      "mtllib a.mtl\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 9 9 9\nusemtl red\nf 1 2 3 4\nf 1 2 2\n");
  const ReadMesh read = read_mesh((folder.path() / "a.obj").string());
  REQUIRE(read.scene.polygons.size() == 1);
  CHECK(read.scene.polygons[0].vertex_count == 4);
  CHECK(read.notes == std::vector<std::string>{"1 point, line or face without extent left out"});
  const Material& m = read.scene.materials[read.scene.polygons[0].material];
  CHECK(m == Material{Rgb(0.5, 0, 0), 1, 0.25, 40, 0, 1});
  CHECK_FALSE(read.scene.view);
  CHECK(read.scene.lights.empty());
}

TEST_CASE("what of Collada's lights and cameras is lost is told") {
  const TemporaryDirectory folder;
  const auto light = [](const std::string& id, const std::string& kind, const std::string& more) {
    return "<light id=\"" + id + "\"><technique_common><" + kind + "><color>1 1 1</color>" + more + "</" +
           kind + "></technique_common></light>";
  };
  const std::string lights = light("a", "spot", "<falloff_angle>30</falloff_angle>") +
                             light("b", "point", "<quadratic_attenuation>1</quadratic_attenuation>") +
                             light("d", "ambient", "") + light("e", "point", "");
  std::string cameras, nodes;
  for (const std::string id : {"c1", "c2", "c3"}) {
    cameras += camera_of(id, "<yfov>30</yfov><znear>1</znear>");
    nodes += node_of("at-" + id, "<instance_camera url=\"#" + id + "\"/>");
  }
  for (const std::string id : {"a", "b", "d", "e"})
    nodes += node_of("lit-" + id, "<instance_light url=\"#" + id + "\"/>");
  put(folder, "a.dae",
      collada(
          "<library_cameras>" + cameras + "</library_cameras><library_lights>" + lights + "</library_lights>",
          nodes));
  const ReadMesh read = read_mesh((folder.path() / "a.dae").string());
  CHECK(read.scene.lights.size() == 3);
  CHECK(tells(read, ModelLoss::kSpot, 1));
  CHECK(tells(read, ModelLoss::kDistance, 1));
  CHECK(tells(read, ModelLoss::kCameras, 2));
  CHECK(std::any_of(read.notes.begin(), read.notes.end(), [](const std::string& note) {
    return note.ends_with("is neither a point, nor a spot, nor a sun: left out");
  }));
  CHECK(read.notes.size() == 4);
}

TEST_CASE("pictures of materials that a scene cannot hold are told, once for each material") {
  const TemporaryDirectory folder;
  put(folder, "a.mtl",
      "newmtl bumpy\nKd 1 1 1\nmap_Bump b.png\nnewmtl leaf\nKd 1 1 1\nmap_d d.png\nmap_Ks s.png\nnewmtl "
      "plain\n");
  put(folder, "a.obj",
      "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl bumpy\nf 1 2 3\nusemtl leaf\nf 1 2 3\nusemtl plain\nf "
      "1 2 3\n"
      "usemtl leaf\nf 2 3 1\n");
  const ReadMesh read = read_mesh((folder.path() / "a.obj").string());
  CHECK(tells(read, ModelLoss::kNormalMap, 1));
  CHECK(tells(read, ModelLoss::kOtherPictures, 1));
  CHECK(read.notes.size() == 2);
}

TEST_CASE("colours at the vertices of a mesh become a texture, also of faces with four corners") {
  const TemporaryDirectory folder;
  put(folder, "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n"
      "0 0 0 255 0 0\n1 0 0 0 255 0\n1 1 0 0 0 255\n0 1 0 188 188 188\n4 0 1 2 3\n");
  const ReadMesh read = read_mesh((folder.path() / "a.ply").string());
  CHECK(read.notes.empty());
  REQUIRE((read.scene.meshes.size() == 1 && read.scene.textures.size() == 1));
  const TriangleMesh& mesh = read.scene.meshes[0];
  CHECK(read.scene.materials[mesh.material].color == Rgb(1, 1, 1));
  const Texture& texture = read.scene.textures[0];
  const auto color_at = [&](const Vec3d& position) {
    const auto corner =
        std::find(mesh.positions.begin(), mesh.positions.end(), position) - mesh.positions.begin();
    const Vec2d place =
        mesh.texture_points.at(static_cast<std::size_t>(corner)) * Vec2d(texture.width, texture.height);
    const auto texel = static_cast<std::size_t>(place.y) * static_cast<std::size_t>(texture.width) +
                       static_cast<std::size_t>(place.x);
    return std::vector<int>{texture.rgb.at(3 * texel), texture.rgb.at(3 * texel + 1),
                            texture.rgb.at(3 * texel + 2)};
  };
  CHECK(mesh.positions.size() == 6);
  CHECK(color_at({0, 0, 0}) == std::vector{255, 0, 0});
  CHECK(color_at({1, 0, 0}) == std::vector{0, 255, 0});
  CHECK(color_at({1, 1, 0}) == std::vector{0, 0, 255});
  CHECK(color_at({0, 1, 0}) == std::vector{188, 188, 188});
}

TEST_CASE("nodes of one name are told") {
  const TemporaryDirectory folder;
  const std::string cube =
      "OBJECT poly\nname \"cube\"\nnumvert 3\n0 0 0\n1 0 0\n0 1 0\nnumsurf 1\nSURF 0x20\nmat 0\nrefs 3\n"
      "0 0 0\n1 1 0\n2 0 1\nkids 0\n";
  put(folder, "a.ac",
      "AC3Db\nMATERIAL \"m\" rgb 1 1 1 amb 1 1 1 emis 0 0 0 spec 0 0 0 shi 0 trans 0\nOBJECT world\nkids "
      "3\n" +
          cube + cube + cube);
  CHECK(tells(read_mesh((folder.path() / "a.ac").string()), ModelLoss::kNamesakes, 2));
}

TEST_CASE("a mesh that cannot be read is an error with the file's name") {
  const TemporaryDirectory folder;
  const std::string missing = (folder.path() / "none.obj").string();
  CHECK_THROWS_WITH(read_mesh(missing), "cannot read '" + missing + "': No such file or directory");
  put(folder, "bad.ply", "ply\nformat nonsense\n");
  CHECK_THROWS_AS(read_mesh((folder.path() / "bad.ply").string()), InputError);
  put(folder, "points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2 3\n");
  CHECK_THROWS_AS(read_mesh((folder.path() / "points.obj").string()), InputError);
}

TEST_CASE("mesh extensions are recognised, and .nff is not one of them") {
  for (const char* extension : {".obj", ".ply", ".stl", ".gltf", ".glb", ".dae"})
    CHECK(is_mesh_extension(extension));
  for (const char* extension : {".nff", ".png", "", "."}) CHECK_FALSE(is_mesh_extension(extension));
}

TEST_CASE("writing a mesh without triangles is an error") {
  SceneDescription scene;
  scene.name = "a.nff";
  scene.materials = {{}};
  add_sphere(scene, {{0, 0, 0}, 0, 0, {}});
  CHECK_THROWS_WITH(write_mesh(scene, ".ply", "mesh", {}),
                    "a.nff: error: no object of the scene has any extent");
}

}  // namespace pprt::mesh_files_test
