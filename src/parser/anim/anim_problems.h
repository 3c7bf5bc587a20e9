// Collects the problems of a text while it is read. Places are pointers into the text.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "base/diagnostics.h"
#include "parser/text/text_input.h"

namespace pprt::anim {

class Problems {
 public:
  explicit Problems(std::string_view text) : lines_(text) {}

  void error(const char* place, std::string message) {
    diagnostics_.error(location(place, diagnostics_.error_count()), std::move(message));
  }
  void warning(const char* place, std::string message) {
    diagnostics_.warning(location(place, diagnostics_.warning_count()), std::move(message));
  }

  SourceLocation location(const char* place) { return lines_.at(place); }
  const Diagnostics& diagnostics() const { return diagnostics_; }

 private:
  // Looks up a place only if its problem will be shown: places out of order cost a pass over the text each.
  SourceLocation location(const char* place, std::size_t count_before) {
    return count_before < Diagnostics::kMaxKept ? lines_.at(place) : SourceLocation{};
  }

  Diagnostics diagnostics_;
  LineCursor lines_;
};

}  // namespace pprt::anim
