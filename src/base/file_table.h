// The files of a program's run, told apart by name and by identity.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>

namespace pprt {

struct NamedFile {
  std::string role;  // for messages: "the scene", "--film"
  std::filesystem::path path;
};

// Holds all files so far, to find those that are named twice. Two names mean the same file if their
// directories do, and also if both exist and are one file by device and inode: symbolic and hard links are
// seen.
class FileTable {
 public:
  void add_input(const NamedFile& file);

  // Each adds a file that will be written. Throws UsageError, which names both, when it is one of those
  // before.
  //
  // A frame is a new file that takes its name, so frames among themselves are told apart by name alone.
  // `has_twins`: there are further frames' files whose names may be the same.
  void add_output(const NamedFile& file);
  void add_frame(const NamedFile& file, bool has_twins);

 private:
  std::string full_name(const std::filesystem::path& path);
  std::pair<std::string, std::string> names_of(const std::filesystem::path& path);

  std::unordered_map<std::string, std::string> directories_;  // as given: as they are
  std::unordered_map<std::string, NamedFile> others_, frames_;
  std::map<std::pair<dev_t, ino_t>, NamedFile> by_identity_;
};

}  // namespace pprt
