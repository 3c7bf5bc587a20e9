#include "convert/mesh/collada_cameras.h"

#include <charconv>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace pprt {
namespace {

double half_tangent(double degrees) {
  return std::tan(degrees * (std::numbers::pi / 360));
}

std::optional<double> number_in(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return std::nullopt;
  double value = 0;
  const auto result = std::from_chars(text.data() + first, text.data() + text.size(), value);
  return result.ec == std::errc() && std::isfinite(value) && value > 0 ? std::optional(value) : std::nullopt;
}

// Returns an attribute's value; empty where it is not there.
std::string_view attribute(std::string_view tag, std::string_view name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    const bool is_whole = at > 0 && (tag[at - 1] == ' ' || tag[at - 1] == '\n' || tag[at - 1] == '\t');
    std::string_view rest = tag.substr(at + name.size());
    if (!is_whole || rest.size() < 3 || rest[0] != '=' || (rest[1] != '"' && rest[1] != '\'')) continue;
    const std::size_t end = rest.find(rest[1], 2);
    if (end != std::string_view::npos) return rest.substr(2, end - 2);
  }
  return {};
}

// Reads a file from tag to tag.
class CameraScanner {
 public:
  std::map<std::string, ColladaCamera, std::less<>> run(std::string_view text) {
    for (std::size_t at = text.find('<'); at != std::string_view::npos; at = text.find('<', at)) {
      const bool is_comment = text.substr(at).starts_with("<!--");
      const std::size_t end = text.find(is_comment ? "-->" : ">", at);
      if (end == std::string_view::npos) break;
      if (!is_comment) tag(text.substr(at + 1, end - at - 1), text.substr(end + 1));
      at = end;
    }
    std::map<std::string, ColladaCamera, std::less<>> result;
    for (const auto& [node, camera] : held_) {
      const auto found = cameras_.find(camera);
      if (found != cameras_.end()) result.try_emplace(node, found->second);
    }
    return result;
  }

 private:
  // `tag`: between its brackets. `rest`: the text behind it.
  void tag(std::string_view tag, std::string_view rest) {
    const std::string_view name = tag.substr(0, tag.find_first_of(" \t\r\n/", 1));
    const bool is_empty = tag.ends_with('/');
    if (name == "node" && !is_empty) nodes_.emplace_back(attribute(tag, "name"), attribute(tag, "id"));
    if (name == "/node" && !nodes_.empty()) nodes_.pop_back();
    if (name == "camera") camera_ = attribute(tag, "id");
    if (name == "instance_camera" && !nodes_.empty()) {
      const std::string_view url = attribute(tag, "url");
      const std::string id(url.substr(url.starts_with('#') ? 1 : 0));
      for (const std::string_view node : {nodes_.back().first, nodes_.back().second})
        if (!node.empty()) held_.emplace_back(node, id);
    }
    if (camera_.empty() || is_empty) return;
    const std::string_view text = rest.substr(0, rest.find('<'));
    ColladaCamera& camera = cameras_[std::string(camera_)];
    if (name == "xfov") camera.x_degrees = number_in(text);
    if (name == "yfov") camera.y_degrees = number_in(text);
    if (name == "aspect_ratio") camera.aspect = number_in(text);
    if (name == "znear") camera.near = number_in(text);
    if (name == "/camera") camera_ = {};
  }

  std::vector<std::pair<std::string_view, std::string_view>> nodes_;  // names and ids, in each other
  std::string_view camera_;                                           // the id of the one at hand
  std::map<std::string, ColladaCamera, std::less<>> cameras_;
  std::vector<std::pair<std::string, std::string>> held_;  // by nodes
};

}  // namespace

std::optional<double> ColladaCamera::half_height() const {
  if (y_degrees) return half_tangent(*y_degrees);
  if (x_degrees) return half_tangent(*x_degrees) / ratio();
  return std::nullopt;
}

double ColladaCamera::ratio() const {
  if (x_degrees && y_degrees) return half_tangent(*x_degrees) / half_tangent(*y_degrees);
  return aspect.value_or(1);
}

std::map<std::string, ColladaCamera, std::less<>> collada_cameras(std::string_view text) {
  return CameraScanner().run(text);
}

}  // namespace pprt
