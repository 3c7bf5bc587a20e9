#include "study/report/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

namespace pprt {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error("cannot draw a plot: " + what);
}

// A file in memory: what goes into gnuplot and comes out of it, of any length, without a deadlock of pipes.
class MemoryFile {
 public:
  explicit MemoryFile(const char* name) : descriptor_(memfd_create(name, MFD_CLOEXEC)) {
    if (descriptor_ < 0) fail(std::strerror(errno));
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { close(descriptor_); }

  int descriptor() const { return descriptor_; }

  void fill(std::string_view text) const {
    while (!text.empty()) {
      const ssize_t written = write(descriptor_, text.data(), text.size());
      if (written < 0 && errno != EINTR) fail(std::strerror(errno));
      if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
    }
    rewind();
  }

  std::string content() const {
    rewind();
    std::string text;
    std::array<char, 1 << 16> part{};
    ssize_t got = 0;
    while ((got = read(descriptor_, part.data(), part.size())) != 0) {
      if (got < 0 && errno != EINTR) fail(std::strerror(errno));
      if (got > 0) text.append(part.data(), static_cast<std::size_t>(got));
    }
    return text;
  }

 private:
  void rewind() const { lseek(descriptor_, 0, SEEK_SET); }

  int descriptor_;
};

// Runs the program on the given input; returns its exit code.
int run(const std::string& program, const MemoryFile& in, const MemoryFile& out, const MemoryFile& err) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, in.descriptor(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, out.descriptor(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, err.descriptor(), STDERR_FILENO);
  std::string name = program;
  char* words[] = {name.data(), nullptr};
  pid_t child = 0;
  const int error = posix_spawnp(&child, program.c_str(), &files, nullptr, words, environ);
  posix_spawn_file_actions_destroy(&files);
  if (error == ENOENT || error == EACCES) {
    throw MissingTool(program + " is not installed (Debian package gnuplot-nox)");
  }
  if (error != 0) fail(std::strerror(error));
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) fail(std::strerror(errno));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

}  // namespace

std::string draw_svg(const Plot& plot, const std::string& program) {
  const MemoryFile in("plot"), out("svg"), err("messages");
  in.fill(gnuplot_script(plot));
  const int code = run(program, in, out, err);
  const std::string svg = out.content();
  const std::size_t begin = svg.find("<svg"), end = svg.rfind("</svg>");
  if (code != 0 || begin == std::string::npos || end == std::string::npos) {
    fail(program + " ended with " + std::to_string(code) + ": " + err.content());
  }
  return svg.substr(begin, end + 6 - begin);
}

}  // namespace pprt
