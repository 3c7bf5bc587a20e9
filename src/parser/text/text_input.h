// Text input shared by the parsers: whole files, places in a text, numbers.
#pragma once

#include <charconv>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

#include "base/source_location.h"

namespace pprt {

// Returns a whole file as bytes; "-" is standard input. Throws InputError when it cannot be read ("cannot
// read 'x': No such file or directory") or has more than `max_bytes`, of which no more are read. The size of
// a regular file is judged before.
std::string read_text(const std::string& path, std::size_t max_bytes);

// Quotes a token for a message: control characters become escapes, long tokens are cut.
std::string quoted(std::string_view token);

// Finds line and column of places in a text. A lookup scans only the bytes since the place before (or the
// lines back to it), so a whole pass is linear. CR, LF and CR LF each end a line.
class LineCursor {
 public:
  explicit LineCursor(std::string_view text)
      : text_(text),
        line_begin_(text.data()),
        searched_(text.data()),
        has_cr_(text.find('\r') != std::string_view::npos) {}

  SourceLocation at(const char* place) {
    while (place < line_begin_) to_previous_line();
    while (const char* next = next_line(place)) {
      line_begin_ = searched_ = next;
      ++line_;
    }
    if (searched_ < place) searched_ = place;
    return {line_, static_cast<std::uint32_t>(place - line_begin_) + 1};
  }

 private:
  // Returns the beginning of the next line if it is not after `place`, else nullptr.
  const char* next_line(const char* place) const {
    if (searched_ >= place) return nullptr;
    if (!has_cr_) {
      const void* lf = std::memchr(searched_, '\n', static_cast<std::size_t>(place - searched_));
      return lf ? static_cast<const char*>(lf) + 1 : nullptr;
    }
    for (const char* p = searched_; p < place; ++p) {
      if (*p == '\n') return p + 1;
      if (*p != '\r') continue;
      const bool pair = p + 1 < text_.data() + text_.size() && p[1] == '\n';
      return p + (pair ? 2 : 1) <= place ? p + (pair ? 2 : 1) : nullptr;
    }
    return nullptr;
  }

  void to_previous_line() {
    const char* p = line_begin_ - 1;  // on the end of the line before
    if (*p == '\n' && p > text_.data() && p[-1] == '\r') --p;
    while (p > text_.data() && p[-1] != '\n' && p[-1] != '\r') --p;
    line_begin_ = searched_ = p;
    --line_;
  }

  std::string_view text_;
  const char* line_begin_;
  const char* searched_;  // no line ends between line_begin_ and here
  std::uint32_t line_ = 1;
  bool has_cr_;
};

// Largest magnitude of a number. Products of three such numbers stay finite.
constexpr double kLargestNumber = 1e100;

// Returns whether an unsigned number that does not fit a double is too small, not too large.
bool underflows(std::string_view number);

// Reads a decimal number at `begin`, independent of the locale: optional sign, digits, point (".5", "5."),
// exponent. "nan", "inf" and hexadecimal are not numbers; one too small for a double is 0. Returns its end,
// or nullptr when there is no number or one beyond kLargestNumber.
inline const char* scan_number(const char* begin, const char* end, double& value) {
  const char* p = begin;
  if (p != end && (*p == '+' || *p == '-')) ++p;
  if (p == end || !((*p >= '0' && *p <= '9') || *p == '.')) return nullptr;
  const auto [stop, problem] = std::from_chars(*begin == '+' ? p : begin, end, value);
  if (problem == std::errc::result_out_of_range && underflows({p, stop})) {
    value = 0;
    return stop;
  }
  if (problem != std::errc{}) return nullptr;
  return value <= kLargestNumber && value >= -kLargestNumber ? stop : nullptr;
}

}  // namespace pprt
