#include "convert/gltf/gltf_document.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "base/counted.h"
#include "convert/model/display_values.h"
#include "convert/model/read_mesh.h"
#include "scene/animation/resting_nodes.h"
#include "scene/description/shading_rules.h"
#include "scene/description/view_frame.h"

namespace pprt {
namespace {

using nlohmann::json;

// A .glb is a header, a chunk of JSON and one of numbers (glTF 2.0, section 4.4). Lengths are 32 bits, the
// lowest first.
constexpr std::string_view kMagic = "glTF";
constexpr std::size_t kVersion = 4, kHeader = 12, kChunkHeader = 8;

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

// Percent-encodes what a URI cannot hold (RFC 3986, section 2.3), but for its slashes.
std::string uri_of(const std::string& name) {
  constexpr std::string_view kDigits = "0123456789ABCDEF", kPlain = "-._~/";
  std::string uri;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || kPlain.find(c) != std::string_view::npos) {
      uri += c;
    } else {
      uri += {'%', kDigits[byte >> 4], kDigits[byte & 15]};
    }
  }
  return uri;
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
  const SceneDescription still = still_at(scene, start_time(scene.movement));
  const Box3d box = bounds(still);
  const double weight = scene.ambient ? 1 : light_weight(scene.lights.size());
  json lights = json::array();
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = still.lights[i];
    const Rgb color = light.color.value_or(Rgb(1, 1, 1)) * weight;
    const Rgb shown(light_of(color.x), light_of(color.y), light_of(color.z));
    const double brightest = std::max({shown.x, shown.y, shown.z});
    const Rgb hue = brightest > 0 ? shown / brightest : shown;
    const double distance2 =
        light.is_sun ? 1 : std::max((light.position - box.center()).length2(), least_distance2(box));
    lights.push_back({{"type", light.is_sun ? "directional" : "point"},
                      {"color", {hue.x, hue.y, hue.z}},
                      {"intensity", brightest * distance2}});
    node_called(document, light_name(i))["extensions"][kExtension]["light"] = i;
  }
  document["extensions"][kExtension]["lights"] = std::move(lights);
  document["extensionsUsed"].push_back(kExtension);
}

std::string completed(std::string_view text, const SceneDescription& scene) {
  json document = json::parse(utf8(std::string(text)));
  for (json& buffer : document.at("buffers")) {
    if (const std::string uri = buffer.value("uri", ""); !uri.empty() && !uri.starts_with("data:"))
      buffer["uri"] = uri_of(uri);
  }
  add_camera(document, scene);
  add_lights(document, scene);
  return document.dump();
}

// --- Reading

constexpr int kMaxJsonDepth = 500;  // brackets in each other: parsers take stack for each

// Returns why the JSON of a .glb does not lie where its header tells. One of glTF 1 has another header.
std::string problem_of_header(std::string_view bytes) {
  if (!bytes.starts_with(kMagic)) return {};
  if (bytes.size() < kHeader + kChunkHeader) return "it ends within its header";
  const std::size_t length = length_at(bytes, kHeader), rest = bytes.size() - kHeader - kChunkHeader;
  if (length_at(bytes, kVersion) < 2 || length <= rest) return {};
  return "its JSON has " + counted(length, "byte", "bytes") + " by its header; the file has " +
         std::to_string(rest) + " after that";
}

std::string cause_in_header(std::string_view bytes) {
  constexpr std::size_t kTotal = 8;
  if (!bytes.starts_with(kMagic)) return {};
  const std::size_t version = length_at(bytes, kVersion);
  if (version != 2) return "by its header it is of version " + std::to_string(version) + " of glTF, not 2";
  const std::size_t total = length_at(bytes, kTotal), json_length = length_at(bytes, kHeader);
  if (total > bytes.size())
    return "it is cut off: it has " + std::to_string(bytes.size()) + " bytes, by its header " +
           std::to_string(total);
  if (total < kHeader + kChunkHeader + json_length)
    return "by its header it has " + counted(total, "byte", "bytes") + ", fewer than its header and its JSON";
  if (json_length % 4 != 0)
    return "the length of its JSON, " + counted(json_length, "byte", "bytes") + ", is not a multiple of 4";
  return {};
}

// Returns the library's text without its own names and the place.
std::string reason_of(const json::parse_error& error) {
  const std::string text = error.what();
  const std::size_t place = text.find("column ");
  const std::size_t colon = text.find(": ", place == std::string::npos ? 0 : place);
  return colon == std::string::npos ? text : text.substr(colon + 2);
}

