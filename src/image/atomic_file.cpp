#include "image/atomic_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <ostream>
#include <stdexcept>
#include <streambuf>
#include <system_error>

namespace pprt {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void throw_errno() {
  throw std::system_error(errno, std::generic_category());
}

// An open file, closed at the end of its scope.
class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags) : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {
    if (fd_ < 0) throw_errno();
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }

  // Appends up to `size` bytes to `bytes`; false at the end of the file.
  bool read_some(std::string& bytes, std::size_t size) {
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

  void write_all(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t count = ::write(fd_, bytes.data(), bytes.size());
      if (count >= 0) {
        bytes.remove_prefix(static_cast<std::size_t>(count));
      } else if (errno != EINTR) {
        throw_errno();
      }
    }
  }

  // Some file systems report a full disk or quota only at closing.
  void close() {
    const int fd = fd_;
    fd_ = -1;
    if (::close(fd) != 0) throw_errno();
  }

 private:
  int fd_;
};

// A stream buffer that passes all bytes to a descriptor at once. Its exceptions reach the stream's user.
class DescriptorBuffer : public std::streambuf {
 public:
  explicit DescriptorBuffer(Descriptor& file) : file_(file) {}

 private:
  std::streamsize xsputn(const char* bytes, std::streamsize count) override {
    file_.write_all({bytes, static_cast<std::size_t>(count)});
    return count;
  }
  int_type overflow(int_type c) override {
    const char byte = traits_type::to_char_type(c);
    file_.write_all({&byte, 1});
    return c;
  }

  Descriptor& file_;
};

// Removes a file at the end of its scope.
struct Removal {
  fs::path path;
  ~Removal() { ::unlink(path.c_str()); }
};

// The reason why a path is refused.
struct Refusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Returns a name that no file in the directory has and no other thread or process uses. It does not contain
// the final name, which may have the maximum length. Left-overs of killed processes are skipped.
fs::path unused_name(const fs::path& directory) {
  for (int i = 0;; ++i) {
    fs::path name = directory / fmt::format(".pprt-{}-{}.tmp", ::gettid(), i);
    if (!fs::exists(fs::symlink_status(name))) return name;
  }
}

void write_and_rename(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  const fs::path directory = path.parent_path();
  if (!directory.empty()) fs::create_directories(directory);
  const fs::file_status found = fs::status(path);
  if (fs::is_directory(found)) throw Refusal("it is a directory");
  if (fs::exists(found) && !fs::is_regular_file(found)) throw Refusal("it is not a regular file");

  const fs::path temporary = unused_name(directory);
  Descriptor file(temporary, O_WRONLY | O_CREAT | O_EXCL);
  const Removal removal{temporary};  // after the rename there is nothing to remove
  DescriptorBuffer buffer(file);
  std::ostream stream(&buffer);
  stream.exceptions(std::ios::badbit);  // rethrows the buffer's exceptions
  write(stream);
  file.close();
  fs::rename(temporary, path);
}

}  // namespace

std::string read_whole_file(const fs::path& path) {
  try {
    constexpr std::size_t kPiece = std::size_t{1} << 20;
    Descriptor file(path, O_RDONLY);
    std::string bytes;
    while (file.read_some(bytes, kPiece)) {
    }
    return bytes;
  } catch (const std::system_error& e) {
    throw std::runtime_error(fmt::format("cannot read '{}': {}", path.string(), e.code().message()));
  }
}

void write_whole_file(const fs::path& path, std::string_view bytes) {
  write_whole_file(
      path, [&](std::ostream& out) { out.write(bytes.data(), static_cast<std::streamsize>(bytes.size())); });
}

void write_whole_file(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  std::string reason;
  try {
    write_and_rename(path, write);
    return;
  } catch (const std::system_error& e) {
    reason = e.code().message();
  } catch (const Refusal& e) {
    reason = e.what();
  }
  throw std::runtime_error(fmt::format("cannot write '{}': {}", path.string(), reason));
}

}  // namespace pprt
