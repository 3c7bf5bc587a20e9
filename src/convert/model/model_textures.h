// Pictures on the surfaces of models.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"
#include "scene/description/texture.h"

namespace pprt {

// Reads the pictures of a file's materials, each once.
class ModelTextures {
 public:
  // `max_memory`: bytes that the pictures may take.
  explicit ModelTextures(std::uint64_t max_memory) : left_(max_memory) {}

  // Returns the place among `textures` of the picture of a key. `picture` makes it, within the bytes that it
  // is given. Empty where that fails; `notes` then gets the reason. `name`: for people and for files.
  std::optional<TextureIndex> intern(const std::string& key, const std::string& name,
                                     const std::function<Image(std::uint64_t)>& picture,
                                     std::vector<Texture>& textures, std::vector<std::string>& notes);

 private:
  std::uint64_t left_;  // bytes
  std::map<std::string, std::optional<TextureIndex>> known_;
};

}  // namespace pprt
