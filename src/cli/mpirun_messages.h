// What mpirun says on standard error, between what the ranks say there.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace pprt {

// Open MPI frames its own messages by rules of dashes. Those that only repeat a rank's exit code are dropped,
// one that names a rank ended by a signal is kept apart, and all else is handed on as it comes.
class MpirunMessages {
 public:
  // Takes what was read next; returns what is to be shown. Only what may belong to a frame is held back.
  std::string take(std::string_view text);

  // Nothing more comes: what is still held back.
  std::string finish();

  // "rank 2 on host was ended by signal 9 (Killed)", once that has been said.
  const std::optional<std::string>& lost_rank() const { return lost_rank_; }

 private:
  std::string end_line();
  std::string end_message();

  std::string line_;            // held back so far
  bool in_shown_line_ = false;  // its beginning has been handed on
  std::string message_;         // in a frame: from its first rule on
  std::optional<std::string> lost_rank_;
};

}  // namespace pprt
