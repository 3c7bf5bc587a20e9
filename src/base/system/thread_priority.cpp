#include "base/system/thread_priority.h"

#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>

namespace pprt {

namespace {

// On Linux a priority belongs to the thread, not the process.
void take_nice(int value) {
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), value);
}

}  // namespace

void take_lowest_priority() {
  constexpr int kLowest = 19;
  take_nice(kLowest);
}

void take_low_priority() {
  constexpr int kLow = 5;
  take_nice(kLow);
}

// A thread that asks for short turns gets its turn earlier: sched_setattr(2), sched_runtime.
void ask_for_short_waits() {
  constexpr std::uint64_t kTurn_ns = 100'000;
  struct Attributes {  // sched_attr
    std::uint32_t size = sizeof(Attributes);
    std::uint32_t policy = SCHED_OTHER;
    std::uint64_t flags = 0;
    std::int32_t nice = 0;
    std::uint32_t priority = 0;
    std::uint64_t runtime_ns = kTurn_ns;
    std::uint64_t deadline_ns = 0;
    std::uint64_t period_ns = 0;
  };
  Attributes attributes;
  attributes.nice = getpriority(PRIO_PROCESS, static_cast<id_t>(gettid()));
  syscall(SYS_sched_setattr, 0, &attributes, 0);
}

}  // namespace pprt
