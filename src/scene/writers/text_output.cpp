#include "scene/writers/text_output.h"

#include <charconv>
#include <cstring>
#include <ostream>

namespace pprt {
namespace {

// "-2.2250738585072014e-308" has 24 bytes, the largest whole number 20.
constexpr std::size_t kLongestNumber = 32;

}  // namespace

void TextOutput::text(std::string_view s) {
  room(s.size());
  std::memcpy(buffer_.data() + used_, s.data(), s.size());
  used_ += s.size();
}

void TextOutput::number(double v) {
  room(kLongestNumber);
  char* const begin = buffer_.data() + used_;
  char* const limit = buffer_.data() + buffer_.size();
  const std::to_chars_result result = format_ == NumberFormat::kShortest
                                          ? std::to_chars(begin, limit, v)
                                          : std::to_chars(begin, limit, v, std::chars_format::general, 6);
  used_ = static_cast<std::size_t>(result.ptr - buffer_.data());
}

void TextOutput::number(std::size_t v) {
  room(kLongestNumber);
  char* const limit = buffer_.data() + buffer_.size();
  used_ = static_cast<std::size_t>(std::to_chars(buffer_.data() + used_, limit, v).ptr - buffer_.data());
}

void TextOutput::flush() {
  out_.write(buffer_.data(), static_cast<std::streamsize>(used_));
  used_ = 0;
}

}  // namespace pprt
