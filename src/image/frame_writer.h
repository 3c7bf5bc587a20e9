// Writes numbered frames in the background, so that the frame loop does not wait for files.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
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

// A frame as it is submitted.
struct FrameToWrite {
  int frame = 0;
  Image image;  // all values finite: see replace_non_finite
  Metadata metadata;
  LayerMaker layers = {};  // become channels of each EXR, and pictures beside each PNG
};

struct WrittenFile {
  std::filesystem::path path;
  std::uint32_t crc32 = 0;  // of its content: image/checksum.h
};

// A frame whose files are complete.
struct WrittenFrame {
  int frame = 0;
  std::vector<WrittenFile> files;        // per output: the frame, then the pictures of its layers
  std::vector<std::string> layers = {};  // their names
};

// Settings of a FrameWriter.
struct FrameWriterOptions {
  bool overwrite = false;   // false: an existing file is an error
  bool is_hurried = false;  // frames have deadlines: their time counts before the size of the files

  // Bytes of pixels that may wait; submit() blocks above it. A 256x256 frame takes 0.75 MiB, so some 340 of
  // them may wait.
  std::size_t memory_bound = std::size_t{256} << 20;
};

// Returns whether an output stores layers as channels (EXR), not as pictures beside it (PNG).
bool holds_channels(const FramePattern& output);

// Writes frames in the order in which they are submitted. submit, take_finished and error may be called from
// any thread.
//
// A thread of low priority does the work, a little in every frame's time. Work that is put off is done at a
// bad moment. When an eighth of the memory bound waits it is too slow, and a thread of usual priority takes
// over. At the change, one frame may be finished after its successor.
//
// The first error is kept until it is asked for. Later frames are still tried, as the error may concern one
// frame only.
class FrameWriter {
 public:
  explicit FrameWriter(std::vector<FramePattern> outputs, FrameWriterOptions options = {});
  FrameWriter(const FrameWriter&) = delete;
  FrameWriter& operator=(const FrameWriter&) = delete;

  // Writes what still waits. Errors are lost, so call finish() first.
  ~FrameWriter();

  // Queues a frame and returns at once. Blocks only while the memory bound would be exceeded; a single frame
  // is always accepted. Throws std::logic_error after finish().
  void submit(FrameToWrite frame);

  // Returns the frames whose files are complete under their names, each once.
  std::vector<WrittenFrame> take_finished();

  // Returns the first error's message, if a frame has failed so far.
  std::optional<std::string> error() const;

  // Waits until everything is written, then throws the first error, if any.
  void finish();

 private:
  enum class Priority : std::uint8_t { kLow, kUsual };
  void run(Priority priority);
  WrittenFrame write(const FrameToWrite& frame) const;
  void stop();

  const std::vector<FramePattern> outputs_;
  const FrameWriterOptions options_;

  mutable std::mutex mutex_;  // guards all members below except the threads
  std::condition_variable work_;
  std::condition_variable room_;
  std::deque<FrameToWrite> waiting_;
  std::size_t bytes_ = 0;   // bytes of pixels, waiting and being written
  bool is_behind_ = false;  // the low-priority thread has handed over
  bool stopping_ = false;
  std::vector<WrittenFrame> finished_;
  std::exception_ptr first_error_;
  std::string first_error_text_;

  // Declared last, because they use all members above. A thread inherits its priority and may not raise it,
  // so the caller of submit starts the one of usual priority.
  std::thread at_low_priority_;
  std::thread at_usual_priority_;
};

}  // namespace pprt
