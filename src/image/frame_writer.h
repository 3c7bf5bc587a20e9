// Numbered frames are written beside the frame loop, by a thread of their own.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "image/frame_pattern.h"
#include "image/image.h"
#include "image/image_io.h"
#include "image/image_layers.h"

namespace pprt {

struct FrameToWrite {
  int frame = 0;
  Image image;  // has passed the gate: replace_non_finite
  Facts facts;
  LayerMaker layers = {};  // channels of every EXR, pictures beside every PNG
};

struct WrittenFrame {
  int frame = 0;
  std::vector<std::filesystem::path> files;  // per output the frame, then its layers' pictures
  std::vector<std::string> layers = {};      // of its channels and of those pictures
};

struct FrameWriterOptions {
  bool overwrite = false;  // false: a file that is there already is an error

  // Bytes of pixels that may wait. A frame loop that is never slower than its writer never meets the bound: a
  // 256x256 frame takes 0.75 MiB, so that some 340 of them may wait.
  std::size_t memory_bound = std::size_t{256} << 20;
};

// Whether an output holds layers in itself, as channels, rather than beside it.
bool holds_channels(const FramePattern& output);

// Writes frames in the order in which they are submitted, beside the frame loop: in a thread of the lowest
// priority until an eighth of the memory bound waits, then, as that is not enough, in one of the usual
// priority (the frame under way when they change may be whole after the next). The first error is kept
// until it is asked for; a frame that cannot be written does not keep later ones from being tried, as its
// reason may be its own. submit, take_finished and error may be called from any thread.
class FrameWriter {
 public:
  explicit FrameWriter(std::vector<FramePattern> outputs, FrameWriterOptions options = {});
  FrameWriter(const FrameWriter&) = delete;
  FrameWriter& operator=(const FrameWriter&) = delete;

  // Writes what still waits; errors that nobody asked for are lost, so call finish() first.
  ~FrameWriter();

  // Hands a frame over and returns at once; blocks only while the memory bound would be passed (one frame is
  // always taken). Throws std::logic_error after finish().
  void submit(FrameToWrite frame);

  // Frames whose files are all whole under their names, each told once.
  std::vector<WrittenFrame> take_finished();

  // What the first failed frame failed of, if any did so far.
  std::optional<std::string> error() const;

  // Waits until nothing waits; then throws the first error, if there was one.
  void finish();

 private:
  enum class Priority : std::uint8_t { kLowest, kUsual };
  void run(Priority priority);
  WrittenFrame write(const FrameToWrite& frame) const;
  void stop();

  const std::vector<FramePattern> outputs_;
  const FrameWriterOptions options_;

  mutable std::mutex mutex_;  // guards what follows, but the thread
  std::condition_variable work_;
  std::condition_variable room_;
  std::deque<FrameToWrite> waiting_;
  std::size_t bytes_ = 0;   // of pixels, waiting and being written
  bool is_behind_ = false;  // the thread of the lowest priority has left the rest to the other
  bool stopping_ = false;
  std::vector<WrittenFrame> finished_;
  std::exception_ptr first_error_;
  std::string first_error_text_;

  // Last: they use all of the above. A thread inherits its priority, and may not raise it: that of the usual
  // one is begun by whoever submits.
  std::thread at_lowest_priority_;
  std::thread at_usual_priority_;
};

}  // namespace pprt
