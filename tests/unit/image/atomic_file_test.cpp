#include "image/atomic_file.h"

#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <ostream>
#include <stdexcept>

#include "unit/image/temporary_directory.h"

namespace fs = std::filesystem;
namespace pprt::atomic_file_test {

namespace {

// No file may grow beyond `bytes` while this lives: a full disk that needs no disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    REQUIRE(::setrlimit(RLIMIT_FSIZE, &limit) == 0);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_handler_);
  }

 private:
  void (*old_handler_)(int);
  rlimit old_{};
};

}  // namespace

TEST_CASE("bytes come back as they were written, and nothing else is left") {
  const TemporaryDirectory directory;
  const std::string bytes("a\0b\nc", 5);
  write_whole_file(directory.path() / "f", bytes);
  CHECK(read_whole_file(directory.path() / "f") == bytes);
  write_whole_file(directory.path() / "f", "");
  CHECK(read_whole_file(directory.path() / "f").empty());
  CHECK(directory.entries() == 1);
}

TEST_CASE("bytes may come through a stream, piece by piece") {
  const TemporaryDirectory directory;
  write_whole_file(directory.path() / "f",
                   [](std::ostream& out) { out << "a" << std::string(100'000, 'b') << 'c'; });
  CHECK(read_whole_file(directory.path() / "f") == "a" + std::string(100'000, 'b') + "c");
  CHECK(directory.entries() == 1);
}

TEST_CASE("what the writer of a stream throws comes through, and leaves the old file and no temporary one") {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "f";
  write_whole_file(path, "old");
  const auto write = [](std::ostream& out) {
    out << "half";
    throw std::invalid_argument("no more");
  };
  CHECK_THROWS_AS(write_whole_file(path, write), std::invalid_argument);
  const FileSizeLimit limit(1000);
  CHECK_THROWS_WITH(write_whole_file(path, [](std::ostream& out) { out << std::string(2000, 'x'); }),
                    "cannot write '" + path.string() + "': File too large");
  CHECK(read_whole_file(path) == "old");
  CHECK(directory.entries() == 1);
}

TEST_CASE("missing directories are made") {
  const TemporaryDirectory directory;
  write_whole_file(directory.path() / "a/b/f", "x");
  CHECK(read_whole_file(directory.path() / "a/b/f") == "x");
}

TEST_CASE("a file name of maximum length can be written") {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / std::string(255, 'n');
  write_whole_file(path, "x");
  CHECK(fs::exists(path));
}

TEST_CASE("a write that fails half-way leaves the old file and no temporary one") {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "f.exr";
  write_whole_file(path, "old");
  {
    const FileSizeLimit limit(4096);
    CHECK_THROWS_WITH(write_whole_file(path, std::string(10000, 'x')),
                      "cannot write '" + path.string() + "': File too large");
  }
  CHECK(read_whole_file(path) == "old");
  CHECK(directory.entries() == 1);
}

TEST_CASE("a path under a regular file cannot be written") {
  const TemporaryDirectory directory;
  write_whole_file(directory.path() / "f", "x");
  const fs::path path = directory.path() / "f" / "g";
  CHECK_THROWS_WITH(write_whole_file(path, "y"), "cannot write '" + path.string() + "': Not a directory");
}

TEST_CASE("neither a directory nor a device is written over") {
  const TemporaryDirectory directory;
  const std::string name = directory.path().string();
  CHECK_THROWS_WITH(write_whole_file(name, "x"), "cannot write '" + name + "': it is a directory");

  const fs::path link = directory.path() / "full.png";
  fs::create_symlink("/dev/full", link);
  CHECK_THROWS_WITH(write_whole_file(link, "x"),
                    "cannot write '" + link.string() + "': it is not a regular file");
  CHECK(fs::is_symlink(link));
  CHECK(directory.entries() == 1);
}

TEST_CASE("a symbolic link to a file is replaced, not followed") {
  const TemporaryDirectory directory;
  write_whole_file(directory.path() / "target", "old");
  fs::create_symlink("target", directory.path() / "link");
  write_whole_file(directory.path() / "link", "new");
  CHECK(read_whole_file(directory.path() / "target") == "old");
  CHECK(read_whole_file(directory.path() / "link") == "new");
}

TEST_CASE("what cannot be read is named with the reason") {
  const TemporaryDirectory directory;
  const std::string missing = (directory.path() / "missing").string();
  CHECK_THROWS_WITH(read_whole_file(missing), "cannot read '" + missing + "': No such file or directory");
  const std::string name = directory.path().string();
  CHECK_THROWS_WITH(read_whole_file(name), "cannot read '" + name + "': Is a directory");
}

TEST_CASE("a file that another program writes gets its name when it is committed") {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "new" / "film.mp4";
  {
    const AtomicFile given_up(path);
    CHECK(fs::file_size(given_up.temporary()) == 0);
  }
  CHECK(fs::is_empty(path.parent_path()));
  AtomicFile file(path);
  std::ofstream(file.temporary()) << "film";
  CHECK_FALSE(fs::exists(path));
  file.commit();
  CHECK(read_whole_file(path) == "film");
  CHECK_FALSE(fs::exists(file.temporary()));
}

TEST_CASE("a temporary file is a new one, whatever lies at its name") {
  const TemporaryDirectory directory;
  write_whole_file(directory.path() / "precious", "old");
  fs::path first;
  first = AtomicFile(directory.path() / "f").temporary();
  fs::create_symlink("precious", first);
  AtomicFile second(directory.path() / "f");
  CHECK(second.temporary() != first);
  std::ofstream(second.temporary()) << "new";
  second.commit();
  CHECK(read_whole_file(directory.path() / "precious") == "old");
}

TEST_CASE("what cannot be written is known beforehand, and nothing is made for that") {
  const TemporaryDirectory directory;
  const std::string name = directory.path().string();
  write_whole_file(name + "/f", "x");
  CHECK_NOTHROW(require_writable(name + "/f"));
  CHECK_NOTHROW(require_writable(name + "/a/b/c"));
  CHECK_NOTHROW(require_writable("no_directory"));
  CHECK_THROWS_WITH(require_writable(name), "cannot write '" + name + "': it is a directory");
  CHECK_THROWS_WITH(require_writable(name + "/f/g"), "cannot write '" + name + "/f/g': Not a directory");
  CHECK_THROWS_WITH(require_writable("/dev/full"), "cannot write '/dev/full': it is not a regular file");
  CHECK(directory.entries() == 1);
}

TEST_CASE("a file that grows keeps what it holds, and tells when it cannot") {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "f";
  AppendedFile(path).append("a\n");
  AppendedFile(path).append("b\n");
  CHECK(read_whole_file(path) == "a\nb\n");
  AppendedFile full("/dev/full");
  CHECK_THROWS_WITH(full.append("x"), "cannot write '/dev/full': No space left on device");
  const std::string name = directory.path().string();
  CHECK_THROWS_WITH(AppendedFile(name), "cannot write '" + name + "': Is a directory");
}

}  // namespace pprt::atomic_file_test
