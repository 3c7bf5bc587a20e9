#include "image/frame_writer.h"

#include <fmt/core.h>

#include <stdexcept>
#include <utility>

#include "base/system/thread_priority.h"

namespace pprt {
namespace {

std::size_t pixel_bytes(const FrameToWrite& frame) {
  return frame.image.pixels.size() * sizeof(Color) + frame.layers.bytes;
}

}  // namespace

bool holds_channels(const FramePattern& output) {
  return file_name(output, 0).extension() == ".exr";
}

FrameWriter::FrameWriter(std::vector<FramePattern> outputs, FrameWriterOptions options)
    : outputs_(std::move(outputs)), options_(options), at_low_priority_([this] { run(Priority::kLow); }) {}

FrameWriter::~FrameWriter() {
  stop();
}

void FrameWriter::submit(FrameToWrite frame) {
  const std::size_t size = pixel_bytes(frame);
  {
    std::unique_lock lock(mutex_);
    if (stopping_) throw std::logic_error("a frame was submitted after the last one");
    room_.wait(lock, [&] { return bytes_ == 0 || bytes_ + size <= options_.memory_bound; });
    bytes_ += size;
    waiting_.push_back(std::move(frame));
    if (!is_behind_ && bytes_ > options_.memory_bound / 8) {
      is_behind_ = true;
      at_usual_priority_ = std::thread([this] { run(Priority::kUsual); });
    }
  }
  work_.notify_all();
}

std::vector<WrittenFrame> FrameWriter::take_finished() {
  const std::lock_guard lock(mutex_);
  return std::exchange(finished_, {});
}

std::optional<std::string> FrameWriter::error() const {
  const std::lock_guard lock(mutex_);
  if (!first_error_) return std::nullopt;
  return first_error_text_;
}

void FrameWriter::finish() {
  stop();
  if (first_error_) std::rethrow_exception(first_error_);
}

void FrameWriter::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  work_.notify_all();
  for (std::thread* thread : {&at_low_priority_, &at_usual_priority_}) {
    if (thread->joinable()) thread->join();
  }
}

void FrameWriter::run(Priority priority) {
  if (priority == Priority::kLow) take_low_priority();
  std::unique_lock lock(mutex_);
  const auto is_replaced = [&] { return priority == Priority::kLow && is_behind_; };
  for (;;) {
    work_.wait(lock, [&] { return stopping_ || !waiting_.empty() || is_replaced(); });
    if (waiting_.empty() || is_replaced()) return;
    FrameToWrite frame = std::move(waiting_.front());
    waiting_.pop_front();

    lock.unlock();
    WrittenFrame written;
    std::exception_ptr error;
    std::string error_text;
    try {
      written = write(frame);
    } catch (const std::exception& e) {
      error = std::current_exception();
      error_text = e.what();
    }
    lock.lock();

    bytes_ -= pixel_bytes(frame);
    if (!error) {
      finished_.push_back(std::move(written));
    } else if (!first_error_) {
      first_error_ = error;
      first_error_text_ = std::move(error_text);
    }
    room_.notify_one();
  }
}

WrittenFrame FrameWriter::write(const FrameToWrite& frame) const {
  WrittenFrame written{frame.frame, {}, frame.layers.names};
  const auto write_to = [&](const FramePattern& pattern, const Image& image,
                            const std::vector<Channel>& channels, PictureKind kind) {
    std::filesystem::path file = file_name(pattern, frame.frame);
    if (!options_.overwrite && std::filesystem::exists(file)) {
      throw std::runtime_error(fmt::format("cannot write '{}': the file is there already", file.string()));
    }
    const std::uint32_t crc32 = write_image(file, image, frame.metadata, channels, kind);
    written.files.push_back({std::move(file), crc32});
  };
  const std::vector<std::string>& layers = frame.layers.names;
  for (const FramePattern& output : outputs_) {
    const bool has_channels = !layers.empty() && holds_channels(output);
    write_to(output, frame.image, has_channels ? frame.layers.channels() : std::vector<Channel>(),
             options_.is_hurried ? PictureKind::kHurried : PictureKind::kRendered);
    for (std::size_t i = 0; i < layers.size() && !has_channels; ++i) {
      write_to(beside(output, layers[i]), frame.layers.picture(i, frame.image), {}, PictureKind::kDrawn);
    }
  }
  return written;
}

}  // namespace pprt
