#include "convert/gltf/gltf_document.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "convert/mesh/mesh_writer.h"
#include "convert/model/display_values.h"
#include "convert/model/read_mesh.h"
#include "parser/aff_parser.h"

namespace pprt::gltf_document_test {

using nlohmann::json;

namespace {

json document_of(const SceneDescription& scene) {
  return json::parse(write_mesh(scene, ".gltf", "m", {2, {}}).files.back().bytes);
}

// A square with the sides 2 around the origin, whose box has the squared diagonal 8, and lights.
SceneDescription lit(const std::string& lights) {
  return parse_aff("f 1 1 1 1 0 0 0 1 p 4 -1 -1 0 1 -1 0 1 1 0 -1 1 0 " + lights, "a.aff").scene;
}

std::vector<double> intensities(const SceneDescription& scene) {
  std::vector<double> result;
  const json lights = document_of(scene)["extensions"]["KHR_lights_punctual"]["lights"];
  for (const json& light : lights) result.push_back(light["intensity"].get<double>());
  return result;
}

}  // namespace

// A point light of glTF gives intensity / distance^2 (KHR_lights_punctual).
TEST_CASE("gltf document: a light's intensity is the square of its distance from the middle") {
  const std::vector<double> found = intensities(lit("l 0 0 3  l 0 6 0  l 0 0 20"));
  REQUIRE(found.size() == 3);
  CHECK(found[0] == Approx(9));
  CHECK(found[1] == Approx(36));
  CHECK(found[2] == Approx(400));
}

TEST_CASE("gltf document: the middle is that of the scene, not the origin") {
  const SceneDescription scene =
      parse_aff("f 1 1 1 1 0 0 0 1 p 4 9 9 0 11 9 0 11 11 0 9 11 0 l 10 10 3", "a.aff").scene;
  CHECK(intensities(scene).at(0) == Approx(9));
}

TEST_CASE("gltf document: a light within the scene is not dark") {
  CHECK(intensities(lit("l 0 0 0")).at(0) == Approx(0.08));
}

TEST_CASE("gltf document: a light's brightest channel counts as intensity, the rest as colour, both linear") {
  const json document = document_of(lit("l 0 0 3 .5 .25 0  l 0 0 3 0 0 0"));
  const json lights = document["extensions"]["KHR_lights_punctual"]["lights"];
  CHECK(lights[0]["color"].get<std::vector<double>>() ==
        std::vector<double>{1, light_of(0.25) / light_of(0.5), 0});
  CHECK(lights[0]["intensity"].get<double>() == Approx(9 * light_of(0.5)));
  CHECK(lights[1]["color"].get<std::vector<double>>() == std::vector<double>{0, 0, 0});
  CHECK(lights[1]["intensity"].get<double>() == 0);
  const json used = document["extensionsUsed"];
  CHECK(std::count(used.begin(), used.end(), "KHR_lights_punctual") == 1);
}

TEST_CASE("gltf document: lights and camera hang on the nodes of their names") {
  SceneDescription scene = lit("l 0 0 3  l 4 5 6");
  View& view = scene.view.emplace();
  view.from = {0, 0, 5}, view.at = {0, 0, 0};
  view.hither = 0.25, view.width = 30, view.height = 20;
  const json document = document_of(scene);
  const json nodes = document["nodes"];
  const auto named = [&](const std::string& name) {
    return *std::find_if(nodes.begin(), nodes.end(),
                         [&](const json& n) { return n.value("name", "") == name; });
  };
  CHECK(named("light_1")["extensions"]["KHR_lights_punctual"]["light"] == 0);
  CHECK(named("light_2")["extensions"]["KHR_lights_punctual"]["light"] == 1);
  CHECK(named("camera")["camera"] == 0);
  const json camera = document["cameras"][0]["perspective"];
  CHECK(camera["aspectRatio"].get<double>() == Approx(1.5));
  CHECK(camera["znear"].get<double>() == Approx(0.25));
  // 45 degrees span the centres of 20 rows; half a row more lies on each side.
  const double upper_edge = std::tan(M_PI / 8) * 20 / 19;
  CHECK(camera["yfov"].get<double>() == Approx(2 * std::atan(upper_edge)));
  view.hither = 0;
  CHECK(document_of(scene)["cameras"][0]["perspective"]["znear"].get<double>() == Approx(0.05));
}

TEST_CASE("gltf document: names in UTF-8 stay, others lose the bytes that are not") {
  CHECK(utf8("h\xc3\xb6lzern \xe2\x82\xac \xf0\x9f\x98\x80") ==
        "h\xc3\xb6lzern \xe2\x82\xac \xf0\x9f\x98\x80");
  CHECK(utf8("h\xf6lzern") == "h_lzern");
  // The first and the last of each length, and those beside what UTF-16 takes for its pairs.
  for (const std::string one : {"\xc2\x80", "\xdf\xbf", "\xe0\xa0\x80", "\xe0\xbf\xbf", "\xed\x9f\xbf",
                                "\xee\x80\x80", "\xef\xbf\xbf", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"}) {
    INFO(one);
    CHECK(utf8("a" + one + one + "z") == "a" + one + one + "z");
    const std::string cut = one.substr(0, one.size() - 1);
    CHECK(utf8(cut + "z") == std::string(cut.size(), '_') + "z");
  }
  CHECK(utf8("\xc0\xaf\xed\xa0\x80\xf4\x90\x80\x80\xc3") == "__________");
}

TEST_CASE("gltf document: what a URI cannot hold is written by its bytes, the higher digit first") {
  const auto uri_with = [](const std::string& stem) {
    const SceneDescription scene = lit("l 0 0 3");
    const json document = json::parse(write_mesh(scene, ".gltf", stem, {2, {}}).files.back().bytes);
    return document["buffers"][0]["uri"].get<std::string>();
  };
  CHECK(uri_with("m") == "m.bin");
  CHECK(uri_with("a b%") == "a%20b%25.bin");
  CHECK(uri_with("\xc3\xa9") == "%C3%A9.bin");
  CHECK(uri_with("A-z_0.9~") == "A-z_0.9~.bin");
  CHECK(uri_with("a?b#c") == "a%3Fb%23c.bin");
}

TEST_CASE("gltf document: nodes as deep as they may be, no deeper, nor in a circle, nor with two parents") {
  const auto problem_of = [](const std::string& nodes) {
    return gltf_facts(R"({"asset":{"version":"2.0"},"nodes":[)" + nodes + "]}").problem;
  };
  const auto chain = [&](int nodes) {
    std::string text;
    for (int i = 1; i < nodes; ++i) text += R"({"children":[)" + std::to_string(i) + "]},";
    return problem_of(text + "{}");
  };
  const std::string too_deep =
      "its nodes lie more than " + std::to_string(kMaxNodeDepth) + " deep in each other";
  CHECK(chain(kMaxNodeDepth).empty());
  CHECK(chain(kMaxNodeDepth + 1) == too_deep);
  CHECK(problem_of(R"({"children":[1]},{"children":[0]})") == too_deep);
  CHECK(problem_of(R"({"children":[0]})") == too_deep);
  CHECK(problem_of(R"({"children":[2]},{"children":[2]},{})") == "a node has two parents");
  CHECK(problem_of(R"({"children":[1,2]},{},{})").empty());
}

}  // namespace pprt::gltf_document_test
