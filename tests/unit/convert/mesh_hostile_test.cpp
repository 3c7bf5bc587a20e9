// Meshes that are damaged, or name what they should not.
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/diagnostics.h"
#include "base/sanitized.h"
#include "convert/mesh/isolated_reader.h"
#include "convert/mesh/mesh_reader.h"
#include "convert/model/model_folder.h"
#include "scene/bytes/scene_bytes.h"
#include "unit/image/temporary_directory.h"

namespace pprt::mesh_hostile_test {

namespace {

constexpr const char* kPoints = "v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2 3\n";
constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

// The corners (0 0 0) (1 0 0) (0 1 0) as floats.
std::string corners() {
  const float values[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  return {reinterpret_cast<const char*>(values), sizeof values};
}

// `uri`: of the buffer, with its key; empty in a .glb.
std::string gltf(const std::string& uri, const std::string& more = "") {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)" + more +
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,
"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36)" +
         uri + "}]}";
}

std::string little_endian(std::uint32_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
  return bytes;
}

// `told`: the length of the JSON by the header.
std::string glb(const std::string& json, std::uint32_t told) {
  const std::string rest =
      little_endian(told) + "JSON" + json + little_endian(36) + std::string("BIN\0", 4) + corners();
  return "glTF" + little_endian(2) + little_endian(static_cast<std::uint32_t>(12 + rest.size())) + rest;
}

std::string padded(std::string json) {
  return json.append((4 - json.size() % 4) % 4, ' ');
}

class Folder {
 public:
  Folder() { std::filesystem::create_directory(path()); }
  std::filesystem::path path() const { return directory_.path() / "model"; }
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path() / name, std::ios::binary) << bytes;
    return (path() / name).string();
  }
  // Returns the report on the file without its path.
  std::string report(const std::string& name, const std::string& bytes) const {
    const std::string file = write(name, bytes);
    try {
      read_mesh(file);
      return "read";
    } catch (const InputError& e) {
      const std::string text = e.what();
      return text.starts_with(file) ? text.substr(file.size()) : text;
    }
  }

 private:
  TemporaryDirectory directory_;
};

std::string reason(const ModelFolder& folder, const std::string& name) {
  try {
    return folder.find(name).filename().string();
  } catch (const std::exception& e) {
    return e.what();
  }
}

}  // namespace

TEST_CASE(
    "hostile meshes: a model finds regular files in its folder and below, whichever way they are spelled") {
  const Folder files;
  std::filesystem::create_directory(files.path() / "sub");
  files.write("sub/a b.bin", "x"), files.write("100%25.bin", "x");
  const ModelFolder folder(files.path() / "m.gltf");
  CHECK(reason(folder, "sub/a b.bin") == "a b.bin");
  CHECK(reason(folder, "sub/a%20b.bin") == "a b.bin");
  CHECK(reason(folder, "sub\\a b.bin") == "a b.bin");
  CHECK(reason(folder, "sub/../sub/a b.bin") == "a b.bin");
  CHECK(reason(folder, "100%25.bin") == "100%25.bin");
  CHECK(reason(folder, "none.bin") == "No such file or directory");
  CHECK(reason(folder, "sub") == "Is a directory");
}

TEST_CASE("hostile meshes: a model finds nothing outside its folder, and no pipe") {
  const Folder files;
  const std::string outside = "it lies outside the folder of the mesh";
  std::ofstream(files.path().parent_path() / "secret") << "x";
  std::ofstream(files.path().string() + "2") << "x";
  std::filesystem::create_symlink("../secret", files.path() / "link");
  std::filesystem::create_directory_symlink("/", files.path() / "root");
  REQUIRE(mkfifo((files.path() / "pipe").c_str(), 0600) == 0);
  const ModelFolder folder(files.path() / "m.gltf");
  for (const std::string name : {"../secret", "..%2fsecret", "..\\secret", "../model2", "link",
                                 "root/etc/passwd", "/etc/passwd", "../none", "../model/../secret"}) {
    CAPTURE(name);
    CHECK(reason(folder, name) == outside);
  }
  CHECK(reason(folder, "pipe") == "it is not a regular file");
}

