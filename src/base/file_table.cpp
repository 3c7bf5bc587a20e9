#include "base/file_table.h"

#include <fmt/core.h>
#include <sys/stat.h>

#include <optional>
#include <system_error>

#include "base/diagnostics.h"

namespace pprt {
namespace {

namespace fs = std::filesystem;

// Returns device and inode of a regular file; nullopt for anything else.
std::optional<std::pair<dev_t, ino_t>> identity_of(const fs::path& path) {
  struct stat found {};
  if (stat(path.c_str(), &found) != 0 || !S_ISREG(found.st_mode)) return std::nullopt;
  return std::pair(found.st_dev, found.st_ino);
}

// Returns what a symbolic link leads to, whether or not that exists.
fs::path followed(fs::path path) {
  std::error_code none;
  for (int links = 0; links < 40 && fs::is_symlink(path, none); ++links) {
    path = path.parent_path() / fs::read_symlink(path, none);
  }
  return path;
}

// Throws UsageError when the map has such a file.
template <typename Map>
void require_new(const NamedFile& file, const Map& map, const typename Map::key_type& key) {
  const auto found = map.find(key);
  if (found == map.end()) return;
  const NamedFile& other = found->second;
  throw UsageError(fmt::format("{} {} and {} {} are the same file; give each a name of its own", other.role,
                               other.path.string(), file.role, file.path.string()));
}

}  // namespace

void FileTable::add_input(const NamedFile& file) {
  const auto [name, target] = names_of(file.path);
  others_.emplace(name, file);
  others_.emplace(target, file);
  if (const auto id = identity_of(file.path)) by_identity_.emplace(*id, file);
}

void FileTable::add_output(const NamedFile& file) {
  const auto [name, target] = names_of(file.path);
  require_new(file, others_, name);
  require_new(file, others_, target);
  if (const auto id = identity_of(file.path)) require_new(file, by_identity_, *id);
  add_input(file);
}

void FileTable::add_frame(const NamedFile& file, bool has_twins) {
  const std::string name = full_name(file.path);
  require_new(file, others_, name);
  if (const auto id = identity_of(file.path)) require_new(file, by_identity_, *id);
  if (!has_twins) return;
  require_new(file, frames_, name);
  frames_.emplace(name, file);
}

// A file written in place has the name of a link and that of what it leads to.
std::pair<std::string, std::string> FileTable::names_of(const fs::path& path) {
  return {full_name(path), full_name(followed(path))};
}

// Returns the name in its directory, without links in the directory's path.
std::string FileTable::full_name(const fs::path& path) {
  const auto [found, is_new] = directories_.try_emplace(path.parent_path().string());
  if (is_new) {
    const fs::path directory = path.has_parent_path() ? path.parent_path() : ".";
    std::error_code error;
    fs::path canonical = fs::weakly_canonical(fs::absolute(directory), error);
    if (error) canonical = fs::absolute(directory).lexically_normal();
    // The path of one that does not exist may end in a slash.
    found->second = (canonical.has_filename() ? canonical : canonical.parent_path()).string();
  }
  return found->second + "/" + path.filename().string();
}

}  // namespace pprt
