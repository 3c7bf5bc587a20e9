// Hostile and broken texts: limits, truncation, mutation.
#include <catch2/catch.hpp>
#include <filesystem>
#include <random>
#include <string>

#include "parser/text/text_input.h"
#include "unit/parser/nff_sample.h"

namespace pprt::nff_limits_test {
namespace {

// Indices of a scene that was accepted are in range.
bool consistent(const SceneDescription& scene) {
  bool ok = scene.primitive_count() ==
            scene.spheres.size() + scene.cones.size() + scene.polygons.size() + scene.patches.size();
  const auto has = [&](MaterialIndex material) { return material < scene.materials.size(); };
  for (const Sphere& s : scene.spheres) ok = ok && has(s.material);
  for (const Cone& c : scene.cones) ok = ok && has(c.material);
  for (const Polygon& p : scene.polygons) {
    ok = ok && has(p.material) && p.first_vertex + p.vertex_count <= scene.polygon_vertices.size();
  }
  for (const Patch& p : scene.patches) {
    ok = ok && has(p.material) && p.first_vertex + p.vertex_count <= scene.patch_vertices.size();
  }
  return ok;
}

// Accepted with a consistent scene, or rejected with a report.
bool survives(std::string_view text, const NffOptions& options) {
  try {
    return consistent(parse_nff(text, "t.nff", options).scene);
  } catch (const InputError& error) {
    return std::string_view(error.what()).starts_with("t.nff:");
  }
}

}  // namespace

TEST_CASE("a vertex count larger than the text reserves no memory") {
  CHECK(report("p 4000000000") ==
        "t.nff:1:3: error: 'p' with more than 1000000 vertices\n"
        "    p 4000000000\n"
        "      ^");
  CHECK(report("f 1 1 1 1 0 0 0 1\npp 900000 1 1 1") ==
        "t.nff:2:4: error: 'pp' with 900000 vertices, but only 6 bytes of the file are left\n"
        "    pp 900000 1 1 1\n"
        "       ^");
  CHECK(report("p -3 1 1 1") ==
        "t.nff:1:3: error: the number of vertices of 'p' must be a whole number\n"
        "    p -3 1 1 1\n"
        "      ^");
}

TEST_CASE("a text beyond a limit is rejected, and the message names the limit") {
  NffOptions options;
  options.max_bytes = 100;
  options.max_primitives = 2;
  options.max_lights = 1;
  options.max_materials = 1;
  options.max_polygon_vertices = 3;
  const std::string fill = "f 1 1 1 1 0 0 0 1\n";
  CHECK(report(fill + std::string(100, ' '), options) == "t.nff: error: larger than the limit of 100 bytes");
  CHECK(report(fill + "s 0 0 0 1\ns 0 0 0 1\n", options).empty());
  CHECK(report(fill + "s 0 0 0 1\ns 0 0 0 1\ns 0 0 0 1\ns 0 0 0", options) ==
        "t.nff:4:1: error: more than 2 objects\n"
        "    s 0 0 0 1\n"
        "    ^");
  CHECK(report("l 1 2 3\nl 1 2 3", options) ==
        "t.nff:2:1: error: more than 1 lights\n"
        "    l 1 2 3\n"
        "    ^");
  CHECK(report(fill + fill, options).empty());
  CHECK(report(fill + "f 1 1 1 1 0 0 0 2\n", options) ==
        "t.nff:2:1: error: more than 1 different materials\n"
        "    f 1 1 1 1 0 0 0 2\n"
        "    ^");
  CHECK(report(fill + "p 4 0 0 0 1 0 0 1 1 0 0 1 0", options) ==
        "t.nff:2:3: error: 'p' with more than 3 vertices\n"
        "    p 4 0 0 0 1 0 0 1 1 0 0 1 0\n"
        "      ^");
}

TEST_CASE("reading stops after max_errors errors and reports it") {
  NffOptions options;
  options.max_errors = 2;
  CHECK(report("s 0\ns 1\ns 2\n", options) ==
        "t.nff:1:4: error: expected a number for y of the centre of 's', found 's' on line 2\n"
        "    s 0\n"
        "       ^\n"
        "t.nff:2:4: error: expected a number for y of the centre of 's', found 's' on line 3\n"
        "    s 1\n"
        "       ^\n"
        "t.nff: reading stopped after 2 errors");
}

TEST_CASE("a scene cut off at any byte is read or rejected") {
  for (std::size_t length = 0; length <= kSample.size(); ++length) {
    CAPTURE(length);
    CHECK(survives(kSample.substr(0, length), {}));
    CHECK(survives(kSample.substr(0, length), strict()));
  }
}

TEST_CASE("every scene of tests/wild, cut off at any byte, is read or rejected") {
  int scenes = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(PPRT_SOURCE_DIR) + "/tests/wild")) {
    if (entry.path().extension() != ".nff") continue;
    const std::string text = read_text(entry.path().string(), 1 << 20);
    CAPTURE(entry.path().string());
    for (std::size_t length = 0; length <= text.size(); ++length) {
      if (!survives(text.substr(0, length), {})) FAIL_CHECK("cut off at byte " << length);
    }
    ++scenes;
  }
  CHECK(scenes > 100);
}

TEST_CASE("a scene with random bytes changed is read or rejected") {
  constexpr std::string_view kBytes = "0123456789.+-eE \n\r\t#%/*vblfcsp\xff\x1a,{}:anitx";
  std::mt19937 random(20260101);
  const auto below = [&](std::size_t n) { return random() % n; };
  for (int round = 0; round < 4000; ++round) {
    std::string text(kSample);
    for (std::size_t changes = 1 + below(6); changes > 0; --changes) {
      const std::size_t at = below(text.size());
      switch (below(3)) {
        case 0:
          text[at] = kBytes[below(kBytes.size())];
          break;
        case 1:
          text.insert(at, 1, kBytes[below(kBytes.size())]);
          break;
        default:
          text.erase(at, 1 + below(8));
      }
    }
    if (!survives(text, round % 2 == 0 ? NffOptions{} : strict())) {
      CAPTURE(text);
      FAIL();
    }
  }
}

}  // namespace pprt::nff_limits_test
