#include "cli/options/number_pair.h"

#include <charconv>
#include <optional>
#include <utility>

#include "base/diagnostics.h"

namespace pprt {
namespace {

// Parses two integers with one of `separators` between them and nothing else.
std::optional<std::pair<int, int>> parse_pair(const std::string& text, const std::string& separators) {
  const std::size_t at = text.find_first_of(separators);
  if (at == std::string::npos) return std::nullopt;
  int a = 0, b = 0;
  const char* begin = text.data();
  const char* end = begin + text.size();
  const auto first = std::from_chars(begin, begin + at, a);
  const auto second = std::from_chars(begin + at + 1, end, b);
  if (first.ec != std::errc() || first.ptr != begin + at || second.ec != std::errc() || second.ptr != end) {
    return std::nullopt;
  }
  return std::pair(a, b);
}

}  // namespace

ImageSize parse_image_size(const std::string& text) {
  const auto pair = parse_pair(text, "xX");
  const auto fits = [](int side) { return side >= 1 && side <= kLongestSide; };
  if (!pair || !fits(pair->first) || !fits(pair->second)) {
    throw UsageError("--size " + text + ": want WIDTHxHEIGHT in pixels, each from 1 to " +
                     std::to_string(kLongestSide) + ", such as 256x256");
  }
  return {pair->first, pair->second};
}

FrameRange parse_frame_range(const std::string& text) {
  const auto pair = parse_pair(text.find('-') == std::string::npos ? text + "-" + text : text, "-");
  if (!pair || pair->first < 1 || pair->second < pair->first) {
    throw UsageError("--frames " + text + ": want FIRST-LAST, counted from 1, such as 1-40");
  }
  return {pair->first, pair->second};
}

std::string to_string(const FrameRange& range) {
  const std::string first = std::to_string(range.first);
  return range.last == range.first ? first : first + "-" + std::to_string(range.last);
}

}  // namespace pprt
