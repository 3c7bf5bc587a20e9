#include "convert/gltf_document.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "scene/view_frame.h"

namespace pprt {
namespace {

using nlohmann::json;

// A .glb is a header, a chunk of JSON and one of numbers (glTF 2.0, section 4.4). Lengths are 32 bits, the
// lowest first.
constexpr std::string_view kMagic = "glTF";
constexpr std::size_t kHeader = 12, kChunkHeader = 8;

std::uint32_t length_at(std::string_view bytes, std::size_t place) {
  std::uint32_t length = 0;
  for (std::size_t i = 4; i-- > 0;) length = length << 8 | static_cast<unsigned char>(bytes.at(place + i));
  return length;
}

void set_length(std::string& bytes, std::size_t place, std::size_t length) {
  for (std::size_t i = 0; i < 4; ++i) bytes[place + i] = static_cast<char>(length >> (8 * i) & 0xff);
}

// Where a file's JSON lies.
struct Range {
  std::size_t begin = 0, end = 0;
};

// Throws std::out_of_range for a .glb that is cut off.
Range range_of_json(std::string_view bytes) {
  if (!bytes.starts_with(kMagic)) return {0, bytes.size()};
  const std::size_t begin = kHeader + kChunkHeader;
  return {begin, begin + std::min<std::size_t>(length_at(bytes, kHeader), bytes.substr(begin).size())};
}

json& node_called(json& document, const std::string& name) {
  json& nodes = document.at("nodes");
  const auto found = std::find_if(nodes.begin(), nodes.end(),
                                  [&](const json& node) { return node.value("name", "") == name; });
  if (found == nodes.end())
    throw std::runtime_error("cannot make a mesh file: it has no node '" + name + "'");
  return *found;
}

void add_camera(json& document, const SceneDescription& scene) {
  if (!scene.view) return;
  const View& view = *scene.view;
  const double height = view.height * view_frame(view, scene.name).slope_per_pixel;
  const double near = view.hither > 0 ? view.hither : 0.01 * (view.at - view.from).length();
  document["cameras"] = {{{"type", "perspective"},
                          {"perspective",
                           {{"aspectRatio", static_cast<double>(view.width) / view.height},
                            {"yfov", 2 * std::atan(0.5 * height)},
                            {"znear", near}}}}};
  node_called(document, "camera")["camera"] = 0;
}

void add_lights(json& document, const SceneDescription& scene) {
  constexpr const char* kExtension = "KHR_lights_punctual";
  if (scene.lights.empty()) return;
  const Vec3d middle = bounds(scene).center();
  json lights = json::array();
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const Rgb color = light.color.value_or(Rgb(1, 1, 1));
    const double brightest = std::max({color.x, color.y, color.z});
    const Rgb hue = brightest > 0 ? color / brightest : color;
    lights.push_back({{"type", "point"},
                      {"color", {hue.x, hue.y, hue.z}},
                      {"intensity", brightest * (light.position - middle).length2()}});
    node_called(document, "light_" + std::to_string(i + 1))["extensions"][kExtension]["light"] = i;
  }
  document["extensions"][kExtension]["lights"] = std::move(lights);
  document["extensionsUsed"].push_back(kExtension);
}

std::string completed(std::string_view text, const SceneDescription& scene) {
  json document = json::parse(text);
  add_camera(document, scene);
  add_lights(document, scene);
  return document.dump();
}

}  // namespace

void add_camera_and_lights(std::string& bytes, const SceneDescription& scene) {
  const auto [begin, end] = range_of_json(bytes);
  std::string document = completed(std::string_view(bytes).substr(begin, end - begin), scene);
  if (begin == 0) {
    bytes = std::move(document);
    return;
  }
  document.append((4 - document.size() % 4) % 4, ' ');  // chunks begin at multiples of 4
  bytes.replace(begin, end - begin, document);
  set_length(bytes, kHeader, document.size());
  set_length(bytes, 8, bytes.size());
}

std::optional<double> camera_angle(std::string_view bytes, std::string_view node) {
  try {
    const auto [begin, end] = range_of_json(bytes);
    json document = json::parse(bytes.substr(begin, end - begin));
    const std::size_t camera = node_called(document, std::string(node)).at("camera");
    return document.at("cameras").at(camera).at("perspective").at("yfov").get<double>();
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

}  // namespace pprt
