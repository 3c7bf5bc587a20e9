// Work in a process of its own: a library that crashes on a damaged file ends that process alone.
#pragma once

#include <cstdint>
#include <functional>

#include "base/bytes.h"

namespace pprt {

struct CallLimits {
  std::uint64_t memory_bytes = 0;  // beyond what this process has mapped
  double cpu_seconds = 0;
  double wall_seconds = 0;
};

enum class CallEnd {
  kDone,
  kNoMemory,
  kNoTime,
  kCrashed  // by a signal, or an exception
};

struct CallResult {
  CallEnd end = CallEnd::kCrashed;
  Bytes bytes = {};  // of work that is done
  int signal = 0;    // that ended a crashed process; 0: an exception did
};

// Runs `work` in a copy of this process and returns what it returns. The copy ends with it, or with this
// process. Nothing of it reaches the standard streams.
//
// This process must not have other threads: a copy lacks them, and may wait for a lock of theirs for ever.
// Guards against faults, not against malice: the copy has all rights of the user. Under a sanitizer memory is
// unlimited and standard error stays. Throws std::system_error when no process can be made.
CallResult call_isolated(const std::function<Bytes()>& work, const CallLimits& limits);

}  // namespace pprt
