// Reads and writes whole files. Writing is atomic: a file that has its final name is complete.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

#include "image/descriptor.h"

namespace pprt {

// Returns all bytes of a file or pipe. Throws std::runtime_error "cannot read 'PATH': REASON".
std::string read_whole_file(const std::filesystem::path& path);

// Writes to a temporary name in the same directory, then renames it. A reader of PATH finds the old file or
// the whole new one, even if this process dies. Missing directories are created. A symbolic link is replaced,
// not followed; other non-regular files are refused.
//
// Not synced to the disk: that would help against power cuts only, at the cost of the disk's latency per
// frame.
//
// Throws std::runtime_error "cannot write 'PATH': REASON". PATH is then unchanged and the temporary file
// gone.
void write_whole_file(const std::filesystem::path& path, std::string_view bytes);

// The same for content that is never whole in memory: `write` puts all bytes into an unbuffered stream. Its
// exceptions pass through; PATH is then unchanged.
void write_whole_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

// The same for a file that another program writes, under its temporary name. Each function throws as
// write_whole_file(). Without commit() the temporary file is removed at the end of its scope.
class AtomicFile {
 public:
  // Creates missing directories and the temporary file, which is new and empty: nothing that has its name is
  // opened.
  explicit AtomicFile(std::filesystem::path path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  const std::filesystem::path& temporary() const { return temporary_; }

  // Gives the file its name.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
};

// Throws as write_whole_file() if writing would fail now: something other than a file has the name, or there
// is no directory that a file or directory can be added to. Changes nothing.
void require_writable(const std::filesystem::path& path);

// A file that grows line by line.
class AppendedFile {
 public:
  AppendedFile() = default;  // none

  // Opens the file, or creates it. Throws std::runtime_error "cannot write 'PATH': REASON".
  explicit AppendedFile(std::filesystem::path path);

  // Passes all bytes to the system at once. Throws likewise.
  void append(std::string_view bytes);

  // Throws likewise when the path leads to this file no more: it was removed, renamed or replaced.
  void require_in_place() const;

 private:
  friend class FileClaim;
  AppendedFile(std::filesystem::path path, Descriptor file);

  std::filesystem::path path_;
  Descriptor file_;
};

// The right to write a file, which one process has at a time. The system takes it back when the process ends,
// however it does. Where a file system knows no locks, everybody gets it.
class FileClaim {
 public:
  // Claims the file, if there is one. Changes nothing. Throws std::runtime_error "cannot write 'PATH':
  // REASON": another process has claimed it, it is no regular file, it may not be written.
  explicit FileClaim(std::filesystem::path path);

  // Returns the file's bytes; nullopt: there is none.
  const std::optional<std::string>& content() const { return content_; }

  // Returns a new file of these bytes that takes the name, as write_whole_file(). It is claimed as long as it
  // is open. Throws likewise, and also when another process has made such a file meanwhile.
  AppendedFile replace(std::string_view bytes) &&;

 private:
  std::filesystem::path path_;
  Descriptor claimed_;
  std::optional<std::string> content_;
};

}  // namespace pprt
