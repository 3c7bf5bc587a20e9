// Keeps caches and memory busy beside a measurement.
#pragma once

#include <latch>
#include <thread>
#include <vector>

#include "study/reference.h"

namespace pprt {

// Renders the subject on `count` threads from construction to destruction, each with a tracer of its own: one
// sample after the other, anywhere in the picture. The threads have the usual priority. All of them are at
// work when the constructor returns.
class BusyThreads {
 public:
  BusyThreads(const Subject& subject, int count);

 private:
  std::latch at_work_;
  std::vector<std::jthread> threads_;  // end with the sample that they are at
};

}  // namespace pprt
