#include "base/system/owned_descriptor.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace pprt {

void throw_errno(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

OwnedDescriptor::OwnedDescriptor(int value, const char* what) : value_(value) {
  if (value_ < 0) throw_errno(what);
}

OwnedDescriptor::~OwnedDescriptor() {
  if (value_ >= 0) close(value_);
}

Ends make_pipe() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw_errno("pipe");
  return {OwnedDescriptor(ends[0], "pipe"), OwnedDescriptor(ends[1], "pipe")};
}

OwnedDescriptor open_nothing() {
  return OwnedDescriptor(open("/dev/null", O_RDWR | O_CLOEXEC), "/dev/null");
}

}  // namespace pprt
