#include "cli/process/launch.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/system/subprocess.h"
#include "cli/process/exit.h"
#include "cli/process/launched.h"
#include "cli/process/mpirun_messages.h"
#include "cli/process/run_watch.h"

namespace pprt {
namespace {

// The only state a signal handler may touch. What it asks for is done by follow().
volatile std::sig_atomic_t stopped_by = 0;    // the first signal that asked for the end
volatile std::sig_atomic_t forced = 0;        // a second one came
volatile std::sig_atomic_t status_asked = 0;  // by SIGUSR1

std::string program_path() {
  return std::filesystem::read_symlink("/proc/self/exe");
}

// How long mpirun has to end when it is asked to, in seconds. It may wait for a lost host in vain. Otherwise
// it ends its ranks first, and removes what lies in shared memory.
constexpr double kEndPatience_s = 5, kLostHostPatience_s = 2;
constexpr double kArrivalPatience_s = 10, kHostArrivalPatience_s = 60;  // hosts may answer late

// mpirun has a process group of its own: a terminal's Ctrl-C must reach it through this process alone.
constexpr SubprocessSettings kMpirunSettings{
    .errors = StreamTo::kPipe, .own_process_group = true, .signal_at_end = SIGTERM};

// Stands before quoted words, each of which begins with '='.
constexpr std::string_view kQuotedWords = "=words";

void note_signal(int signal) {
  if (signal == SIGUSR1) {
    status_asked = 1;
  } else if (stopped_by == 0) {
    stopped_by = signal;
  } else if (signal != SIGHUP) {  // a terminal that goes may send several
    forced = 1;
  }
}

// Before mpirun is started, so that no signal is lost.
void note_signals() {
  struct sigaction action {};
  action.sa_handler = note_signal;
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) sigaction(signal, &action, nullptr);
  struct sigaction hangup {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // nohup keeps it off
}

void show(std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = write(STDERR_FILENO, text.data(), text.size());
    if (count < 0 && errno != EINTR) return;  // nobody to tell
    if (count > 0) text.remove_prefix(static_cast<std::size_t>(count));
  }
}

// Seconds for which this process has been looking. While it stands still, as a job of a shell may, nothing is
// heard, and this is nobody's silence.
class WakingTime {
 public:
  double look() {
    constexpr double kLongestLook_s = 0.5;
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> passed = now - last_look_;
    last_look_ = now;
    return awake_s_ += std::min(passed.count(), kLongestLook_s);
  }

 private:
  std::chrono::steady_clock::time_point last_look_ = std::chrono::steady_clock::now();
  double awake_s_ = 0;
};

// A run under mpirun.
class FollowedRun {
 public:
  FollowedRun(const Launch& launch, std::span<const std::string> words,
              const std::function<void(std::string_view)>& overhear)
      : launch_(launch),
        overhear_(overhear),
        watch_({.goes_on = launch.goes_on,
                .ranks = launch.processes,
                .arrival_patience_s = launch.hostfile.empty() ? kArrivalPatience_s : kHostArrivalPatience_s,
                .start_patience_s = launch.start_patience_s}),
        mpirun_(mpirun_command(launch, words), kMpirunSettings) {}

  // Returns the exit code. Throws std::runtime_error with what was lost.
  int run() {
    follow();
    const int code = end_mpirun();
    show(messages_.finish());
    if (ends_at_once_) return 128 + stopped_by;
    if (failure_) fail(*failure_);
    const bool failed = code >= kExitFailure && code <= kExitInput;
    if (!watch_.end_code() && !failed) require_no_loss(code);
    // A run that was asked to stop may still fail.
    const bool ended_well = launch_.ends_by_signal && code == kExitDone;
    return stopped_by != 0 && !failed && !ended_well ? 128 + stopped_by : code;
  }

 private:
  [[noreturn]] static void fail(const std::string& why) {
    throw std::runtime_error(why + "; frames that are in place are whole, and --resume goes on after them");
  }

  // A run that goes on without what it has lost says itself how it ended.
  void require_no_loss(int code) const {
    if (watch_.loss()) fail(*watch_.loss());
    if (messages_.loss()) fail(*messages_.loss());
    if (stopped_by != 0) return;  // mpirun may have ended by it
    // mpirun exits with the code of a rank that a signal has ended, whether or not it has named it.
    if (code > 128)
      fail((is_killed_ ? "mpirun was ended by " : "a rank was ended by ") + signal_name(code - 128));
    if (code > kExitInput) fail(fmt::format("mpirun ended with code {}", code));
  }

  // Prints what mpirun and the ranks say until they end, or must be ended.
  void follow() {
    constexpr double kBetweenLooks_s = 0.1;
    for (;;) {
      const bool speaks = mpirun_.has_output_within(kBetweenLooks_s);
      const double now_s = time_.look();
      if (speaks && !hear(now_s)) return;
      if (!speaks && mpirun_.has_ended()) return;
      watch_.see_mpirun(mpirun_.is_stopped(), now_s);
      if (!obey_signals() || messages_.has_lost_host()) return;
      if (mpirun_.has_output_within(0)) continue;  // it may change what follows
      failure_ = watch_.failure(now_s);
      is_overdue_ = watch_.is_over(now_s);
      if (failure_ || is_overdue_) return;
    }
  }

