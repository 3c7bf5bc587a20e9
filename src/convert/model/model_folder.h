// Which files a mesh may name.
#pragma once

#include <filesystem>
#include <string>

namespace pprt {

// The folder of a mesh. What the mesh names must be a regular file in it or below, also behind links.
class ModelFolder {
 public:
  explicit ModelFolder(const std::filesystem::path& model);

  // Returns where the file of a name lies. The name may be spelled as in a URI or as Windows does. Throws
  // std::runtime_error with the reason why it cannot be read.
  std::filesystem::path find(const std::string& name) const;

 private:
  std::filesystem::path folder_, real_folder_;
};

// Returns why a file cannot be read: it is missing, or it is not a regular one. Empty: it can.
std::string defect_of_file(const std::filesystem::path& file);

}  // namespace pprt
