#include "image/atomic_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <ostream>
#include <stdexcept>
#include <streambuf>
#include <system_error>
#include <utility>

namespace pprt {
namespace {

namespace fs = std::filesystem;

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

// The reason why a path is refused.
struct Refusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Calls `work`; what fails becomes "cannot write 'PATH': REASON". Other exceptions pass through.
template <typename Work>
void naming(const fs::path& path, const Work& work) {
  std::string reason;
  try {
    work();
    return;
  } catch (const std::system_error& e) {
    reason = e.code().message();
  } catch (const Refusal& e) {
    reason = e.what();
  }
  throw std::runtime_error(fmt::format("cannot write '{}': {}", path.string(), reason));
}

void require_regular(const fs::path& path) {
  const fs::file_status found = fs::status(path);
  if (fs::is_directory(found)) throw Refusal("it is a directory");
  if (fs::exists(found) && !fs::is_regular_file(found)) throw Refusal("it is not a regular file");
}

struct TemporaryFile {
  fs::path path;
  Descriptor file;
};

// Makes an empty file of a name that no file in the directory has. The name does not contain the final one,
// which may have the maximum length. Left-overs of killed processes are skipped.
TemporaryFile make_temporary(const fs::path& directory) {
  for (int i = 0;; ++i) {
    fs::path path = directory / fmt::format(".pprt-{}-{}.tmp", ::gettid(), i);
    try {
      Descriptor file(path, O_WRONLY | O_CREAT | O_EXCL | O_APPEND);
      return {std::move(path), std::move(file)};
    } catch (const std::system_error& e) {
      if (e.code() != std::errc::file_exists) throw;
    }
  }
}

TemporaryFile make_temporary_for(const fs::path& path) {
  const fs::path directory = path.parent_path();
  if (!directory.empty()) fs::create_directories(directory);
  require_regular(path);
  return make_temporary(directory);
}

// Removes a file at the end of its scope.
struct Removal {
  fs::path path;
  ~Removal() { ::unlink(path.c_str()); }
};

// Appends all bytes to a string.
void read_all(Descriptor& file, std::string& bytes) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  while (file.read_some(bytes, kPiece)) {
  }
}

constexpr const char* kClaimed = "another run is writing to it";

// Gives the file a name that no other must have: in this moment another process may take it.
void rename_to_new(const fs::path& from, const fs::path& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return;
  if (errno == EEXIST) throw Refusal(kClaimed);
  fs::rename(from, to);  // the file system knows only this, or will say what is wrong
}

void write_and_rename(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  TemporaryFile temporary = make_temporary_for(path);
  const Removal removal{temporary.path};  // after the rename there is nothing to remove
  DescriptorBuffer buffer(temporary.file);
  std::ostream stream(&buffer);
  stream.exceptions(std::ios::badbit);  // rethrows the buffer's exceptions
  write(stream);
  temporary.file.close();
  fs::rename(temporary.path, path);
}

// Returns the directory to which the path's file, or the first of its missing directories, would be added.
fs::path first_existing_directory(const fs::path& path) {
  fs::path directory = path.parent_path();
  while (!directory.empty() && !fs::exists(directory)) directory = directory.parent_path();
  return directory.empty() ? "." : directory;
}

}  // namespace

std::string read_whole_file(const fs::path& path) {
  try {
    Descriptor file(path, O_RDONLY);
    std::string bytes;
    read_all(file, bytes);
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
  naming(path, [&] { write_and_rename(path, write); });
}

AtomicFile::AtomicFile(fs::path path) : path_(std::move(path)) {
  naming(path_, [this] { temporary_ = make_temporary_for(path_).path; });
}

AtomicFile::~AtomicFile() {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::commit() {
  naming(path_, [this] { fs::rename(temporary_, path_); });
  temporary_.clear();
}

void require_writable(const fs::path& path) {
  naming(path, [&] {
    require_regular(path);
    const fs::path directory = first_existing_directory(path);
    if (!fs::is_directory(directory)) throw Refusal("Not a directory");
    if (::access(directory.c_str(), W_OK | X_OK) != 0)
      throw std::system_error(errno, std::generic_category());
  });
}

AppendedFile::AppendedFile(fs::path path) : path_(std::move(path)) {
  naming(path_, [this] { file_ = Descriptor(path_, O_WRONLY | O_CREAT | O_APPEND); });
}

AppendedFile::AppendedFile(fs::path path, Descriptor file) : path_(std::move(path)), file_(std::move(file)) {}

void AppendedFile::require_in_place() const {
  naming(path_, [this] {
    if (!file_.is_at(path_)) throw Refusal("it was removed, renamed or replaced while it was written");
  });
}

void AppendedFile::append(std::string_view bytes) {
  naming(path_, [&] { file_.write_all(bytes); });
}

FileClaim::FileClaim(fs::path path) : path_(std::move(path)) {
  naming(path_, [this] {
    do {
      require_regular(path_);
      if (!fs::exists(path_)) return;
      claimed_ = Descriptor(path_, O_RDWR);  // for reading alone, NFS gives no lock
      if (!claimed_.lock()) throw Refusal(kClaimed);
    } while (!claimed_.is_at(path_));  // else its last owner has just replaced it
    read_all(claimed_, content_.emplace());
  });
}

AppendedFile FileClaim::replace(std::string_view bytes) && {
  AppendedFile replaced;
  naming(path_, [&] {
    TemporaryFile temporary = make_temporary_for(path_);
    const Removal removal{temporary.path};
    temporary.file.lock();
    temporary.file.write_all(bytes);
    content_ ? fs::rename(temporary.path, path_) : rename_to_new(temporary.path, path_);
    replaced = AppendedFile(path_, std::move(temporary.file));
  });
  return replaced;
}

}  // namespace pprt
