#include "cli/mpirun_messages.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <regex>
#include <utility>

namespace pprt {
namespace {

constexpr std::string_view kForwarding = "mpirun: Forwarding signal";

// Open MPI's lines of dashes have 74 of them.
bool is_rule(const std::string& line) {
  return line.size() > 60 && line.find_first_not_of("-\n") == std::string::npos;
}

// Whether a line that begins like this may become one of dashes, or tell that a signal was forwarded.
bool may_be_mpiruns(const std::string& line) {
  return line.find_first_not_of('-') == std::string::npos ||
         std::string_view(line).substr(0, kForwarding.size()) == kForwarding.substr(0, line.size());
}

// Whether a message says only that ranks had an exit code, which the ranks have explained themselves.
bool repeats_exit_code(const std::string& message) {
  constexpr std::array<std::string_view, 3> kSuch = {
      "Primary job  terminated normally", "processes exited with non-zero status", "MPI_ABORT was invoked"};
  return std::any_of(kSuch.begin(), kSuch.end(),
                     [&](std::string_view such) { return message.find(such) != std::string::npos; });
}

std::optional<std::string> lost_rank_in(const std::string& message) {
  static const std::regex kNoticed(
      R"(process rank (\d+) with PID \d+ on node (\S+) exited on\s+signal (\d+)( \([^)]*\))?)");
  std::smatch found;
  if (!std::regex_search(message, found, kNoticed)) return std::nullopt;
  return fmt::format("rank {} on {} was ended by signal {}{}", found[1].str(), found[2].str(), found[3].str(),
                     found[4].str());
}

}  // namespace

std::string MpirunMessages::take(std::string_view text) {
  std::string shown;
  for (const char c : text) {
    if (in_shown_line_) {
      shown += c;
      in_shown_line_ = c != '\n';
      continue;
    }
    line_ += c;
    if (c == '\n') {
      shown += end_line();
    } else if (message_.empty() && !may_be_mpiruns(line_)) {
      shown += std::exchange(line_, {});
      in_shown_line_ = true;
    }
  }
  return shown;
}

std::string MpirunMessages::end_line() {
  std::string line = std::exchange(line_, {});
  const bool rule = is_rule(line);
  if (message_.empty() && !rule) return line.starts_with(kForwarding) ? std::string() : line;
  const bool closes = rule && !message_.empty();
  message_ += line;
  return closes ? end_message() : std::string();
}

std::string MpirunMessages::end_message() {
  std::string message = std::exchange(message_, {});
  if (repeats_exit_code(message)) return {};
  if (std::optional<std::string> lost = lost_rank_in(message)) {
    if (!lost_rank_) lost_rank_ = std::move(lost);
    return {};
  }
  return message;
}

std::string MpirunMessages::finish() {
  return std::exchange(message_, {}) + std::exchange(line_, {});
}

}  // namespace pprt
