#include <catch2/catch.hpp>
#include <string>

#include "unit/parser/nff_sample.h"

namespace pprt::nff_scene_test {

TEST_CASE("each entity of a scene is read as it stands") {
  const ParsedScene parsed = parse_nff(kSample, "sample.nff", strict());
  const SceneDescription& scene = parsed.scene;
  CHECK(parsed.warnings.empty());
  CHECK(scene.name == "sample.nff");
  CHECK(scene.background == Rgb(0.078, 0.361, 0.753));

  REQUIRE(scene.view);
  CHECK(scene.view->from == Vec3d(2.1, 1.3, 1.7));
  CHECK(scene.view->at == Vec3d(0, 0, 0));
  CHECK(scene.view->up == Vec3d(0, 0, 1));
  CHECK(scene.view->angle_degrees == 45);
  CHECK(scene.view->hither == 0.01);
  CHECK(scene.view->width == 512);
  CHECK(scene.view->height == 256);

  REQUIRE(scene.lights.size() == 2);
  CHECK(scene.lights[0].position == Vec3d(4, 3, 2));
  CHECK_FALSE(scene.lights[0].color);
  CHECK(scene.lights[1].position == Vec3d(1, -4, 4));
  CHECK(scene.lights[1].color == Rgb(1, 0.5, 0.25));

  REQUIRE(scene.materials.size() == 2);
  CHECK(scene.materials[0] == Material{{1, 0.75, 0.33}, 0.8, 0, 100000, 0, 1});
  CHECK(scene.materials[1] == Material{{1, 0.9, 0.7}, 0.5, 0.5, 3.0827, 0.25, 1.5});

  REQUIRE(scene.spheres.size() == 1);
  CHECK(scene.spheres[0].center == Vec3d(0, 0, 0));
  CHECK(scene.spheres[0].radius == 0.5);
  CHECK(scene.spheres[0].material == 1);
  REQUIRE(scene.cones.size() == 1);
  CHECK(scene.cones[0].base == Vec3d(0, 0, 0));
  CHECK(scene.cones[0].base_radius == 1);
  CHECK(scene.cones[0].apex == Vec3d(0, 0, 1));
  CHECK(scene.cones[0].apex_radius == 0.5);
  REQUIRE(scene.polygons.size() == 1);
  REQUIRE(scene.vertices(scene.polygons[0]).size() == 4);
  CHECK(scene.vertices(scene.polygons[0])[1] == Vec3d(-12, 12, -0.5));
  REQUIRE(scene.patches.size() == 1);
  REQUIRE(scene.vertices(scene.patches[0]).size() == 3);
  CHECK(scene.vertices(scene.patches[0])[1].position == Vec3d(1, 0, 0));
  CHECK(scene.vertices(scene.patches[0])[1].normal == Vec3d(0, 0, 2));
  CHECK(scene.patches[0].material == 0);
  CHECK(scene.order == std::vector<PrimitiveRef>{{PrimitiveKind::kPolygon, 0},
                                                 {PrimitiveKind::kSphere, 0},
                                                 {PrimitiveKind::kCone, 0},
                                                 {PrimitiveKind::kPatch, 0}});
}

TEST_CASE("each entity keeps the place of its keyword") {
  const SceneDescription scene = pprt::scene(kSample);
  CHECK(scene.view->location == SourceLocation{2, 1});
  CHECK(scene.lights[1].location == SourceLocation{10, 1});
  CHECK(scene.polygons[0].location == SourceLocation{12, 1});
  CHECK(scene.spheres[0].location == SourceLocation{18, 1});
  CHECK(scene.cones[0].location == SourceLocation{19, 1});
  CHECK(scene.patches[0].location == SourceLocation{21, 1});
  CHECK(pprt::scene("f 1 1 1 1 0 0 0 1\r  # note\r\n\ts 0 0 0 1").spheres[0].location ==
        SourceLocation{3, 2});
}

TEST_CASE("thousands of f lines with four distinct ones make four materials") {
  std::string text;
  for (int i = 0; i < 8281; ++i) {
    text += "f 0." + std::to_string(i % 4 + 1) + " 0.5 0.5 1 0 0 0 0\ns 0 0 0 1\n";
  }
  const SceneDescription scene = parse_nff(text, "t.nff", strict()).scene;
  CHECK(scene.materials.size() == 4);
  REQUIRE(scene.spheres.size() == 8281);
  for (std::size_t i = 0; i < scene.spheres.size(); ++i) REQUIRE(scene.spheres[i].material == i % 4);
}

TEST_CASE("a scene with lines ended by CR, CR LF or blanks alone is the same scene") {
  const auto with = [](std::string_view end) {
    std::string text;
    for (const char c : kSample) text += c == '\n' ? std::string(end) : std::string(1, c);
    return parse_nff(text, "t.nff", strict()).scene;
  };
  const SceneDescription plain = with("\n");
  for (const std::string_view end : {"\r\n", "\r", " ", " \t\f\v\n", " # comment s 1 2 3\n", "#glued\r\n"}) {
    CAPTURE(end);
    const SceneDescription other = with(end);
    CHECK(other.order == plain.order);
    CHECK(other.materials == plain.materials);
    CHECK(other.polygon_vertices == plain.polygon_vertices);
    CHECK(other.view->height == plain.view->height);
    CHECK(other.lights.size() == plain.lights.size());
  }
}

TEST_CASE("rounding residues and negative radii of SPD's files are read") {
  const SceneDescription scene =
      parse_nff("f 1 1 1 1 0 0 0 0\ns 1.11022e-16 -0 .5 -2\nc 0 0 0 -1 0 0 1 -1\nc 0 0 0 0 0 0 1 2\n",
                "t.nff", strict())
          .scene;
  CHECK(scene.spheres[0].center == Vec3d(1.11022e-16, 0, 0.5));
  CHECK(scene.spheres[0].radius == -2);
  CHECK(scene.cones[0].apex_radius == -1);
  CHECK(scene.cones[1].apex_radius == 2);
}

}  // namespace pprt::nff_scene_test
