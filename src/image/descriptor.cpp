#include "image/descriptor.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace pprt {
namespace {

[[noreturn]] void throw_errno() {
  throw std::system_error(errno, std::generic_category());
}

}  // namespace

Descriptor::Descriptor(const std::filesystem::path& path, int flags)
    : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {
  if (fd_ < 0) throw_errno();
}

Descriptor::~Descriptor() {
  if (fd_ >= 0) ::close(fd_);
}

bool Descriptor::read_some(std::string& bytes, std::size_t size) {
  const std::size_t old_size = bytes.size();
  bytes.resize(old_size + size);
  ssize_t count = 0;
  do {
    count = ::read(fd_, bytes.data() + old_size, size);
  } while (count < 0 && errno == EINTR);
  if (count < 0) throw_errno();
  bytes.resize(old_size + static_cast<std::size_t>(count));
  return count > 0;
}

void Descriptor::write_all(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(fd_, bytes.data(), bytes.size());
    if (count >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno != EINTR) {
      throw_errno();
    }
  }
}

bool Descriptor::lock() const {
  return ::flock(fd_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

bool Descriptor::is_at(const std::filesystem::path& path) const {
  struct stat own {
  }, found{};
  return ::fstat(fd_, &own) == 0 && ::stat(path.c_str(), &found) == 0 && own.st_dev == found.st_dev &&
         own.st_ino == found.st_ino;
}

void Descriptor::close() {
  const int fd = std::exchange(fd_, -1);
  if (::close(fd) != 0) throw_errno();
}

}  // namespace pprt
