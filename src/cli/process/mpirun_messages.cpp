#include "cli/process/mpirun_messages.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <regex>
#include <utility>

namespace pprt {
namespace {

constexpr std::string_view kForwarding = "mpirun: Forwarding signal";
// Open MPI says this with --enable-recovery for each rank that was killed.
constexpr std::string_view kEventError = "] PMIX ERROR: BAD-PARAM in file ";
// And this where its text about MPI_Abort arrives torn: MPI_Abort ends without waiting until it is sent.
constexpr std::string_view kTornText = "] ORTE_ERROR_LOG: Data unpack ";
constexpr std::string_view kTextReader = "/orte/util/show_help.c ";

// And this where a process that enters another host has begun before its group was set: the process sets it,
// too.
constexpr std::string_view kGroupWarning = "] plm:rsh: Warning: setpgid(";

// Open MPI's lines of dashes have 74 of them.
bool is_rule(const std::string& line) {
  return line.size() > 60 && line.find_first_not_of("-\n") == std::string::npos;
}

// Whether a line that begins like this may begin with `words`.
bool starts_like(std::string_view line, std::string_view words) {
  return line.substr(0, words.size()) == words.substr(0, line.size());
}

// Whether a line that begins like this may be one that is not shown.
bool may_be_mpiruns(const std::string& line) {
  return line.find_first_not_of('-') == std::string::npos || starts_like(line, kForwarding) ||
         line.starts_with('[');
}

bool is_dropped(const std::string& line) {
  const auto has = [&](std::string_view words) { return line.find(words) != std::string::npos; };
  return line.starts_with(kForwarding) || (line.starts_with('[') && (has(kEventError) || has(kGroupWarning) ||
                                                                     (has(kTornText) && has(kTextReader))));
}

// Whether a message says only that ranks had an exit code, which the ranks have explained themselves.
bool repeats_exit_code(const std::string& message) {
  constexpr std::array<std::string_view, 3> kSuch = {
      "Primary job  terminated normally", "processes exited with non-zero status", "MPI_ABORT was invoked"};
  return std::any_of(kSuch.begin(), kSuch.end(),
                     [&](std::string_view such) { return message.find(such) != std::string::npos; });
}

bool complains_of_start(const std::string& message) {
  return message.find("unable to reliably start one or more daemons") != std::string::npos;
}

std::optional<std::string> killed_rank_in(const std::string& message) {
  static const std::regex kNoticed(
      R"(process rank (\d+) with PID \d+ on node (\S+) exited on\s+signal (\d+)( \([^)]*\))?)");
  std::smatch found;
  if (!std::regex_search(message, found, kNoticed)) return std::nullopt;
  return fmt::format("rank {} on {} was ended by signal {}{}", found[1].str(), found[2].str(), found[3].str(),
                     found[4].str());
}

std::optional<std::string> lost_host_in(const std::string& message) {
  static const std::regex kLost(
      R"(lost communication with a remote daemon[^]*Remote daemon:.* on node (\S+))");
  std::smatch found;
  if (!std::regex_search(message, found, kLost)) return std::nullopt;
  return fmt::format("host {} does not answer", found[1].str());
}

}  // namespace

std::string MpirunMessages::take(std::string_view text) {
  std::string shown;
  for (const char c : text) {
    if (is_in_news_ || c == kNewsBegin) {
      take_news(c);
      continue;
    }
    if (in_shown_line_) {
      shown += c;
      in_shown_line_ = c != '\n';
      continue;
    }
    line_ += c;
    if (c == '\n') {
      shown += take_line();
    } else if (message_.empty() && !may_be_mpiruns(line_)) {
      shown += std::exchange(line_, {});
      in_shown_line_ = true;
    }
  }
  return shown;
}

void MpirunMessages::take_news(char c) {
  is_in_news_ = c != kNewsEnd;
  if (c == kNewsBegin) news_text_.clear();
  if (is_in_news_) {
    if (c != kNewsBegin) news_text_ += c;
    return;
  }
  const std::optional<RankNews> news = news_in(news_text_);
  if (!news) return;
  have_met_ = have_met_ || news->event == RankEvent::kMet;
  news_.push_back(*news);
}

std::vector<RankNews> MpirunMessages::take_news() {
  return std::exchange(news_, {});
}

std::string MpirunMessages::take_line() {
  std::string line = std::exchange(line_, {});
  const bool rule = is_rule(line);
  if (message_.empty() && !rule) return is_dropped(line) ? std::string() : line;
  const bool closes = rule && !message_.empty();
  message_ += line;
  return closes ? end_message() : std::string();
}

std::string MpirunMessages::end_message() {
  std::string message = std::exchange(message_, {});
  if (repeats_exit_code(message) || (have_met_ && complains_of_start(message))) return {};
  const std::optional<std::string> host = lost_host_in(message);
  const std::optional<std::string> loss = host ? host : killed_rank_in(message);
  if (!loss) return message;
  if (!loss_) loss_ = loss;
  has_lost_host_ = has_lost_host_ || host;
  return {};
}

std::string MpirunMessages::finish() {
  return std::exchange(message_, {}) + std::exchange(line_, {});
}

}  // namespace pprt
