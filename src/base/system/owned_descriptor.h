// File descriptors that close themselves.
#pragma once

#include <string>
#include <utility>

namespace pprt {

// Throws std::system_error for errno.
[[noreturn]] void throw_errno(const std::string& what);

// Closes itself. Every descriptor has the close-on-exec flag.
class OwnedDescriptor {
 public:
  OwnedDescriptor() = default;
  // Throws std::system_error for a negative value.
  OwnedDescriptor(int value, const char* what);
  OwnedDescriptor(OwnedDescriptor&& other) noexcept : value_(other.release()) {}
  OwnedDescriptor& operator=(OwnedDescriptor&& other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  ~OwnedDescriptor();

  int get() const { return value_; }
  int release() { return std::exchange(value_, -1); }

 private:
  int value_ = -1;
};

// The two ends of a connection to another process.
struct Ends {
  OwnedDescriptor ours, theirs;
};

// Read by us, written by the other process.
Ends make_pipe();

// Leads to /dev/null.
OwnedDescriptor open_nothing();

}  // namespace pprt
