// What the outside world may ask of a running program.
#pragma once

#include <optional>

namespace pprt {

// From now on SIGINT, SIGTERM and SIGUSR2 (which mpirun passes on) ask for an end after the frame at hand,
// and SIGUSR1 for a line of status. A second SIGINT or SIGTERM ends the process at once.
void watch_signals();

// From now on the process leaves all four to rank 0.
void ignore_signals();

// The signal that asked for the end, if any did.
std::optional<int> stop_requested();

// Whether a status line was asked for since the last call.
bool take_status_request();

}  // namespace pprt
