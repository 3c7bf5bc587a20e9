// An open file, closed at the end of its scope. Private to the module.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace pprt {

// Every failure is a std::system_error with the system's error number.
class Descriptor {
 public:
  Descriptor() = default;

  // Opens the path with open(2)'s flags; a new file gets the usual permissions.
  Descriptor(const std::filesystem::path& path, int flags);
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Descriptor();

  // Appends up to `size` bytes to `bytes`; false at the end of the file.
  bool read_some(std::string& bytes, std::size_t size);

  void write_all(std::string_view bytes);

  // Locks the file until it is closed. Returns false where another process has it locked (flock); a file
  // system without locks says nothing of it.
  bool lock() const;

  // Whether the path leads to this file.
  bool is_at(const std::filesystem::path& path) const;

  // Some file systems report a full disk or quota only at closing.
  void close();

 private:
  int fd_ = -1;
};

}  // namespace pprt
