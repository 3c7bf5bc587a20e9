// Buffered text output for files with many numbers. Formatting through the stream would cost ten times as
// much.
#pragma once

#include <array>
#include <cstddef>
#include <iosfwd>
#include <string_view>

namespace pprt {

// How doubles are written.
enum class NumberFormat {
  kShortest,   // the fewest digits that read back as the same double
  kSixDigits,  // printf's %g, as the SPD programs write
};

// Writes text and numbers to a stream. Numbers must be finite; their form does not depend on the locale. A
// failing stream is left failed, as by operator<<.
class TextOutput {
 public:
  explicit TextOutput(std::ostream& out, NumberFormat format = NumberFormat::kShortest)
      : out_(out), format_(format) {}

  void text(std::string_view s);  // must be shorter than the buffer
  void number(double v);
  void number(std::size_t v);

  // Writes what is buffered. Must be called at the end: the destructor does not.
  void flush();

 private:
  void room(std::size_t size) {
    if (buffer_.size() - used_ < size) flush();
  }

  std::ostream& out_;
  NumberFormat format_;
  std::array<char, 1 << 16> buffer_;
  std::size_t used_ = 0;
};

}  // namespace pprt
