#include "cli/process/rank_guard.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <initializer_list>
#include <string>
#include <system_error>

#include "cli/process/launched.h"
#include "cli/process/rank_news.h"
#include "cli/process/stop_signals.h"

namespace pprt {
namespace {

std::string short_host_name() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return {};
  const std::string whole = name.data();
  return whole.substr(0, whole.find('.'));
}

// Ends this process as the signal has ended the rank, but leaves no second core file.
[[noreturn]] void end_by(int signal) {
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  std::signal(signal, SIG_DFL);
  raise(signal);
  _exit(128 + signal);
}

sigset_t set_of(std::initializer_list<int> signals) {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : signals) sigaddset(&set, signal);
  return set;
}

// Whether this process is mpirun's daemon, which it has on every host but its own.
bool is_daemon(pid_t process) {
  std::string name;
  std::getline(std::ifstream("/proc/" + std::to_string(process) + "/comm"), name);
  return name == "orted" || name == "prted";
}

class RankGuard {
 public:
  RankGuard(pid_t rank_process, pid_t parent) : rank_process_(rank_process), parent_(parent) {}

  [[noreturn]] void run() {
    const sigset_t changes = set_of({SIGCHLD, SIGTERM});
    while (true) {
      look_at_rank();
      if (getppid() != parent_) {
        kill(rank_process_, SIGKILL);
        _exit(1);
      }
      const auto now = std::chrono::steady_clock::now();
      if (now >= next_sign_) {
        tell(RankEvent::kLives, period_s_);
        next_sign_ = period_s_ > 0 ? now + std::chrono::seconds(period_s_) : now.max();
      }
      constexpr timespec kBetweenLooks{0, 100'000'000};
      if (sigtimedwait(&changes, nullptr, &kBetweenLooks) == SIGTERM) is_being_ended_ = true;
    }
  }

 private:
  void look_at_rank() {
    int status = 0;
    while (waitpid(rank_process_, &status, WNOHANG | WUNTRACED | WCONTINUED) > 0) {
      if (WIFSTOPPED(status)) {
        tell(RankEvent::kStopped, WSTOPSIG(status));
      } else if (WIFCONTINUED(status)) {
        tell(RankEvent::kContinued);
      } else if (WIFSIGNALED(status)) {
        if (!is_being_ended_) tell(RankEvent::kKilled, WTERMSIG(status));
        end_by(WTERMSIG(status));
      } else {
        tell(RankEvent::kLeft);
        _exit(WEXITSTATUS(status));
      }
    }
  }

  void tell(RankEvent event, int number = 0) const {
    tell_launcher({.event = event, .rank = launcher_rank(), .number = number, .host = host_});
  }

  pid_t rank_process_, parent_;
  int period_s_ = is_daemon(parent_) ? 0 : 1;  // of signs
  bool is_being_ended_ = false;                // by mpirun, which knows why
  std::string host_ = short_host_name();
  std::chrono::steady_clock::time_point next_sign_{};
};

}  // namespace

void guard_this_rank() {
  const pid_t guard = getpid(), parent = getppid();
  // Blocked before the rank begins, so that the guard misses neither its changes nor mpirun's order to end.
  const sigset_t changes = set_of({SIGCHLD, SIGTERM});
  sigset_t before;
  sigprocmask(SIG_BLOCK, &changes, &before);
  const pid_t rank_process = fork();
  if (rank_process < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (rank_process > 0) {
    // mpirun sends its signals to both processes: they are one group.
    ignore_signals();
    std::signal(SIGTERM, SIG_DFL);  // blocked; what is ignored is not even pending
    RankGuard(rank_process, parent).run();
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != guard) _exit(1);
  if (launcher_rank() > 0) ignore_signals();
  sigprocmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace pprt
