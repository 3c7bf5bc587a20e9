// Separates the messages of mpirun on standard error from those of the ranks.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace pprt {

// Filters standard error. Open MPI puts its own messages between lines of dashes. Those that only repeat a
// rank's exit code are dropped. One that names a rank ended by a signal is kept for lost_rank(). All else is
// passed on as it comes.
class MpirunMessages {
 public:
  // Takes what was read next and returns what is to be shown. Holds back only what may belong to a message of
  // mpirun.
  std::string take(std::string_view text);

  // Returns what is still held back, when nothing more comes.
  std::string finish();

  // "rank 2 on host was ended by signal 9 (Killed)", once mpirun has said so.
  const std::optional<std::string>& lost_rank() const { return lost_rank_; }

 private:
  std::string end_line();
  std::string end_message();

  std::string line_;            // held back so far
  bool in_shown_line_ = false;  // its beginning has been handed on
  std::string message_;         // of mpirun, from its first line of dashes on
  std::optional<std::string> lost_rank_;
};

}  // namespace pprt
