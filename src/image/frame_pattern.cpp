#include "image/frame_pattern.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <system_error>

#include "base/diagnostics.h"

namespace pprt {
namespace {

constexpr std::size_t kMaxDigits = 9;  // enough for any int

class PatternReader {
 public:
  PatternReader(std::string_view text, std::string_view what) : what_(what), text_(text), rest_(text) {}

  FramePattern read() {
    while (!rest_.empty()) {
      if (rest_.starts_with("%%")) {
        rest_.remove_prefix(1);
        literal();
      } else if (rest_.front() == '%') {
        percent_field();
      } else if (rest_.front() == '#') {
        hash_field();
      } else {
        literal();
      }
    }
    return std::move(pattern_);
  }

  [[noreturn]] void fail(std::string_view problem) const {
    throw UsageError(fmt::format("{} '{}': {}", what_, text_, problem));
  }

 private:
  void literal() {
    (pattern_.digits ? pattern_.after : pattern_.before) += rest_.front();
    rest_.remove_prefix(1);
  }

  // "%d" or "%04d". "%4d" is refused, as it would pad with blanks.
  void percent_field() {
    const std::size_t end = rest_.find_first_not_of("0123456789", 1);
    const std::string_view width = rest_.substr(1, end == rest_.npos ? end : end - 1);
    const bool plain = width.empty();
    const bool padded = width.size() == 2 && width[0] == '0' && width[1] != '0';
    if (end == rest_.npos || rest_[end] != 'd' || !(plain || padded)) {
      fail("'%' must begin a frame number like %d or %04d, or be doubled: %%");
    }
    field(plain ? 1 : static_cast<std::size_t>(width[1] - '0'), end + 1);
  }

  void hash_field() {
    const std::size_t end = rest_.find_first_not_of('#');
    const std::size_t digits = end == rest_.npos ? rest_.size() : end;
    field(digits, digits);
  }

  void field(std::size_t digits, std::size_t length) {
    if (pattern_.digits) fail("only one field (%04d or ####) may stand in it");
    if (digits > kMaxDigits) fail(fmt::format("a frame number has at most {} digits", kMaxDigits));
    pattern_.digits = static_cast<int>(digits);
    rest_.remove_prefix(length);
  }

  std::string_view what_;
  std::string_view text_;
  std::string_view rest_;
  FramePattern pattern_;
};

}  // namespace

FramePattern parse_frame_pattern(std::string_view text, FrameCount count, std::string_view what) {
  PatternReader reader(text, what);
  FramePattern pattern = reader.read();
  const std::filesystem::path name = file_name(pattern, 0);
  if (name.extension() != ".exr" && name.extension() != ".png")
    reader.fail("the name must end in .exr or .png");
  pattern.text = text;
  if (count == FrameCount::kMany) require_field(pattern, what);
  return pattern;
}

void require_field(const FramePattern& pattern, std::string_view what) {
  if (pattern.digits) return;
  const std::filesystem::path path(pattern.text);
  throw UsageError(
      fmt::format("{} '{}': several frames need a field for the frame number, as in '{}'", what, pattern.text,
                  (path.parent_path() / path.stem()).string() + "_%04d" + path.extension().string()));
}

FramePattern beside(const FramePattern& pattern, std::string_view name) {
  FramePattern result = pattern;
  std::string& end = pattern.digits ? result.after : result.before;
  end.insert(end.rfind('.'), fmt::format(".{}", name));
  return result;
}

std::filesystem::path file_name(const FramePattern& pattern, int frame) {
  if (frame < 0) throw std::invalid_argument("a frame number is not negative");
  if (!pattern.digits) return pattern.before;
  return fmt::format("{}{:0{}}{}", pattern.before, frame, *pattern.digits, pattern.after);
}

// The field may be in a directory's name, so entries are matched up to the next separator.
std::vector<int> frames_present(const FramePattern& pattern) {
  std::vector<int> frames;
  if (!pattern.digits) return frames;
  const std::filesystem::path before(pattern.before);
  const std::string head = before.filename().string();
  const std::string tail = pattern.after.substr(0, pattern.after.find('/'));
  const std::filesystem::path directory = before.has_parent_path() ? before.parent_path() : ".";
  std::error_code unreadable;  // a directory that cannot be read has no frames
  for (const auto& entry : std::filesystem::directory_iterator(directory, unreadable)) {
    const std::string name = entry.path().filename().string();
    if (name.size() <= head.size() + tail.size() || !name.starts_with(head) || !name.ends_with(tail))
      continue;
    int frame = -1;
    const char* end = name.data() + name.size() - tail.size();
    const auto [rest, error] = std::from_chars(name.data() + head.size(), end, frame);
    if (error != std::errc() || rest != end || frame < 0) continue;
    const std::filesystem::path file = file_name(pattern, frame);  // with the pattern's number of digits
    if (file.string().starts_with(pattern.before + name.substr(head.size())) && std::filesystem::exists(file))
      frames.push_back(frame);
  }
  std::sort(frames.begin(), frames.end());
  return frames;
}

}  // namespace pprt
