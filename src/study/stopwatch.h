// How long the steps of a study take, for those who wait for it.
#pragma once

#include <chrono>
#include <utility>

namespace pprt {

class Stopwatch {
 public:
  // Returns the seconds since the last call, or since it was made.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(since_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
};

}  // namespace pprt