  // Returns false when nothing more comes.
  bool hear(double now_s) {
    std::array<char, 4096> piece{};
    const std::size_t count = mpirun_.read(piece);
    const std::string said = messages_.take({piece.data(), count});
    show(said);
    overhear_(said);
    for (const RankNews& news : messages_.take_news()) {
      watch_.hear(news, now_s);
      warn_of(news);
    }
    return count > 0;
  }

  void warn_of(const RankNews& news) const {
    const bool goes_on = news.event == RankEvent::kKilled && !watch_.loss();
    if (news.event != RankEvent::kStopped && !goes_on) return;
    show(fmt::format("pprt-render: warning: {} was {} by {}\n", rank_name(news.rank, news.host),
                     goes_on ? "ended" : "stopped", signal_name(news.number)));
  }

  // Returns false when the run is to end at once.
  bool obey_signals() {
    const bool is_at_work = watch_.listens();
    if (stopped_by != 0 && !is_at_work) show("pprt-render: stopped while starting\n");
    ends_at_once_ = stopped_by != 0 && (forced != 0 || !is_at_work);
    if (ends_at_once_ || !is_at_work) return !ends_at_once_;
    if (stopped_by != 0 && !std::exchange(has_passed_on_stop_, true)) kill(mpirun_.id(), SIGUSR2);
    if (status_asked != 0) kill(mpirun_.id(), SIGUSR1);
    status_asked = 0;
    return true;
  }

  // Returns mpirun's exit code, or what rank 0 has told instead.
  int end_mpirun() {
    const bool must_end = failure_ || ends_at_once_ || is_overdue_ || messages_.has_lost_host();
    const double patience_s = messages_.has_lost_host() ? kLostHostPatience_s : kEndPatience_s;
    const ExitStatus status = must_end ? mpirun_.end_within(patience_s) : mpirun_.wait();
    is_killed_ = status.by_signal;
    return watch_.end_code().value_or(status.code);
  }

  const Launch& launch_;
  const std::function<void(std::string_view)>& overhear_;
  RunWatch watch_;
  MpirunMessages messages_;
  WakingTime time_;
  Subprocess mpirun_;
  bool has_passed_on_stop_ = false;
  bool ends_at_once_ = false;           // by a signal
  bool is_overdue_ = false;             // mpirun, after the run's end
  bool is_killed_ = false;              // mpirun itself
  std::optional<std::string> failure_;  // that ends the run
};

}  // namespace
std::vector<std::string> mpirun_command(const Launch& launch, std::span<const std::string> words) {
  std::vector<std::string> command = {"mpirun", "-np", std::to_string(launch.processes)};
  if (!launch.hostfile.empty()) command.insert(command.end(), {"--hostfile", absolute(launch.hostfile)});
  // The system asks a silent connection between mpirun's daemons after 2 s, and gives it up after 4 more
  // questions, one a second. By default that takes 8 minutes. A batch system may name hosts, too.
  for (const auto& [name, value] : {std::pair("time", "2"), {"intvl", "1"}, {"probes", "4"}})
    command.insert(command.end(), {"--mca", std::string("oob_tcp_keepalive_") + name, value});
  // When a run has to end, mpirun lets 2 s pass between its first signal to the ranks and the last. With
  // other hosts these are needed: a daemon that is cut off must not end, and be taken for one that has not
  // started, before mpirun has noticed itself.
  if (launch.hostfile.empty()) command.insert(command.end(), {"--mca", "odls_base_sigkill_timeout", "0"});
  if (launch.goes_on) command.emplace_back("--enable-recovery");
  // More ranks than cores is normal here: idle ranks sleep, and no rank may be bound to a core.
  command.insert(command.end(), {"--oversubscribe", "--bind-to", "none"});
  if (geteuid() == 0) command.emplace_back("--allow-run-as-root");
  command.emplace_back("-x");
  command.push_back(fmt::format("{}={}", kLauncherVariable, on_terminal() ? kFromTerminal : kFromElsewhere));
  command.push_back(program_path());
  command.emplace_back(kQuotedWords);
  for (const std::string& word : words) command.push_back("=" + word);
  return command;
}

std::vector<std::string> user_words(int argc, const char* const* argv) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (words.empty() || words.front() != kQuotedWords) return words;
  words.erase(words.begin());
  for (std::string& word : words) word.erase(0, 1);
  return words;
}

int run_under_mpirun(const Launch& launch, std::span<const std::string> words,
                     const std::function<void(std::string_view)>& overhear) try {
  note_signals();
  return FollowedRun(launch, words, overhear).run();
} catch (const ProgramNotFound&) {
  throw std::runtime_error("cannot start mpirun: it is not on the PATH (package openmpi-bin)");
}

}  // namespace pprt
