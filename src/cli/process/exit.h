// How a program ends: exit codes, and its message on standard error when it fails.
#pragma once

#include <exception>
#include <functional>
#include <string>
#include <string_view>

namespace pprt {

enum ExitCode : int {
  kExitDone = 0,
  kExitFailure = 1,  // failed while working or writing
  kExitUsage = 2,    // the command line makes no sense
  kExitInput = 3,    // scene or script missing, unreadable or rejected
};

// Returns the exception's text for people: "out of memory", "'PATH': REASON".
std::string message_of(const std::exception& error);

// Prints on standard error. A terminal that has gone, or a full disk, must not end a run.
void print_message(std::string_view text);

// Prints on standard output at once. Throws std::runtime_error "cannot write to standard output: REASON".
void print_output(std::string_view text);

// Opens closed standard streams, runs `body` and returns its exit code. An exception becomes a message on
// standard error and a code:
//   InputError  its full report              kExitInput
//   UsageError  its text, a hint at --help   kExitUsage
//   any other   message_of()                 kExitFailure
//
// What cannot be written to standard output is such a failure.
//
// All ranks of an MPI launcher meet the first two. Only rank 0 then prints and fails; the others return
// kExitDone, as the launcher might otherwise end rank 0 before it has printed.
int run_guarded(std::string_view program, const std::function<int()>& body);

}  // namespace pprt
