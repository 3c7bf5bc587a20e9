// What the outside world may ask of a running program.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <thread>

namespace pprt {

// From now on SIGINT, SIGTERM and SIGUSR2 (which mpirun passes on) ask for an end after the frame at hand,
// and SIGUSR1 for a line of status. A second SIGINT or SIGTERM ends the process at once.
void watch_signals();

// From now on the process leaves all four to rank 0.
void ignore_signals();

// The signal that asked for the end, if any did.
std::optional<int> stop_requested();

// While it lives, answers SIGUSR1 by calling `tell` in a thread of its own, which sleeps otherwise: a frame
// may take minutes. At most one at a time.
class StatusTeller {
 public:
  explicit StatusTeller(std::function<void()> tell);
  ~StatusTeller();
  StatusTeller(const StatusTeller&) = delete;
  StatusTeller& operator=(const StatusTeller&) = delete;

 private:
  void run() const;

  std::function<void()> tell_;
  std::atomic<bool> over_ = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace pprt
