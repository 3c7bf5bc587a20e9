// How a program ends: exit codes, and what it says on standard error when it fails.
#pragma once

#include <functional>
#include <string_view>

namespace pprt {

enum ExitCode : int {
  kExitDone = 0,
  kExitFailure = 1,  // failed while working or writing
  kExitUsage = 2,    // the command line makes no sense
  kExitInput = 3,    // scene or script missing, unreadable or rejected
};

// Runs `body` and returns its exit code. An exception becomes a message on standard error and the code of its
// kind: InputError (a full report, printed as it is) kExitInput; UsageError, with a hint at --help,
// kExitUsage; any other kExitFailure. Of the ranks of an MPI launcher the first alone speaks and answers for
// the first two, which all of them meet: the others return kExitDone, lest the launcher end the first one
// before it has spoken.
int run_guarded(std::string_view program, const std::function<int()>& body);

}  // namespace pprt
