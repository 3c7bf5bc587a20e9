#include "render/output/film.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include "base/diagnostics.h"
#include "base/system/subprocess.h"
#include "cli/process/stop_signals.h"
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
// lets ffmpeg finish the film. One that hangs, and may hear no other signal, is killed with this process.
Subprocess start_encoder(std::vector<std::string> command, StreamTo input) {
  try {
    return Subprocess(
        std::move(command),
        {.input = input, .output = StreamTo::kNothing, .own_process_group = true, .signal_at_end = SIGKILL});
  } catch (const ProgramNotFound&) {
    throw std::runtime_error(kMissing);
  }
}

// Ends a program that hangs, once the run has been asked to end. Others are given their time: nobody knows
// how long ffmpeg may take for a picture.
class HangWatch {
 public:
  explicit HangWatch(const Subprocess& program) : program_(program) {}

  void note_progress() { ++progress_; }

  // Waits until the program has ended. To be called before its wait(): until then nobody else has its number.
  void await_end() {
    while (!program_.has_ended()) std::this_thread::sleep_for(kBetweenLooks);
    thread_ = {};
  }

  bool has_ended_it() const { return has_ended_it_; }

 private:
  static constexpr auto kBetweenLooks = std::chrono::milliseconds(20);
  static constexpr auto kPatience = std::chrono::seconds(10);

  void run(const std::stop_token& over) {
    auto quiet_since = std::chrono::steady_clock::now();
    for (std::size_t seen = 0; !over.stop_requested(); std::this_thread::sleep_for(kBetweenLooks)) {
      const auto now = std::chrono::steady_clock::now();
      if (!stop_requested() || progress_ != seen) seen = progress_, quiet_since = now;
      if (now - quiet_since < kPatience) continue;
      has_ended_it_ = true;
      kill(program_.id(), SIGKILL);
      return;
    }
  }

  const Subprocess& program_;
  std::atomic<std::size_t> progress_ = 0;
  std::atomic<bool> has_ended_it_ = false;
  std::jthread thread_{[this](const std::stop_token& over) { run(over); }};  // last: it uses the others
};

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

// The palette of 256 colours that suits all frames best, as a picture.
Words palette() {
  return {"-vf", "palettegen", "-frames:v", "1", "-c:v", "png", "-f", "image2", "-update", "1"};
}

// A GIF of such a palette that repeats for ever. Dots that a frame shares with the one before take no bytes.
// Its clock counts hundredths of a second, and players want two at least.
Words animated_gif(const std::string& palette) {
  return {"-i",     "file:" + palette,
          "-lavfi", "fps=fps='min(source_fps,50)'[a];[a][1:v]paletteuse=dither=bayer:bayer_scale=4",
          "-loop",  "0",
          "-f",     "gif"};
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

// Passes all pictures to ffmpeg.
void encode(const std::filesystem::path& film, const Words& encoding, const std::filesystem::path& output,
            const std::vector<std::filesystem::path>& pictures, double frames_per_second) {
  const Image first = read_image(pictures.front());
  Subprocess encoder =
      start_encoder(ffmpeg_command(first, frames_per_second, encoding, output.string()), StreamTo::kPipe);
  HangWatch watch(encoder);
  bool is_taken = true;
  for (const std::filesystem::path& picture : pictures) {
    const Image image = read_image(picture);
    if (image.width != first.width || image.height != first.height) {
      throw std::runtime_error("'" + picture.string() + "' has another size than '" +
                               pictures.front().string() + "'");
    }
    const std::vector<std::uint8_t> bytes = display_bytes(image);
    is_taken = encoder.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    if (!is_taken) break;
    watch.note_progress();
  }
  is_taken = encoder.end_input() && is_taken;
  watch.note_progress();
  watch.await_end();
  if (watch.has_ended_it()) fail(film, "ffmpeg hung, and was ended when the run was to end");
  if (const int code = encoder.wait().code; code != 0)
    fail(film, fmt::format("ffmpeg ended with code {}", code));
  if (!is_taken) fail(film, "ffmpeg ended before it had taken all frames");
  if (std::filesystem::file_size(output) == 0) fail(film, "ffmpeg has written nothing");
}

}  // namespace

void require_ffmpeg() {
  // Prints its version and ends, which shows that it can be run.
  constexpr std::chrono::seconds kPatience(5);
  Subprocess ffmpeg = start_encoder({"ffmpeg", "-loglevel", "quiet", "-version"}, StreamTo::kSame);
  const auto begin = std::chrono::steady_clock::now();
  while (!ffmpeg.has_ended()) {
    if (std::chrono::steady_clock::now() - begin > kPatience) {
      ffmpeg.end_within(0.5);
      throw std::runtime_error(
          fmt::format("--film needs ffmpeg, and that on the PATH hangs: 'ffmpeg -version' has not ended "
                      "within {} s",
                      kPatience.count()));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (const int code = ffmpeg.wait().code; code != 0) {
    throw std::runtime_error(fmt::format(
        "--film needs ffmpeg, and that on the PATH does not run: 'ffmpeg -version' ended with code {}",
        code));
  }
}

void write_film(const std::filesystem::path& film, const std::vector<std::filesystem::path>& pictures,
                double frames_per_second) {
  AtomicFile file(film);
  if (film.extension() == ".gif") {
    // Twice over the pictures: else ffmpeg would hold them all.
    AtomicFile colors(film.string() + ".palette");
    encode(film, palette(), colors.temporary(), pictures, frames_per_second);
    encode(film, animated_gif(colors.temporary().string()), file.temporary(), pictures, frames_per_second);
  } else {
    encode(film, video(film.extension() == ".mkv" ? "matroska" : "mp4"), file.temporary(), pictures,
           frames_per_second);
  }
  file.commit();
}

}  // namespace pprt
