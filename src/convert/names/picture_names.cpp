#include "convert/names/picture_names.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

namespace pprt {

std::string picture_name(const std::string& stem, const Texture& texture,
                         const std::function<bool(const std::string&)>& is_taken) {
  constexpr std::string_view kSpecial = "#%{}\"'\\/*:";
  std::string first = stem + "-" + std::filesystem::path(texture.name).stem().string();
  for (char& c : first) {
    if (static_cast<unsigned char>(c) <= ' ' || kSpecial.find(c) != std::string_view::npos) c = '_';
  }
  std::string name = first + ".png";
  for (int i = 2; is_taken(name); ++i) name = first + "-" + std::to_string(i) + ".png";
  return name;
}

std::vector<std::string> picture_names(const SceneDescription& scene, const std::string& stem) {
  std::vector<std::string> names;
  for (const Texture& texture : scene.textures) {
    names.push_back(picture_name(stem, texture, [&](const std::string& name) {
      return std::find(names.begin(), names.end(), name) != names.end();
    }));
  }
  return names;
}

}  // namespace pprt
