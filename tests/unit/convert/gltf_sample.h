// Small files of glTF, put together part by part.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "convert/mesh/mesh_reader.h"
#include "unit/image/temporary_directory.h"

namespace pprt {

class GltfSample {
 public:
  nlohmann::json document = nlohmann::json::parse(
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[]}],"nodes":[],"meshes":[],"materials":[],
          "accessors":[],"bufferViews":[],"buffers":[{"uri":"numbers.bin"}]})");

  bool keeps_sides = false;  // materials that tell no sides stay so

  // Each appends to a list of the document and returns the place.
  int add(const char* list, nlohmann::json what) {
    document[list].push_back(std::move(what));
    return static_cast<int>(document[list].size()) - 1;
  }
  int node(nlohmann::json what) {
    const int place = add("nodes", std::move(what));
    document["scenes"][0]["nodes"].push_back(place);
    return place;
  }
  int numbers(const std::vector<float>& values, const std::string& type) {
    return accessor({reinterpret_cast<const char*>(values.data()), sizeof(float) * values.size()},
                    {{"componentType", 5126}, {"count", values.size() / components(type)}, {"type", type}});
  }
  int accessor(const std::string& bytes, nlohmann::json what) {
    what["bufferView"] = view(bytes);
    return add("accessors", std::move(what));
  }
  int view(const std::string& bytes) {
    bytes_.append((4 - bytes_.size() % 4) % 4, '\0');
    const int place =
        add("bufferViews", {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}});
    bytes_ += bytes;
    return place;
  }

  // A triangle with the corners (0 0 0) (1 0 0) (0 1 0), which are its texture coordinates, too.
  int triangle(nlohmann::json primitive = nlohmann::json::object()) {
    nlohmann::json& attributes = primitive["attributes"];
    if (!attributes.contains("POSITION"))
      attributes["POSITION"] = numbers({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    if (!attributes.contains("TEXCOORD_0")) attributes["TEXCOORD_0"] = numbers({0, 0, 1, 0, 0, 1}, "VEC2");
    nlohmann::json mesh;
    mesh["primitives"].push_back(std::move(primitive));
    return add("meshes", std::move(mesh));
  }
  int triangle_of(nlohmann::json material) {
    return node({{"mesh", triangle({{"material", add("materials", std::move(material))}})}});
  }

  // Moves a node between the times and values.
  void move(int node, const char* path, const std::string& interpolation, const std::vector<float>& times,
            const std::vector<float>& values, const std::string& animation = "") {
    nlohmann::json moved = {{"name", animation}};
    moved["samplers"].push_back(
        {{"input", numbers(times, "SCALAR")},
         {"output", numbers(values, path == std::string("rotation") ? "VEC4" : "VEC3")},
         {"interpolation", interpolation}});
    moved["channels"].push_back({{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}});
    nlohmann::json& animations = document["animations"];
    if (animations.empty() || animations.back()["name"] != animation) {
      animations.push_back(std::move(moved));
      return;
    }
    moved["channels"][0]["sampler"] = animations.back()["samplers"].size();
    animations.back()["samplers"].push_back(moved["samplers"][0]);
    animations.back()["channels"].push_back(moved["channels"][0]);
  }

  // Adds a picture in a file of the folder, and returns its texture.
  int texture(const std::string& file, nlohmann::json sampler = nullptr) {
    if (sampler.is_null()) sampler = nlohmann::json::object();
    const int image = add("images", {{"uri", file}}), place = add("samplers", std::move(sampler));
    return add("textures", {{"source", image}, {"sampler", place}});
  }

  // A red picture of 4 x 2 texels whose left half is transparent.
  int half_transparent(nlohmann::json sampler = nullptr) {
    const std::string_view digits =
        "89504e470d0a1a0a0000000d49484452000000040000000208060000007fa87d63000000144944415478da63f8cfc0c0"
        "00c5ff4198015d0000c1600bf5337041b40000000049454e44ae426082";
    std::string bytes;
    for (std::size_t i = 0; i < digits.size(); i += 2)
      bytes += static_cast<char>(std::stoi(std::string(digits.substr(i, 2)), nullptr, 16));
    std::ofstream(folder() / "half.png", std::ios::binary) << bytes;
    return texture("half.png", std::move(sampler));
  }

  std::filesystem::path folder() const { return folder_.path(); }
  std::string write() const {
    nlohmann::json whole = document;
    whole["buffers"][0]["byteLength"] = bytes_.size();
    for (nlohmann::json& material : whole["materials"]) {  // what a triangle alone is seen with
      if (!keeps_sides && !material.contains("doubleSided")) material["doubleSided"] = true;
    }
    const std::filesystem::path path = folder() / "sample.gltf";
    std::ofstream(path) << whole;
    std::ofstream(folder() / "numbers.bin", std::ios::binary) << bytes_;
    return path.string();
  }
  ReadMesh read(const MeshOptions& options = {}) const { return read_mesh(write(), options); }

 private:
  static std::size_t components(const std::string& type) {
    return type == "SCALAR" ? 1 : static_cast<std::size_t>(type.back() - '0');
  }

  TemporaryDirectory folder_;
  std::string bytes_;
};

}  // namespace pprt
