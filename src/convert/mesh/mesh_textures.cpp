#include "convert/mesh/mesh_textures.h"

#include <assimp/scene.h>
#include <assimp/texture.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <system_error>

#include "base/printable.h"
#include "cli/scenes/texture_files.h"
#include "image/image_io.h"

namespace pprt {
namespace {

std::string name_of(const std::string& path) {
  if (path.starts_with('*')) return "texture" + path.substr(1);
  return std::filesystem::path(path).filename().string();
}

// A path as in a URI: "%20" is a blank.
std::string decoded(const std::string& path) {
  std::string result;
  for (std::size_t i = 0; i < path.size(); ++i) {
    unsigned byte = 0;
    const char* const digits = path.data() + i + 1;
    const bool is_code = path[i] == '%' && i + 2 < path.size() &&
                         std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2;
    result += is_code ? static_cast<char>(byte) : path[i];
    if (is_code) i += 2;
  }
  return result;
}

// A path as Windows spells it.
std::string with_slashes(std::string path) {
  std::replace(path.begin(), path.end(), '\\', '/');
  return path;
}

// Returns a picture within the file: another file's bytes, or texels where there is a height.
Image embedded(const aiTexture& from, std::uint64_t max_memory) {
  if (from.mHeight == 0)
    return decode_image({reinterpret_cast<const char*>(from.pcData), from.mWidth}, max_memory);
  Image image(static_cast<int>(from.mWidth), static_cast<int>(from.mHeight));
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const aiTexel& texel = from.pcData[i];
    image.pixels[i] = Color(texel.r, texel.g, texel.b) / 255.F;
  }
  return image;
}

}  // namespace

std::optional<TextureIndex> MeshTextures::intern(const std::string& path, std::vector<Texture>& textures,
                                                 std::vector<std::string>& notes) {
  const auto [found, is_new] = known_.try_emplace(path);
  if (!is_new) return found->second;
  try {
    Texture texture;
    texture.name = name_of(path);
    fill(texture, picture(path));
    left_ -= std::min<std::uint64_t>(left_, texture.rgb.size());
    textures.push_back(std::move(texture));
    found->second = static_cast<TextureIndex>(textures.size() - 1);
  } catch (const std::exception& e) {
    notes.push_back("the texture '" + printable(path) + "' is left out: " + e.what());
  }
  return found->second;
}

Image MeshTextures::picture(const std::string& path) const {
  if (const aiTexture* texture = from_.GetEmbeddedTexture(path.c_str())) return embedded(*texture, left_);
  std::error_code unknown;
  for (const std::string& spelled : {path, decoded(path), with_slashes(path)}) {
    const std::filesystem::path file = std::filesystem::path(spelled).lexically_normal();
    if (file.is_absolute() || file.empty() || *file.begin() == "..")
      throw std::runtime_error("it lies outside the folder of the mesh");
    if (std::filesystem::is_regular_file(folder_ / file, unknown)) return read_image(folder_ / file, left_);
  }
  return read_image(folder_ / path);  // which is not there
}

}  // namespace pprt
