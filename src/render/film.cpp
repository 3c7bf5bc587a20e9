#include "render/film.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <system_error>

#include "base/diagnostics.h"
#include "image/image_io.h"

namespace pprt {
namespace {

constexpr const char* kMissing = "--film needs ffmpeg, which is not on the PATH (package ffmpeg)";

[[noreturn]] void fail(const std::filesystem::path& film, const std::string& reason) {
  throw std::runtime_error("cannot write '" + film.string() + "': " + reason);
}

std::string container(const std::filesystem::path& film) {
  return film.extension() == ".mkv" ? "matroska" : "mp4";
}

// A program that is given pictures on its standard input, a socket: writing to one that has ended is an error
// there and no signal.
class Encoder {
 public:
  explicit Encoder(std::vector<std::string> words) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) throw_errno("socketpair");
    input_ = ends[0];
    const int error = start(words, ends[1]);
    ::close(ends[1]);
    if (error == 0) return;
    ::close(input_);
    if (error == ENOENT) throw std::runtime_error(kMissing);
    throw std::runtime_error(words[0] + ": " + std::strerror(error));
  }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  ~Encoder() { finish(); }

  // False: it takes no more, and finish() will tell why.
  bool take(const std::vector<std::uint8_t>& bytes) const {
    for (std::size_t at = 0; at < bytes.size();) {
      const ssize_t sent = send(input_, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
      if (sent < 0 && errno != EINTR) return false;
      if (sent > 0) at += static_cast<std::size_t>(sent);
    }
    return true;
  }

  // The end of the input; returns its exit code, or 128 + the signal that ended it.
  int finish() {
    if (child_ == 0) return code_;
    ::close(input_);
    int status = 0;
    while (waitpid(child_, &status, 0) < 0 && errno == EINTR) {
    }
    child_ = 0;
    return code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  [[noreturn]] static void throw_errno(const char* what) {
    throw std::system_error(errno, std::generic_category(), what);
  }

  // In a process group of its own: a terminal's Ctrl-C asks us, who then let it come to its end.
  int start(std::vector<std::string>& words, int input) {
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    const int error = posix_spawnp(&child_, words[0].c_str(), &files, &attributes, pointers.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    if (error != 0) child_ = 0;
    return error;
  }

  int input_ = -1;
  pid_t child_ = 0;
  int code_ = 0;
};

// As a PNG has them.
std::vector<std::uint8_t> display_bytes(const Image& image) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * image.pixels.size());
  for (const Color& pixel : image.pixels) {
    for (const float value : {pixel.x, pixel.y, pixel.z}) {
      bytes.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.f, 1.f))));
    }
  }
  return bytes;
}

// Films hold brightness and colour apart, at half the size, in the matrix of high definition.
std::vector<std::string> ffmpeg_command(const Image& first, double frames_per_second,
                                        const std::string& format, const std::string& output) {
  return {"ffmpeg",
          "-hide_banner",
          "-loglevel",
          "error",
          "-f",
          "rawvideo",
          "-pix_fmt",
          "rgb24",
          "-video_size",
          fmt::format("{}x{}", first.width, first.height),
          "-framerate",
          fmt::format("{}", frames_per_second),
          "-i",
          "pipe:0",
          "-vf",
          "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709",
          "-c:v",
          "libx264",
          "-crf",
          "18",
          "-pix_fmt",
          "yuv420p",
          "-colorspace",
          "bt709",
          "-color_primaries",
          "bt709",
          "-color_trc",
          "bt709",
          "-f",
          format,
          "-y",
          output};
}

void encode(const std::filesystem::path& film, const std::filesystem::path& temporary,
            const std::vector<std::filesystem::path>& pictures, double frames_per_second) {
  const Image first = read_image(pictures.front());
  Encoder encoder(ffmpeg_command(first, frames_per_second, container(film), temporary.string()));
  for (const std::filesystem::path& picture : pictures) {
    const Image image = read_image(picture);
    if (image.width != first.width || image.height != first.height) {
      throw std::runtime_error("'" + picture.string() + "' has another size than '" +
                               pictures.front().string() + "'");
    }
    if (!encoder.take(display_bytes(image))) break;
  }
  if (const int code = encoder.finish(); code != 0) {
    fail(film, fmt::format("ffmpeg ended with code {}", code));
  }
}

}  // namespace

void require_film_name(const std::filesystem::path& film) {
  if (film.extension() == ".mp4" || film.extension() == ".mkv") return;
  throw UsageError("--film " + film.string() + ": want a name that ends in .mp4 or .mkv");
}

void require_ffmpeg() {
  // Prints its version and ends: what is on the PATH can be run.
  if (Encoder({"ffmpeg", "-loglevel", "quiet", "-version"}).finish() != 0) throw std::runtime_error(kMissing);
}

void write_film(const std::filesystem::path& film, const std::vector<std::filesystem::path>& pictures,
                double frames_per_second) {
  std::error_code error;
  if (film.has_parent_path()) std::filesystem::create_directories(film.parent_path(), error);
  if (error) fail(film, error.message());
  const std::filesystem::path temporary = film.string() + ".part";
  try {
    encode(film, temporary, pictures, frames_per_second);
    std::filesystem::rename(temporary, film);
  } catch (...) {
    std::filesystem::remove(temporary, error);
    throw;
  }
}

}  // namespace pprt