TEST_CASE(
    "hostile meshes: a buffer outside the folder or in a pipe is refused, and one beside the mesh is read") {
  const Folder files;
  std::ofstream(files.path().parent_path() / "b.bin", std::ios::binary) << corners();
  REQUIRE(mkfifo((files.path() / "pipe.bin").c_str(), 0600) == 0);
  REQUIRE(mkfifo((files.path() / "m.bin").c_str(), 0600) == 0);
  CHECK(files.report("m.gltf", gltf(R"(,"uri":"../b.bin")")) ==
        ": error: it needs '../b.bin': it lies outside the folder of the mesh");
  CHECK(files.report("m.gltf", gltf(R"(,"uri":"pipe.bin")")) ==
        ": error: it needs 'pipe.bin': it is not a regular file");
  CHECK(files.report("m.gltf", gltf(R"(,"uri":"m.bin")")) ==
        ": error: it needs 'm.bin': it is not a regular file");
  CHECK(files.report("n.gltf", gltf(R"(,"uri":"n.bin")")) ==
        ": error: it needs 'n.bin': No such file or directory");
  files.write("a b.bin", corners());
  CHECK(files.report("m.gltf", gltf(R"(,"uri":"a b.bin")")) == "read");
  CHECK(files.report("m.gltf", gltf(R"(,"uri":"a%20b.bin")")) == "read");
}

TEST_CASE("hostile meshes: a model that is a pipe or a folder is refused") {
  const Folder files;
  const std::string pipe = (files.path() / "pipe.obj").string(),
                    folder = (files.path() / "folder.ply").string();
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  std::filesystem::create_directory(folder);
  CHECK_THROWS_WITH(read_mesh(pipe), "cannot read '" + pipe + "': it is not a regular file");
  CHECK_THROWS_WITH(read_mesh(folder), "cannot read '" + folder + "': Is a directory");
}

TEST_CASE("hostile meshes: what is wrong with a .glb is said") {
  const Folder files;
  const std::string json = padded(gltf(""));
  const auto size = static_cast<std::uint32_t>(json.size());
  const std::string whole = glb(json, size), bytes = std::to_string(size);
  CHECK(files.report("m.glb", whole) == "read");
  CHECK(files.report("m.glb", whole.substr(0, 7)) == ": error: it ends within its header");
  CHECK(files.report("m.glb", whole.substr(0, 120)) ==
        ": error: its JSON has " + bytes + " bytes by its header; the file has 100 after that");
  CHECK(files.report("m.glb", glb(json, 0xfffffff0)) ==
        ": error: its JSON has 4294967280 bytes by its header; the file has " + std::to_string(size + 44) +
            " after that");
  CHECK(files.report("m.glb", whole.substr(0, whole.size() - 40)) ==
        ": error: it is cut off: it has " + std::to_string(whole.size() - 40) + " bytes, by its header " +
            std::to_string(whole.size()));
  CHECK(files.report("m.glb", glb(json + ' ', size + 1)) ==
        ": error: the length of its JSON, " + std::to_string(size + 1) + " bytes, is not a multiple of 4");
  const auto with = [&](std::size_t place, char number) {
    std::string changed = whole;
    changed.replace(place, 4, std::string{number, 0, 0, 0});
    return files.report("m.glb", changed);
  };
  for (const char total : {0, 19, 100}) {
    CHECK(with(8, total) == ": error: by its header it has " + std::to_string(total) +
                                " bytes, fewer than its header and its JSON");
  }
  for (const char version : {0, 1, 3})
    CHECK(with(4, version) ==
          ": error: by its header it is of version " + std::to_string(version) + " of glTF, not 2");
  const std::string broken = padded("{\"asset\":}");
  CHECK(files.report("m.glb", glb(broken, static_cast<std::uint32_t>(broken.size()))) ==
        ": error: its JSON is broken at byte 9: syntax error while parsing value - unexpected '}'; expected "
        "'[', "
        "'{', or a literal");
}

