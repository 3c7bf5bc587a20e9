#include "render/film.h"

#include <fmt/format.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/diagnostics.h"
#include "base/subprocess.h"
#include "image/atomic_file.h"
#include "image/display_bytes.h"
#include "image/image_io.h"

namespace pprt {
namespace {

constexpr const char* kMissing = "--film needs ffmpeg, which is not on the PATH (package ffmpeg)";

[[noreturn]] void fail(const std::filesystem::path& film, const std::string& reason) {
  throw std::runtime_error("cannot write '" + film.string() + "': " + reason);
}

// Starts ffmpeg in a process group of its own. A terminal's Ctrl-C then reaches this process alone, which
// lets ffmpeg finish the film.
Subprocess start_encoder(std::vector<std::string> command, StreamTo input) {
  try {
    return Subprocess(std::move(command),
                      {.input = input, .output = StreamTo::kNothing, .own_process_group = true});
  } catch (const ProgramNotFound&) {
    throw std::runtime_error(kMissing);
  }
}

using Words = std::vector<std::string>;

// H.264 with chroma at half resolution, in the colours of high definition (BT.709).
Words video(const std::string& container) {
  return {"-vf",
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
          container};
}

// A GIF that repeats for ever, with the 256 colours that suit its frames best. Dots that a frame shares with
// the one before take no bytes.
Words animated_gif() {
  return {"-filter_complex",
          "split[a][b];[a]palettegen[p];[b][p]paletteuse=dither=bayer:bayer_scale=4",
          "-loop",
          "0",
          "-f",
          "gif"};
}

Words encoding(const std::filesystem::path& film) {
  if (film.extension() == ".gif") return animated_gif();
  return video(film.extension() == ".mkv" ? "matroska" : "mp4");
}

// Without -xerror ffmpeg 5.1 ends with code 0 although the disk had no room for the end of the film.
Words ffmpeg_command(const Image& first, double frames_per_second, const Words& encoding,
                     const std::string& output) {
  Words command = {"ffmpeg",
                   "-hide_banner",
                   "-loglevel",
                   "error",
                   "-xerror",
                   "-f",
                   "rawvideo",
                   "-pix_fmt",
                   "rgb24",
                   "-video_size",
                   fmt::format("{}x{}", first.width, first.height),
                   "-framerate",
                   fmt::format("{}", frames_per_second),
                   "-i",
                   "pipe:0"};
  command.insert(command.end(), encoding.begin(), encoding.end());
  // Whatever the name looks like, it is no option and no URL.
  command.insert(command.end(), {"-y", "file:" + output});
  return command;
}

void encode(const std::filesystem::path& film, const std::filesystem::path& temporary,
            const std::vector<std::filesystem::path>& pictures, double frames_per_second) {
  const Image first = read_image(pictures.front());
  Subprocess encoder = start_encoder(
      ffmpeg_command(first, frames_per_second, encoding(film), temporary.string()), StreamTo::kPipe);
  for (const std::filesystem::path& picture : pictures) {
    const Image image = read_image(picture);
    if (image.width != first.width || image.height != first.height) {
      throw std::runtime_error("'" + picture.string() + "' has another size than '" +
                               pictures.front().string() + "'");
    }
    const std::vector<std::uint8_t> bytes = display_bytes(image);
    if (!encoder.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()})) break;
  }
  if (const int code = encoder.wait().code; code != 0) {
    fail(film, fmt::format("ffmpeg ended with code {}", code));
  }
}

}  // namespace

void require_film_name(const std::filesystem::path& film) {
  for (const char* known : {".mp4", ".mkv", ".gif"}) {
    if (film.extension() == known) return;
  }
  throw UsageError("--film " + film.string() + ": want a name that ends in .mp4, .mkv or .gif");
}

void require_ffmpeg() {
  // Prints its version and ends, which shows that it can be run.
  Subprocess ffmpeg = start_encoder({"ffmpeg", "-loglevel", "quiet", "-version"}, StreamTo::kSame);
  if (ffmpeg.wait().code != 0) throw std::runtime_error(kMissing);
}

void write_film(const std::filesystem::path& film, const std::vector<std::filesystem::path>& pictures,
                double frames_per_second) {
  AtomicFile file(film);
  encode(film, file.temporary(), pictures, frames_per_second);
  file.commit();
}

}  // namespace pprt
