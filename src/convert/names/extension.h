// By which formats are told apart.
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace pprt {

// Returns the extension of a file's name in lower case, with its dot.
inline std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace pprt
