#include "convert/model/model_folder.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <system_error>

namespace pprt {
namespace {

namespace fs = std::filesystem;

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

}  // namespace

ModelFolder::ModelFolder(const fs::path& model)
    : folder_(model.has_parent_path() ? model.parent_path() : "."), real_folder_(fs::canonical(folder_)) {}

fs::path ModelFolder::find(const std::string& name) const {
  std::string first_defect;
  for (const std::string& spelled : {name, decoded(name), with_slashes(name)}) {
    const fs::path file = folder_ / spelled;
    std::error_code error;
    const fs::path real = fs::weakly_canonical(file, error);
    if (error) throw std::runtime_error(error.message());
    if (std::mismatch(real_folder_.begin(), real_folder_.end(), real.begin(), real.end()).first !=
        real_folder_.end())
      throw std::runtime_error("it lies outside the folder of the mesh");
    const std::string defect = defect_of_file(file);
    if (defect.empty()) return file;
    if (first_defect.empty()) first_defect = defect;
  }
  throw std::runtime_error(first_defect);
}

std::string defect_of_file(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::directory)
    return std::make_error_code(std::errc::is_a_directory).message();
  if (fs::exists(status)) return fs::is_regular_file(status) ? "" : "it is not a regular file";
  return error ? error.message() : std::make_error_code(std::errc::no_such_file_or_directory).message();
}

}  // namespace pprt
