// Separates the messages of mpirun on standard error from those of the ranks.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/process/rank_news.h"

namespace pprt {

// Filters standard error. News of ranks are taken out of it. Open MPI puts its own messages between lines of
// dashes. Those that only repeat a rank's exit code are dropped. One that names a rank ended by a signal, or
// a host out of reach, is kept for loss(). All else is passed on as it comes.
class MpirunMessages {
 public:
  // Takes what was read next and returns what is to be shown. Holds back only what may belong to a message of
  // mpirun.
  std::string take(std::string_view text);

  // Returns what is still held back, when nothing more comes.
  std::string finish();

  // "rank 2 on host was ended by signal 9 (Killed)" or "host alpha does not answer", once mpirun has said so.
  const std::optional<std::string>& loss() const { return loss_; }

  // Whether loss() is that of a host, for which mpirun may wait in vain.
  bool has_lost_host() const { return has_lost_host_; }

  // Removes and returns the news that have come.
  std::vector<RankNews> take_news();

 private:
  void take_news(char c);
  std::string take_line();
  std::string end_message();

  std::string line_;            // held back so far
  bool in_shown_line_ = false;  // its beginning has been handed on
  std::string message_;         // of mpirun, from its first line of dashes on
  bool is_in_news_ = false;     // news have begun, and not ended
  std::string news_text_;       // of these
  std::vector<RankNews> news_;  // not taken yet
  // All processes have met: mpirun's complaint that it cannot start a daemon only repeats the loss of a host.
  bool have_met_ = false;
  std::optional<std::string> loss_;
  bool has_lost_host_ = false;
};

}  // namespace pprt
