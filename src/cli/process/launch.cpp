#include "cli/process/launch.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "base/subprocess.h"
#include "cli/process/exit.h"
#include "cli/process/mpirun_messages.h"

namespace pprt {
namespace {

volatile std::sig_atomic_t mpirun_pid = 0;
volatile std::sig_atomic_t stopped_by = 0;
volatile std::sig_atomic_t forced = 0;  // a second signal came

// Tells the ranks where the pipe to mpirun, which is their standard error, ends: at a terminal or elsewhere.
constexpr const char* kLauncherVariable = "PPRT_LAUNCHED";
constexpr std::string_view kFromTerminal = "from-terminal", kFromElsewhere = "from-elsewhere";

std::string program_path() {
  return std::filesystem::read_symlink("/proc/self/exe");
}

using SteadyTime = std::chrono::steady_clock::time_point;

constexpr double kEndPatience_s = 2;  // that mpirun has to end when it is asked to

// Stands before quoted words, each of which begins with '='.
constexpr std::string_view kQuotedWords = "=words";

// A first SIGINT, SIGTERM or SIGHUP asks rank 0 to finish its frame; a second SIGINT or SIGTERM ends mpirun.
void pass_on(int signal) {
  if (mpirun_pid == 0 || (signal == SIGHUP && stopped_by != 0)) return;
  if (signal == SIGUSR1) {
    kill(mpirun_pid, SIGUSR1);
  } else {
    kill(mpirun_pid, stopped_by == 0 ? SIGUSR2 : signal);
    forced = stopped_by != 0;
    stopped_by = signal;
  }
}

void pass_signals_on() {
  struct sigaction action {};
  action.sa_handler = pass_on;
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

// With --enable-recovery mpirun says nothing of a host that cannot start its ranks, and the others wait for
// them. Ends it then.
void await_begin(Subprocess& mpirun, const Launch& launch, SteadyTime began) {
  const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - began;
  if (mpirun.has_output_within(launch.start_patience_s - waited.count())) return;
  mpirun.end_within(kEndPatience_s);
  throw std::runtime_error(
      fmt::format("the ranks have not found each other within {:g} s; is the program on every host at '{}'?",
                  launch.start_patience_s, program_path()));
}

// Prints what mpirun and the ranks say until they end.
MpirunMessages relay(Subprocess& mpirun, const Launch& launch,
                     const std::function<void(std::string_view)>& overhear) {
  MpirunMessages messages;
  std::array<char, 4096> piece{};
  const SteadyTime began = std::chrono::steady_clock::now();
  while (!messages.end_code() && !messages.has_lost_host()) {
    if (launch.goes_on && !messages.has_begun()) await_begin(mpirun, launch, began);
    const std::size_t count = mpirun.read(piece);
    if (count == 0) break;
    const std::string said = messages.take({piece.data(), count});
    show(said);
    overhear(said);
  }
  show(messages.finish());
  return messages;
}

// Waits for mpirun's end, but not long where it may wait itself for a host that is out of reach. The ranks
// that it can reach end with it in any case. Returns its exit code, or what a rank has said instead.
int mpirun_code(Subprocess& mpirun, const MpirunMessages& messages) {
  if (!messages.end_code() && !messages.has_lost_host()) return mpirun.wait().code;
  const int code = mpirun.end_within(kEndPatience_s).code;
  return messages.end_code().value_or(code);
}

// mpirun has a process group of its own: a terminal's Ctrl-C must reach it through this process alone.
constexpr SubprocessSettings kMpirunSettings{
    .errors = StreamTo::kPipe, .own_process_group = true, .signal_at_end = SIGTERM};

}  // namespace

std::vector<std::string> mpirun_command(const Launch& launch, std::span<const std::string> words) {
  std::vector<std::string> command = {"mpirun", "-np", std::to_string(launch.processes)};
  if (!launch.hostfile.empty()) command.insert(command.end(), {"--hostfile", absolute(launch.hostfile)});
  // The system asks a silent connection between mpirun's daemons after 2 s, and gives it up after 4 more
  // questions, one a second. By default that takes 8 minutes. A batch system may name hosts, too.
  for (const auto& [name, value] : {std::pair("time", "2"), {"intvl", "1"}, {"probes", "4"}})
    command.insert(command.end(), {"--mca", std::string("oob_tcp_keepalive_") + name, value});
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
  Subprocess mpirun(mpirun_command(launch, words), kMpirunSettings);
  mpirun_pid = mpirun.id();
  pass_signals_on();
  const MpirunMessages messages = relay(mpirun, launch, overhear);
  const int code = mpirun_code(mpirun, messages);
  // A run that was asked to stop may still fail. The code of an mpirun that was ended says nothing.
  const bool failed = code >= kExitFailure && code <= kExitInput;
  const bool ended_well = launch.ends_by_signal && code == kExitDone && forced == 0;
  if (stopped_by != 0 && (forced != 0 || !failed) && !ended_well) return 128 + stopped_by;
  // A run that goes on without what it has lost says itself how it ended.
  const bool is_lost = messages.loss() && !messages.end_code();
  if (is_lost || code > kExitInput) {
    throw std::runtime_error(messages.loss().value_or("mpirun ended with code " + std::to_string(code)) +
                             "; frames that are in place are whole, and --resume goes on after them");
  }
  return code;
} catch (const ProgramNotFound&) {
  throw std::runtime_error("cannot start mpirun: it is not on the PATH (package openmpi-bin)");
}

bool on_terminal() {
  const char* launched = std::getenv(kLauncherVariable);
  return isatty(STDERR_FILENO) != 0 || (launched != nullptr && launched == kFromTerminal);
}

void tell_launcher_of_begin() {
  if (std::getenv(kLauncherVariable) != nullptr) show(begin_line());
}

void tell_launcher_of_end(int exit_code) {
  if (std::getenv(kLauncherVariable) != nullptr) show(end_line(exit_code));
}

int launcher_rank() {
  // Set by Open MPI, by PMIx, and by the PMI of MPICH and Slurm.
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"}) {
    if (const char* rank = std::getenv(name)) return std::atoi(rank);
  }
  return 0;
}

}  // namespace pprt
