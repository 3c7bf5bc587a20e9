// The files of a mesh, as Assimp opens them.
#pragma once

#include <assimp/DefaultIOSystem.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "convert/model/model_folder.h"

namespace pprt {

// Opens the mesh itself and what lies in its folder, to be read.
class ModelFiles : public Assimp::DefaultIOSystem {
 public:
  explicit ModelFiles(const std::filesystem::path& model);

  bool Exists(const char* file) const override;
  // Returns null for what cannot be read.
  Assimp::IOStream* Open(const char* file, const char* mode) override;

  // Paths of the files that were opened.
  const std::vector<std::string>& opened() const { return opened_; }

  // What the mesh names and cannot be read, with the reason.
  const std::map<std::string, std::string>& unread() const { return unread_; }

 private:
  Assimp::IOStream* note_opened(const std::string& path, const char* mode);
  std::string name_in_folder(const std::string& file) const;
  bool is_guess(const std::filesystem::path& name) const;

  std::filesystem::path model_;
  ModelFolder folder_;
  std::vector<std::string> opened_;
  std::map<std::string, std::string> unread_;
};

}  // namespace pprt
