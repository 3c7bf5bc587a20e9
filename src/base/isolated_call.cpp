#include "base/isolated_call.h"

#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <fstream>
#include <limits>
#include <new>
#include <span>
#include <stdexcept>
#include <utility>

#include "base/sanitized.h"
#include "base/system/owned_descriptor.h"

namespace pprt {
namespace {

// Exit codes of the copy; a sanitizer's is 1.
constexpr int kDoneCode = 0, kNoMemoryCode = 98, kThrownCode = 99;

// --- In the copy

void limit(__rlimit_resource resource, std::uint64_t soft, std::uint64_t more = 0) {
  rlimit old{};
  if (getrlimit(resource, &old) != 0) throw_errno("getrlimit");
  const rlimit now{std::min<rlim_t>(soft, old.rlim_max), std::min<rlim_t>(soft + more, old.rlim_max)};
  if (setrlimit(resource, &now) != 0) throw_errno("setrlimit");
}

std::uint64_t mapped_bytes() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void set_limits(const CallLimits& limits) {
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, static_cast<std::uint64_t>(std::ceil(limits.cpu_seconds)), 1);
  if (!kSanitized) limit(RLIMIT_AS, mapped_bytes() + limits.memory_bytes);
}

void leave_streams() {
  const OwnedDescriptor nothing = open_nothing();
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (!(kSanitized && stream == STDERR_FILENO)) dup2(nothing.get(), stream);
  }
}

// The handlers of this process do not speak for the copy.
void forget_signal_handlers() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2, SIGPIPE}) std::signal(signal, SIG_DFL);
}

void write_all(int to, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = write(to, bytes.data(), bytes.size());
    if (count < 0 && errno != EINTR) throw_errno("write");
    if (count > 0) bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

int code_of(const std::function<Bytes()>& work, const CallLimits& limits, int to) {
  try {
    forget_signal_handlers();
    leave_streams();
    set_limits(limits);
    write_all(to, work());
    return kDoneCode;
  } catch (const std::bad_alloc&) {
    return kNoMemoryCode;
  } catch (const std::length_error&) {
    return kNoMemoryCode;
  } catch (...) {
    return kThrownCode;
  }
}

// --- In this process

using Deadline = std::chrono::steady_clock::time_point;

bool has_input_before(Deadline end, int from) {
  for (;;) {
    const std::chrono::duration<double, std::milli> left = end - std::chrono::steady_clock::now();
    pollfd input{from, POLLIN, 0};
    const double most = std::numeric_limits<int>::max();
    const int ready = poll(&input, 1, static_cast<int>(std::clamp(std::ceil(left.count()), 0.0, most)));
    if (ready >= 0) return ready > 0;
    if (errno != EINTR) throw_errno("poll");
  }
}

// Returns whether all came before the deadline.
bool read_all(int from, Deadline end, Bytes& bytes) {
  std::array<std::byte, 1 << 16> part{};
  while (has_input_before(end, from)) {
    const ssize_t count = read(from, part.data(), part.size());
    if (count == 0) return true;
    if (count < 0 && errno != EINTR) throw_errno("read");
    if (count > 0) bytes.insert(bytes.end(), part.begin(), part.begin() + count);
  }
  return false;
}

// Its process ends with it.
class Copy {
 public:
  explicit Copy(pid_t id) : id_(id) {}
  Copy(const Copy&) = delete;
  Copy& operator=(const Copy&) = delete;
  ~Copy() {
    if (id_ > 0) kill(id_, SIGKILL), wait();
  }

  int wait() {
    int status = 0;
    while (waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = 0;
    return status;
  }

 private:
  pid_t id_;
};

CallResult result_of(int status, Bytes bytes) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU) return {.end = CallEnd::kNoTime};
    // Only the system kills so, where memory is short.
    if (signal == SIGKILL) return {.end = CallEnd::kNoMemory};
    return {.end = CallEnd::kCrashed, .signal = signal};
  }
  if (WEXITSTATUS(status) == kDoneCode) return {.end = CallEnd::kDone, .bytes = std::move(bytes)};
  return {.end = WEXITSTATUS(status) == kNoMemoryCode ? CallEnd::kNoMemory : CallEnd::kCrashed};
}

}  // namespace

CallResult call_isolated(const std::function<Bytes()>& work, const CallLimits& limits) {
  const auto wall = std::chrono::duration<double>(limits.wall_seconds);
  const Deadline end =
      std::chrono::steady_clock::now() + std::chrono::duration_cast<Deadline::duration>(wall);
  Ends pipe = make_pipe();
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) throw_errno("fork");
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(kThrownCode);  // which has ended already
    _exit(code_of(work, limits, pipe.theirs.get()));
  }
  Copy copy(child);
  pipe.theirs = {};
  Bytes bytes;
  if (!read_all(pipe.ours.get(), end, bytes)) return {.end = CallEnd::kNoTime};
  return result_of(copy.wait(), std::move(bytes));
}

}  // namespace pprt
