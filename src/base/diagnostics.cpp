#include "base/diagnostics.h"

#include <algorithm>
#include <utility>

#include "base/printable.h"

namespace pprt {
namespace {

constexpr std::size_t kScreenWidth = 100;  // bytes of a source line shown around the caret

// Splits a text into lines, in one pass; lines must be asked for in rising order. CR, LF and CR LF each end a
// line.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text), length_(line_length()) {}

  // Returns line `number` (from 1) without its line end; empty after the last line.
  std::string_view at(std::uint32_t number) {
    for (; current_ < number; ++current_) {
      const bool pair = rest_.substr(length_).starts_with("\r\n");
      rest_.remove_prefix(std::min(length_ + (pair ? 2 : 1), rest_.size()));
      length_ = line_length();
    }
    return rest_.substr(0, length_);
  }

 private:
  std::size_t line_length() const {
    std::size_t length = 0;
    while (length < rest_.size() && rest_[length] != '\n' && rest_[length] != '\r') ++length;
    return length;
  }

  std::string_view rest_;  // from the beginning of the current line
  std::size_t length_;     // of the current line
  std::uint32_t current_ = 1;
};

// Replaces control characters by blanks: they would break the caret's alignment or be obeyed by the terminal.
// C1 controls, two bytes in UTF-8, become one blank.
std::string without_controls(std::string_view line) {
  std::string out;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const auto byte = static_cast<unsigned char>(line[i]);
    const auto after = static_cast<unsigned char>(i + 1 < line.size() ? line[i + 1] : 0);
    const bool c1 = byte == 0xc2 && after >= 0x80 && after < 0xa0;
    out += c1 || byte < 0x20 || byte == 0x7f ? ' ' : line[i];
    i += c1;
  }
  return out;
}

void append_line_and_caret(std::string& out, Lines& lines, SourceLocation at) {
  const std::string_view line = lines.at(at.line);
  const std::size_t caret = at.column > 0 ? at.column - 1 : 0;
  if (caret > line.size()) return;
  const std::size_t first =
      caret > kScreenWidth / 2 && line.size() > kScreenWidth ? caret - kScreenWidth / 2 : 0;
  const std::string_view shown = line.substr(first, kScreenWidth);
  out += "    " + without_controls(shown) + "\n    ";
  // Continuation bytes of a UTF-8 character take no column.
  for (std::size_t i = first; i < caret; ++i) {
    if ((static_cast<unsigned char>(line[i]) & 0xc0) != 0x80) out += ' ';
  }
  out += "^\n";
}

}  // namespace

void Diagnostics::error(SourceLocation at, std::string message) {
  add(Severity::kError, at, std::move(message), error_count_);
}

void Diagnostics::warning(SourceLocation at, std::string message) {
  add(Severity::kWarning, at, std::move(message), warning_count_);
}

void Diagnostics::add(Severity severity, SourceLocation at, std::string message, std::size_t& count) {
  if (count++ < kMaxKept) kept_.push_back({severity, at, std::move(message)});
}

std::string report_of(const Diagnostics& diagnostics, std::string_view file_name, std::string_view text) {
  std::vector<Diagnostic> ordered = diagnostics.kept();
  std::stable_sort(ordered.begin(), ordered.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return std::pair(a.location.line, a.location.column) < std::pair(b.location.line, b.location.column);
  });
  std::string out;
  Lines lines(text);
  const std::string name = printable(file_name);
  for (const Diagnostic& d : ordered) {
    out += name;
    if (d.location.line > 0) {
      out += ':' + std::to_string(d.location.line) + ':' + std::to_string(d.location.column);
    }
    out += d.severity == Severity::kError ? ": error: " : ": warning: ";
    out += d.message + '\n';
    if (d.location.line > 0) append_line_and_caret(out, lines, d.location);
  }
  const std::size_t left_out = diagnostics.error_count() + diagnostics.warning_count() - ordered.size();
  if (left_out > 0) {
    out += name + ": " + std::to_string(left_out) + " further problems not shown\n";
  }
  return out;
}

}  // namespace pprt