TEST_CASE("hostile meshes: what is wrong with a .gltf is said, with its place") {
  const Folder files;
  CHECK(files.report("m.gltf", "{\"asset\":{\"version\":\"2.0\"},\n \"nodes\":[}") ==
        ":2:11: error: its JSON is broken: syntax error while parsing value - unexpected '}'; expected '[', "
        "'{', "
        "or a literal\n     \"nodes\":[}\n              ^");
  CHECK(files.report("m.gltf", R"({"asset":{"version":"1.0"}})") == ": error: it is of glTF 1.0, not 2");
  for (const char* text : {"", " ", "\xef\xbb\xbf", "nonsense", "[1"})
    CHECK(files.report("m.gltf", text) == ": error: it begins neither as text in glTF nor as binary glTF");
  CHECK(files.report("m.gltf", "{}") == ": error: it does not tell its version of glTF");
  for (const std::size_t depth : {501, 200'000}) {
    const std::string nested = R"("extras":)" + std::string(depth, '[') + std::string(depth, ']') + ",";
    CHECK(files.report("m.gltf", gltf("", nested)) ==
          ": error: its JSON has brackets more than 500 deep in each other");
    CHECK(files.report("m.gltf", R"({"extras":)" + std::string(depth, '[')) ==
          ": error: its JSON has brackets more than 500 deep in each other");
  }
}

TEST_CASE("hostile meshes: the mark that some editors put before UTF-8 is passed over") {
  const Folder files;
  CHECK(files.report("m.obj", "\xef\xbb\xbf" + std::string(kTriangle)) == "read");
}

TEST_CASE("hostile meshes: text in UTF-16 is named as such") {
  const Folder files;
  std::string low_first, high_first;
  for (const char c : std::string(kTriangle)) low_first += {c, '\0'}, high_first += {'\0', c};
  for (const std::string& text : {"\xff\xfe" + low_first, "\xfe\xff" + high_first, low_first, high_first})
    CHECK(files.report("m.obj", text) ==
          ": error: it is text in UTF-16, which cannot be read; save it as UTF-8");
  CHECK(files.report("m.obj", kPoints) == ": error: there is no polygon in it");
}

TEST_CASE("hostile meshes: a material library that is missing is told") {
  const Folder files;
  const auto notes = [&](const std::string& name, const std::string& line) {
    return read_mesh(files.write(name, line + kTriangle)).notes;
  };
  using Notes = std::vector<std::string>;
  CHECK(notes("m.obj", "") == Notes{});
  CHECK(notes("m.obj", "mtllib gone.mtl\n") ==
        Notes{"the material library 'gone.mtl' is left out: No such file or directory"});
  CHECK(notes("m.obj", "mtllib m.mtl\n") ==
        Notes{"the material library 'm.mtl' is left out: No such file or directory"});
  CHECK(notes("m.obj", "mtllib ../m.mtl\n") ==
        Notes{"the material library '../m.mtl' is left out: it lies outside the folder of the mesh"});
}

TEST_CASE("hostile meshes: a process of its own reads the same") {
  const Folder files;
  const std::string good = files.write("m.obj", std::string("mtllib gone.mtl\n") + kTriangle);
  const ReadMesh here = read_mesh(good), apart = read_mesh_isolated(good);
  CHECK(encode(apart.scene) == encode(here.scene));
  CHECK(apart.notes == here.notes);
  const std::string bad = files.write("bad.obj", kPoints);
  CHECK_THROWS_WITH(read_mesh_isolated(bad), bad + ": error: there is no polygon in it");
}

TEST_CASE("hostile meshes: one that crashes Assimp, or takes too much, is refused") {
  const Folder files;
  std::string nodes;
  for (int i = 0; i < 300'000; ++i) nodes += "<node>";
  for (int i = 0; i < 300'000; ++i) nodes += "</node>";
  const std::string deep = files.write(
      "deep.dae",
      R"(<COLLADA version="1.4.1"><library_visual_scenes><visual_scene id="s">)" + nodes +
          R"(</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)");
  CHECK_THROWS_WITH(read_mesh_isolated(deep),
                    Catch::StartsWith(deep + ": error: it is damaged, or has something that cannot be read: "
                                             "reading it ended in "));
  const std::string good = files.write("m.obj", kTriangle);
  CHECK_THROWS_WITH(read_mesh_isolated(good, {.seconds = 0}),
                    good + ": error: reading it takes more than 0 seconds (--mesh-seconds allows more)");
  if (kSanitized) return;
  std::string many;
  for (int i = 0; i < 100'000; ++i) many += kTriangle;
  const std::string large = files.write("large.obj", many);
  CHECK_THROWS_WITH(read_mesh_isolated(large, {.memory_bytes = 1}), large + ": error: " + too_much_memory(1));
}

}  // namespace pprt::mesh_hostile_test
