#include "study/accuracy/busy_threads.h"

#include <cstddef>
#include <cstdint>
#include <stop_token>

#include "base/hash.h"

namespace pprt {
namespace {

void trace_endlessly(const std::stop_token& stop, const Subject& subject, std::uint64_t thread,
                     std::latch& at_work) {
  constexpr std::uint64_t kSeed = 0x9fb21c651e98df25u;  // unlike those of the samplers
  Tracer tracer = tracer_of(subject);
  for (std::uint64_t i = 0; i == 0 || !stop.stop_requested(); i += 2) {
    const double x = uniform(kSeed, thread, i) * subject.camera.width;
    const double y = uniform(kSeed, thread, i + 1) * subject.camera.height;
    tracer.trace(x, y);
    if (i == 0) at_work.count_down();
  }
}

}  // namespace

BusyThreads::BusyThreads(const Subject& subject, int count) : at_work_(count) {
  for (int i = 0; i < count; ++i) {
    const auto thread = static_cast<std::uint64_t>(i);
    threads_.emplace_back([this, subject, thread](const std::stop_token& stop) {
      trace_endlessly(stop, subject, thread, at_work_);
    });
  }
  at_work_.wait();
}

}  // namespace pprt
