// Signals that ask a running program to stop or to print its status.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <thread>

namespace pprt {

// Installs handlers. SIGINT, SIGTERM, SIGHUP and SIGUSR2, which mpirun passes on, ask for an end after the
// current frame; SIGUSR1 asks for a line of status. A second SIGINT or SIGTERM ends the process at once. A
// SIGHUP that is ignored, as by nohup, stays so.
void watch_signals();

// Ignores all five signals: rank 0 handles them.
void ignore_signals();

// Returns the signal that asked for the end, if any did.
std::optional<int> stop_requested();

// While it lives, answers SIGUSR1 by calling `print` in a thread of its own, as a frame may take minutes. The
// first signal that asks for the end is answered by `tell_of_stop`. At most one may exist at a time, after
// watch_signals().
class StatusPrinter {
 public:
  StatusPrinter(std::function<void()> print, std::function<void()> tell_of_stop);
  ~StatusPrinter();
  StatusPrinter(const StatusPrinter&) = delete;
  StatusPrinter& operator=(const StatusPrinter&) = delete;

 private:
  void run();

  std::function<void()> print_, tell_of_stop_;
  std::atomic<bool> over_ = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace pprt
