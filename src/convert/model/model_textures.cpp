#include "convert/model/model_textures.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "base/printable.h"
#include "cli/scenes/texture_files.h"

namespace pprt {

std::optional<TextureIndex> ModelTextures::intern(const std::string& key, const std::string& name,
                                                  const std::function<Image(std::uint64_t)>& picture,
                                                  std::vector<Texture>& textures,
                                                  std::vector<std::string>& notes) {
  const auto [found, is_new] = known_.try_emplace(key);
  if (!is_new) return found->second;
  try {
    Texture texture;
    texture.name = name;
    fill(texture, picture(left_));
    left_ -= std::min<std::uint64_t>(left_, texture.rgb.size());
    textures.push_back(std::move(texture));
    found->second = static_cast<TextureIndex>(textures.size() - 1);
  } catch (const std::exception& e) {
    notes.push_back("the texture '" + printable(key) + "' is left out: " + e.what());
  }
  return found->second;
}

}  // namespace pprt
