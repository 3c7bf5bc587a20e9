#include "convert/mesh/mesh_textures.h"

#include <assimp/scene.h>
#include <assimp/texture.h>

#include <exception>
#include <filesystem>

#include "base/printable.h"
#include "cli/scenes/texture_files.h"
#include "image/image_io.h"

namespace pprt {
namespace {

std::string name_of(const std::string& path) {
  if (path.starts_with('*')) return "texture" + path.substr(1);
  return std::filesystem::path(path).filename().string();
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

Image MeshTextures::picture(const std::string& path) {
  if (const aiTexture* texture = from_.GetEmbeddedTexture(path.c_str())) return embedded(*texture, left_);
  files_.push_back(folder_.find(path).string());
  return read_image(files_.back(), left_);
}

}  // namespace pprt
