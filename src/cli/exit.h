// How a program ends: exit codes, and its message on standard error when it fails.
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

// Runs `body` and returns its exit code. An exception becomes a message on standard error and a code:
//   InputError  its full report              kExitInput
//   UsageError  its text, a hint at --help   kExitUsage
//   any other   its text                     kExitFailure
//
// All ranks of an MPI launcher meet the first two. Only rank 0 then prints and fails; the others return
// kExitDone, as the launcher might otherwise end rank 0 before it has printed.
int run_guarded(std::string_view program, const std::function<int()>& body);

}  // namespace pprt
