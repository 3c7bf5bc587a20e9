// A file that a run reads or writes.
#pragma once

#include <filesystem>
#include <string>

namespace pprt {

struct NamedFile {
  std::string role;  // for messages: "the scene", "--film"
  std::filesystem::path path;
};

}  // namespace pprt