// Tells of broken JSON in `facts` and returns null. `begin`: where `text` begins in the file.
json parsed(const std::string& text, std::size_t begin, GltfFacts& facts) {
  int deepest = 0;
  const auto keep = [&](int depth, json::parse_event_t /*event*/, json& /*value*/) {
    deepest = std::max(deepest, depth);
    return depth <= kMaxJsonDepth;
  };
  const auto judge_depth = [&] {
    if (deepest > kMaxJsonDepth)
      facts.problem =
          "its JSON has brackets more than " + std::to_string(kMaxJsonDepth) + " deep in each other";
  };
  try {
    json document = json::parse(text, keep);
    judge_depth();
    return document;
  } catch (const json::parse_error& e) {
    judge_depth();
    if (!facts.likely_cause.empty()) return nullptr;
    if (const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
        first == std::string::npos || text[first] != '{') {
      facts.likely_cause = "it begins neither as text in glTF nor as binary glTF";
      return nullptr;
    }
    const std::size_t at = e.byte > 0 ? e.byte - 1 : 0;
    if (begin == 0) facts.broken_at = at;
    facts.likely_cause =
        "its JSON is broken" + (begin > 0 ? " at byte " + std::to_string(at) : "") + ": " + reason_of(e);
    return nullptr;
  }
}

std::string cause_in_version(const json& document) {
  const json asset = document.value("asset", json::object());
  const std::string version = asset.value("version", "");
  if (version.starts_with("2.")) return {};
  return version.empty() ? "it does not tell its version of glTF" : "it is of glTF " + version + ", not 2";
}

std::string problem_of_nodes(const json& document) {
  const json nodes = document.value("nodes", json::array());
  const std::size_t none = nodes.size();
  std::vector<std::size_t> parents(nodes.size(), none);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const json& child : nodes[i].value("children", json::array())) {
      std::size_t& parent = parents.at(child.get<std::size_t>());
      if (parent != none) return "a node has two parents";
      parent = i;
    }
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    int depth = 0;
    for (std::size_t n = i; n != none && depth <= kMaxNodeDepth; n = parents[n]) ++depth;
    if (depth > kMaxNodeDepth)
      return "its nodes lie more than " + std::to_string(kMaxNodeDepth) + " deep in each other";
  }
  return {};
}

// Data URIs are left out.
std::map<std::string, std::size_t> buffer_lengths(const json& document) {
  std::map<std::string, std::size_t> lengths;
  for (const json& buffer : document.value("buffers", json::array())) {
    const std::string uri = buffer.value("uri", "");
    if (!uri.empty() && !uri.starts_with("data:")) lengths[uri] = buffer.at("byteLength").get<std::size_t>();
  }
  return lengths;
}

std::vector<GltfFacts::Pointer> pointers(const json& document) {
  std::vector<GltfFacts::Pointer> result;
  const json animations = document.value("animations", json::array());
  for (std::size_t i = 0; i < animations.size(); ++i) {
    for (const json& channel : animations[i].at("channels")) {
      const json& target = channel.at("target");
      if (target.value("path", "") != "pointer") continue;
      const json extensions = target.value("extensions", json::object());
      const json moved = extensions.value("KHR_animation_pointer", json::object());
      result.push_back({i, channel.at("sampler").get<int>(), moved.value("pointer", "")});
    }
  }
  return result;
}

}  // namespace

double least_distance2(const Box3d& scene) {
  return 0.01 * scene.size().length2();
}

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

// By RFC 3629, section 4.
std::string utf8(std::string name) {
  const auto byte_at = [&](std::size_t at) {
    return at < name.size() ? static_cast<unsigned char>(name[at]) : 0U;
  };
  for (std::size_t i = 0; i < name.size();) {
    const unsigned first = byte_at(i), second = byte_at(i + 1);
    std::size_t length = first < 0x80 ? 1 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    bool is_whole = first < 0x80 || (first >= 0xc2 && first < 0xf5);
    for (std::size_t k = 1; k < length; ++k) is_whole = is_whole && (byte_at(i + k) & 0xc0U) == 0x80;
    // Longer than needed, half of a pair of UTF-16, or beyond the last code point.
    if ((first == 0xe0 && second < 0xa0) || (first == 0xed && second >= 0xa0) ||
        (first == 0xf0 && second < 0x90) || (first == 0xf4 && second >= 0x90))
      is_whole = false;
    if (!is_whole) name[i] = '_', length = 1;
    i += length;
  }
  return name;
}

GltfFacts gltf_facts(std::string_view bytes) {
  GltfFacts facts;
  facts.problem = problem_of_header(bytes);
  if (!facts.problem.empty()) return facts;
  try {
    facts.likely_cause = cause_in_header(bytes);
    const auto [begin, end] = range_of_json(bytes);
    facts.json_begin = begin, facts.json_end = end;
    const json document = parsed(utf8(std::string(bytes.substr(begin, end - begin))), begin, facts);
    if (!facts.problem.empty() || document.is_null()) return facts;
    if (facts.likely_cause.empty()) facts.likely_cause = cause_in_version(document);
    facts.problem = problem_of_nodes(document);
    facts.buffers = buffer_lengths(document);
    facts.pointers = pointers(document);
  } catch (const json::exception&) {
    // A value is not of its type: the reader tells.
  } catch (const std::out_of_range&) {
    // A node names what is not there: the reader tells.
  }
  return facts;
}

}  // namespace pprt
