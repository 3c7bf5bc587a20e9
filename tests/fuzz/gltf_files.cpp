#include "gltf_files.h"

#include <array>
#include <bit>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

namespace pprt::fuzz {
namespace {

using nlohmann::json;

// Component types.
constexpr int kUnsignedShort = 5123, kFloat = 5126;

class Document {
 public:
  explicit Document(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  GltfFiles files() {
    meshes_ = pick(4), nodes_ = 1 + pick(6), materials_ = pick(3), pictures_ = pick(3), cameras_ = pick(3);
    lights_ = pick(3);
    if (pick(32) == 1) nodes_ = 60 + 20 * pick(60);  // deep in each other
    document_["asset"]["version"] = pick(32) == 1 ? json("1.0") : json("2.0");
    document_["scene"] = index(1);
    document_["scenes"][0]["nodes"][0] = index(1);
    for (std::size_t i = 0; i < meshes_; ++i) document_["meshes"].push_back(mesh());
    for (std::size_t i = 0; i < nodes_; ++i) document_["nodes"].push_back(node(i));
    for (std::size_t i = 0; i < materials_; ++i) document_["materials"].push_back(material());
    for (std::size_t i = 0; i < pictures_; ++i) picture();
    for (std::size_t i = 0; i < cameras_; ++i) document_["cameras"].push_back(camera());
    for (std::size_t i = 0; i < lights_; ++i)
      document_["extensions"]["KHR_lights_punctual"]["lights"].push_back(light());
    for (std::size_t left = pick(3); left > 0; --left) document_["animations"].push_back(animation());
    document_["buffers"] =
        json::array({{{"uri", uri("numbers.bin")}, {"byteLength", size(numbers_.size())}}});
    if (pick(64) == 1) nest(document_["extras"]);
    return {document_.dump(-1, ' ', false, json::error_handler_t::replace), std::move(numbers_)};
  }

 private:
  std::size_t pick(std::size_t choices) {
    if (bytes_.empty() || choices == 0) return 0;
    const std::size_t byte = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return byte % choices;
  }

  // --- Values

  json odd() {
    const std::array<json, 12> values = {-1,          0,    1,   255,     65535, 2147483647,
                                         4294967295U, 1e10, 0.5, nullptr, "0",   json::array({0})};
    return values[pick(values.size())];
  }
  json index(std::size_t count) {
    if (pick(48) == 1) return odd();
    return pick(count + (pick(16) == 1 ? 1 : 0));
  }
  json size(std::size_t value) { return pick(48) == 1 ? odd() : json(value); }

  float real() {
    constexpr std::array<float, 16> kNumbers = {0,      1,    -1,    .5F,    2,       3.5F,   -.25F, 1e-9F,
                                                1e-38F, 1e7F, 1e16F, -1e20F, 3.4e38F, 1e-45F, 100,   -7};
    const std::size_t picked = pick(3 * kNumbers.size());  // most are plain
    return kNumbers[picked < kNumbers.size() ? picked : picked % 7];
  }
  json reals(std::size_t count) {
    json values = json::array();
    for (; count > 0; --count) values.push_back(real());
    if (pick(48) == 1) values.push_back(odd());
    return values;
  }
  json name() {
    constexpr std::array<const char*, 6> kNames = {"a", "b", "camera", "light_1", "", "x y/\"\n{"};
    return pick(48) == 1 ? odd() : json(kNames[pick(kNames.size())]);
  }
  json uri(const char* usual) {
    constexpr std::array<const char*, 10> kUris = {"../numbers.bin",
                                                   "/dev/zero",
                                                   "pipe",
                                                   "numbers%2ebin",
                                                   "",
                                                   "data:application/octet-stream;base64,AAAAAAAA",
                                                   "data:image/png;base64,iVBORw0KGgo=",
                                                   "data:,",
                                                   "none.png",
                                                   "tiny.ppm"};
    const std::size_t picked = pick(4 * kUris.size());
    return picked > 0 && picked < kUris.size() ? json(kUris[picked]) : json(usual);
  }
  static void nest(json& inner) {
    json* at = &inner;
    for (int depth = 0; depth < 600; ++depth) at = &(*at)[0];
  }

  // --- Numbers in the buffer

  void put(const void* from, std::size_t bytes) { numbers_.append(static_cast<const char*>(from), bytes); }

  json accessor(const char* type, int component, std::size_t count, std::size_t begin) {
    json view = {
        {"buffer", index(1)}, {"byteOffset", size(begin)}, {"byteLength", size(numbers_.size() - begin)}};
    if (pick(32) == 1) view["byteStride"] = size(4 * pick(8));
    json accessor = {
        {"bufferView", size(views_)}, {"componentType", component}, {"count", size(count)}, {"type", type}};
    if (pick(32) == 1) accessor["byteOffset"] = size(4 * pick(4));
    if (pick(48) == 1) accessor["componentType"] = 5120 + pick(8);
    if (pick(48) == 1) accessor["type"] = std::array{"SCALAR", "VEC2", "VEC3", "VEC4", "MAT4", "?"}[pick(6)];
    if (pick(64) == 1)
      accessor["sparse"] = {
          {"count", size(1)},
          {"indices", {{"bufferView", index(views_ + 1)}, {"componentType", kUnsignedShort}}},
          {"values", {{"bufferView", index(views_ + 1)}}}};
    if (pick(64) == 1) accessor.erase("bufferView");
    ++views_;
    document_["bufferViews"].push_back(std::move(view));
    document_["accessors"].push_back(std::move(accessor));
    return views_ - 1;
  }
  json floats(const char* type, std::size_t each, std::size_t count) {
    const std::size_t begin = numbers_.size();
    for (std::size_t i = 0; i < each * count; ++i) {
      const float value =
          pick(64) == 1 ? std::bit_cast<float>(0x7f800000U + static_cast<unsigned>(pick(2))) : real();
      put(&value, sizeof value);
    }
    return accessor(type, kFloat, count, begin);
  }
  json times(std::size_t count) {
    const std::size_t begin = numbers_.size();
    float time = pick(16) == 1 ? real() : 0;
    for (std::size_t i = 0; i < count; ++i, time += pick(8) == 1 ? real() : 1) put(&time, sizeof time);
    return accessor("SCALAR", kFloat, count, begin);
  }
  json indices(std::size_t count, std::size_t vertices) {
    const std::size_t begin = numbers_.size();
    for (std::size_t i = 0; i < count; ++i) {
      const auto at =
          static_cast<std::uint16_t>(pick(64) == 1 ? 0xffff : pick(vertices + (pick(16) == 1 ? 1 : 0)));
      put(&at, sizeof at);
    }
    return accessor("SCALAR", kUnsignedShort, count, begin);
  }

  // --- Parts of the document

  json mesh() {
    json mesh = {{"name", name()}};
    for (std::size_t left = 1 + pick(2); left > 0; --left) {
      const std::size_t vertices = 3 + pick(5);
      json primitive = {{"attributes", {{"POSITION", floats("VEC3", 3, vertices)}}}};
      if (pick(2) == 1) primitive["attributes"]["NORMAL"] = floats("VEC3", 3, vertices);
      if (pick(2) == 1) primitive["attributes"]["TEXCOORD_0"] = floats("VEC2", 2, vertices);
      if (pick(8) == 1) primitive["attributes"]["COLOR_0"] = floats("VEC4", 4, vertices);
      if (pick(2) == 1) primitive["indices"] = indices(3 * (1 + pick(4)), vertices);
      if (pick(8) == 1) primitive["mode"] = size(pick(8));
      if (pick(2) == 1) primitive["material"] = index(materials_);
      mesh["primitives"].push_back(std::move(primitive));
    }
    return mesh;
  }

  json node(std::size_t i) {
    json node = {{"name", pick(2) == 1 ? name() : json("n" + std::to_string(i))}};
    if (pick(4) != 1 && meshes_ > 0) node["mesh"] = index(meshes_);
    if (pick(4) == 1) node["camera"] = index(cameras_);
    if (pick(4) == 1) node["extensions"]["KHR_lights_punctual"]["light"] = index(lights_);
    if (pick(3) == 1) node["translation"] = reals(3);
    if (pick(3) == 1) node["rotation"] = reals(4);
    if (pick(3) == 1) node["scale"] = reals(3);
    if (pick(6) == 1) node["matrix"] = reals(16);
    if (i + 1 < nodes_) node["children"].push_back(pick(32) == 1 ? index(nodes_) : json(i + 1));
    return node;
  }

  json material() {
    json material = {{"name", name()}};
    json& surface = material["pbrMetallicRoughness"];
    surface["baseColorFactor"] = reals(4);
    surface["metallicFactor"] = real(), surface["roughnessFactor"] = real();
    if (pick(2) == 1)
      surface["baseColorTexture"] = {{"index", index(pictures_)}, {"texCoord", size(pick(2))}};
    if (pick(4) == 1) material["alphaMode"] = std::array{"OPAQUE", "MASK", "BLEND", "?"}[pick(4)];
    return material;
  }

  void picture() {
    json image = {{"uri", uri("tiny.ppm")}};
    if (pick(4) == 1) image = {{"bufferView", index(views_)}, {"mimeType", "image/png"}};
    document_["images"].push_back(std::move(image));
    document_["textures"].push_back({{"source", index(pictures_)}});
  }

  json camera() {
    json lens = {{"yfov", real()}, {"znear", real()}};
    if (pick(2) == 1) lens["aspectRatio"] = real();
    if (pick(8) == 1)
      return {{"type", "orthographic"},
              {"orthographic", {{"xmag", real()}, {"ymag", real()}, {"zfar", 9}, {"znear", 0}}}};
    return {{"type", "perspective"}, {"perspective", std::move(lens)}};
  }

  json light() {
    json light = {{"type", std::array{"point", "spot", "directional"}[pick(3)]},
                  {"intensity", real()},
                  {"color", reals(3)}};
    if (pick(2) == 1) light["spot"] = {{"innerConeAngle", real()}, {"outerConeAngle", real()}};
    return light;
  }

  json animation() {
    json animation = {{"name", name()}};
    std::size_t samplers = 0;
    for (std::size_t left = 1 + pick(3); left > 0; --left, ++samplers) {
      const std::size_t keys = 1 + pick(5), path = pick(4);
      const bool turns = path == 1;
      animation["samplers"].push_back(
          {{"input", times(keys)},
           {"output", turns ? floats("VEC4", 4, keys) : floats("VEC3", 3, keys)},
           {"interpolation", std::array{"LINEAR", "STEP", "CUBICSPLINE", "?"}[pick(4)]}});
      animation["channels"].push_back(
          {{"sampler", index(samplers + 1)},
           {"target",
            {{"node", index(nodes_)},
             {"path", std::array{"translation", "rotation", "scale", "weights"}[path]}}}});
    }
    return animation;
  }

  std::span<const std::uint8_t> bytes_;
  json document_;
  std::string numbers_;
  std::size_t meshes_ = 0, nodes_ = 0, materials_ = 0, pictures_ = 0, cameras_ = 0, lights_ = 0, views_ = 0;
};

}  // namespace

GltfFiles gltf_files(std::span<const std::uint8_t> bytes) {
  return Document(bytes).files();
}

}  // namespace pprt::fuzz
