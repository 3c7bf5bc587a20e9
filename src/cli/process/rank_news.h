// What ranks, and the guards beside them, tell run_under_mpirun() on standard error.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace pprt {

enum class RankEvent : std::uint8_t {
  kLives,      // its guard is there; the next such news come after this many seconds, or never (0)
  kMet,        // rank 0: all processes have found each other
  kListens,    // rank 0: a signal ends the run after the frame at hand
  kSpares,     // rank 0: from now on frames do not wait for other ranks
  kEnded,      // rank 0: the run has ended with this exit code
  kKilled,     // by this signal
  kStopped,    // by this signal
  kContinued,  // after that
  kLeft,       // has ended by itself
};

struct RankNews {
  RankEvent event = RankEvent::kLives;
  int rank = 0;
  int number = 0;         // exit code, signal or seconds, where the event has one
  std::string host = {};  // that the rank runs on

  friend bool operator==(const RankNews&, const RankNews&) = default;
};

// News stand between these two characters. They may come in the middle of another line: what people read
// never has the first.
inline constexpr char kNewsBegin = '\x1e', kNewsEnd = '\n';

// Returns the news as they are written, with both characters.
std::string to_text(const RankNews& news);

// Reads what stands between the two characters; empty: no news.
std::optional<RankNews> news_in(std::string_view text);

// "rank 2 on alpha"
std::string rank_name(int rank, std::string_view host);

// "signal 9 (Killed)"
std::string signal_name(int signal);

}  // namespace pprt
