#include "base/thread_priority.h"

#include <sys/resource.h>
#include <unistd.h>

namespace pprt {

// On Linux a priority belongs to the thread, not the process.
void take_lowest_priority() {
  constexpr int kLowest = 19;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kLowest);
}

}  // namespace pprt
