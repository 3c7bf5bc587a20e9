#include "parser/text/text_input.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <utility>

#include "base/diagnostics.h"
#include "base/printable.h"

namespace pprt {
namespace {

constexpr std::size_t kReadAtOnce = std::size_t{1} << 20;  // bytes
constexpr std::size_t kQuotedLength = 40;                  // bytes of a token shown in a message

[[noreturn]] void throw_unreadable(const std::string& path, const std::string& reason) {
  throw InputError("cannot read '" + printable(path) + "': " + reason);
}

// An open file, closed at the end of its scope unless it is standard input.
class InputFile {
 public:
  explicit InputFile(const std::string& path)
      : path_(path), descriptor_(path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (descriptor_ < 0) throw_unreadable(path_, std::strerror(errno));
  }
  // Returns the number of bytes of a regular file; 0 for a pipe and the like.
  std::size_t size() const {
    struct stat status = {};
    if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) return 0;
    return static_cast<std::size_t>(status.st_size);
  }

  ~InputFile() {
    if (descriptor_ != STDIN_FILENO) ::close(descriptor_);
  }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  // Returns the number of bytes read, 0 at the end of the file.
  std::size_t read(char* into, std::size_t room) const {
    for (;;) {
      const ssize_t got = ::read(descriptor_, into, room);
      if (got >= 0) return static_cast<std::size_t>(got);
      if (errno != EINTR) throw_unreadable(path_, std::strerror(errno));
    }
  }

 private:
  const std::string& path_;
  int descriptor_;
};

// Joins the chunks and releases each, so that the text is held once. `total`: bytes of all.
std::string joined(std::deque<std::string> chunks, std::size_t total) {
  if (chunks.size() == 1) return std::move(chunks.front());
  std::string text;
  text.reserve(total);
  for (; !chunks.empty(); chunks.pop_front()) text += chunks.front();
  return text;
}

}  // namespace

std::string read_text(const std::string& path, std::size_t max_bytes) {
  const InputFile file(path);
  const auto require_fit = [&](std::size_t size) {
    if (size > max_bytes)
      throw_unreadable(path, "larger than the limit of " + std::to_string(max_bytes) + " bytes");
  };
  const std::size_t known = file.size();
  require_fit(known);
  std::deque<std::string> chunks;
  std::size_t total = 0;
  for (std::size_t room = std::max(known + 1, kReadAtOnce);; room = kReadAtOnce) {  // 1: to see the end
    std::string& chunk = chunks.emplace_back(room, '\0');
    for (std::size_t filled = 0; filled < room;) {
      const std::size_t got = file.read(chunk.data() + filled, room - filled);
      if (got == 0) {
        chunk.resize(filled);
        return joined(std::move(chunks), total);
      }
      filled += got;
      total += got;
      require_fit(total);
    }
  }
}

std::string quoted(std::string_view token) {
  return "'" + printable(token.substr(0, kQuotedLength)) + (token.size() > kQuotedLength ? "...'" : "'");
}

bool underflows(std::string_view number) {
  // Computes the power of ten of the first digit that is not 0, from its distance to the point and the
  // exponent.
  const std::size_t exponent_mark = std::min(number.find_first_of("eE"), number.size());
  const std::string_view digits = number.substr(0, exponent_mark);
  const std::size_t point = std::min(digits.find('.'), digits.size());
  const std::size_t first = digits.find_first_of("123456789");
  if (first == std::string_view::npos) return true;
  const auto place = static_cast<double>(point) - static_cast<double>(first);
  const bool negative = exponent_mark + 1 < number.size() && number[exponent_mark + 1] == '-';
  double exponent = 0;
  for (const char c : number.substr(exponent_mark)) {
    if (c >= '0' && c <= '9') exponent = std::min(10 * exponent + (c - '0'), 1e15);
  }
  return place + (negative ? -exponent : exponent) < 0;
}

}  // namespace pprt
