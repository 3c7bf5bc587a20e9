// Pictures on the surfaces of mesh files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "convert/mesh/model_folder.h"
#include "image/image.h"
#include "scene/description/texture.h"

struct aiScene;

namespace pprt {

// Reads the pictures of a file's materials, each once: those within the file, and those in its folder.
class MeshTextures {
 public:
  // `model`: the path of the mesh. `max_memory`: bytes that the pictures may take.
  MeshTextures(const aiScene& from, const std::filesystem::path& model, std::uint64_t max_memory)
      : from_(from), folder_(model), left_(max_memory) {}

  // Returns the place among `textures` of the picture of a path (picture_path()). Empty where it cannot be
  // read; `notes` then gets the reason.
  std::optional<TextureIndex> intern(const std::string& path, std::vector<Texture>& textures,
                                     std::vector<std::string>& notes);

  // Returns the files that were opened, by path.
  const std::vector<std::string>& files() const { return files_; }

 private:
  Image picture(const std::string& path);

  const aiScene& from_;
  ModelFolder folder_;
  std::uint64_t left_;  // bytes
  std::map<std::string, std::optional<TextureIndex>> known_;
  std::vector<std::string> files_;
};

}  // namespace pprt
