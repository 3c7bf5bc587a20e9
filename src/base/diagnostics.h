// Problems found in a user's text, each with its place. They are collected first and reported together.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/source_location.h"

namespace pprt {

enum class Severity { kWarning, kError };

// One problem: its place and what is wrong.
struct Diagnostic {
  Severity severity = Severity::kError;
  SourceLocation location;
  std::string message;
};

// All problems of one text. Keeps at most kMaxKept of each severity and counts the rest, so that a hostile
// file cannot exhaust memory.
class Diagnostics {
 public:
  static constexpr std::size_t kMaxKept = 50;

  // Each adds a problem. An error makes the text unusable, a warning does not.
  void error(SourceLocation at, std::string message);
  void warning(SourceLocation at, std::string message);

  bool has_errors() const { return error_count_ > 0; }
  bool empty() const { return error_count_ + warning_count_ == 0; }
  std::size_t error_count() const { return error_count_; }
  std::size_t warning_count() const { return warning_count_; }
  // Returns the problems that are kept, in the order in which they were added.
  const std::vector<Diagnostic>& kept() const { return kept_; }

 private:
  void add(Severity severity, SourceLocation at, std::string message, std::size_t& count);

  std::vector<Diagnostic> kept_;
  std::size_t error_count_ = 0;
  std::size_t warning_count_ = 0;
};

// Formats one "file:line:column: error: message" per problem, ordered by place. Each is followed by the line
// of the text and a caret under the column; a long line is cut around the caret. Ends with a newline.
std::string report_of(const Diagnostics& diagnostics, std::string_view file_name, std::string_view text);

// A scene or script that cannot be used (exit code 3). what() is the formatted report without a trailing
// newline.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A command line that makes no sense (exit code 2).
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace pprt
