#include "base/diagnostics.h"

#include <algorithm>
#include <utility>

namespace pprt {
namespace {

constexpr std::size_t kScreenWidth = 100;  // bytes of a source line shown around the caret

// The bytes of line `line` (from 1) without its line end; CR, LF and CR LF all end a line.
std::string_view line_of(std::string_view text, std::uint32_t line) {
  std::size_t begin = 0;
  for (std::uint32_t current = 1; current < line; ++current) {
    const std::size_t end = text.find_first_of("\r\n", begin);
    if (end == std::string_view::npos) return {};
    begin = end + 1;
    if (text[end] == '\r' && begin < text.size() && text[begin] == '\n') ++begin;
  }
  return text.substr(begin, std::min(text.find_first_of("\r\n", begin), text.size()) - begin);
}

// Control characters would break the caret's alignment or the terminal.
char printable(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x20 || byte == 0x7f ? ' ' : c;
}

void append_line_and_caret(std::string& out, std::string_view text, SourceLocation at) {
  const std::string_view line = line_of(text, at.line);
  const std::size_t caret = at.column > 0 ? at.column - 1 : 0;
  if (caret > line.size()) return;
  const std::size_t first =
      caret > kScreenWidth / 2 && line.size() > kScreenWidth ? caret - kScreenWidth / 2 : 0;
  const std::string_view shown = line.substr(first, kScreenWidth);
  out += "    ";
  std::transform(shown.begin(), shown.end(), std::back_inserter(out), printable);
  out += "\n    ";
  // Bytes that continue a UTF-8 character take no room on the screen.
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

std::string format(const Diagnostics& diagnostics, std::string_view file_name, std::string_view text) {
  std::vector<Diagnostic> ordered = diagnostics.kept();
  std::stable_sort(ordered.begin(), ordered.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return std::pair(a.location.line, a.location.column) < std::pair(b.location.line, b.location.column);
  });
  std::string out;
  for (const Diagnostic& d : ordered) {
    out += file_name;
    if (d.location.line > 0) {
      out += ':' + std::to_string(d.location.line) + ':' + std::to_string(d.location.column);
    }
    out += d.severity == Severity::kError ? ": error: " : ": warning: ";
    out += d.message + '\n';
    if (d.location.line > 0) append_line_and_caret(out, text, d.location);
  }
  const std::size_t left_out = diagnostics.error_count() + diagnostics.warning_count() - ordered.size();
  if (left_out > 0) {
    out += std::string(file_name) + ": " + std::to_string(left_out) + " further problems not shown\n";
  }
  return out;
}

}  // namespace pprt
