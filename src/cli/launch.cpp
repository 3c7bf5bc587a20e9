#include "cli/launch.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <stdexcept>

#include "base/subprocess.h"
#include "cli/exit.h"
#include "cli/mpirun_messages.h"

namespace pprt {
namespace {

volatile std::sig_atomic_t mpirun_pid = 0;
volatile std::sig_atomic_t stopped_by = 0;
volatile std::sig_atomic_t forced = 0;  // a second signal came

// Tells the ranks that the pipe to mpirun, which is their standard error, ends at a terminal.
constexpr const char* kTerminalVariable = "PPRT_ON_TERMINAL";

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

// Prints what mpirun and the ranks say until they end.
MpirunMessages relay(const Subprocess& mpirun, const std::function<void(std::string_view)>& overhear) {
  MpirunMessages messages;
  std::array<char, 4096> piece{};
  while (const std::size_t count = mpirun.read(piece)) {
    const std::string said = messages.take({piece.data(), count});
    show(said);
    overhear(said);
  }
  show(messages.finish());
  return messages;
}

// mpirun has a process group of its own: a terminal's Ctrl-C must reach it through this process alone.
constexpr SubprocessSettings kMpirunSettings{
    .errors = StreamTo::kPipe, .own_process_group = true, .ends_with_parent = true};

}  // namespace

std::vector<std::string> mpirun_command(int ranks, const std::filesystem::path& hostfile,
                                        std::span<const std::string> words) {
  std::vector<std::string> command = {"mpirun", "-np", std::to_string(ranks)};
  if (!hostfile.empty()) command.insert(command.end(), {"--hostfile", absolute(hostfile)});
  // More ranks than cores is normal here: idle ranks sleep, and no rank may be bound to a core.
  command.insert(command.end(), {"--oversubscribe", "--bind-to", "none"});
  if (geteuid() == 0) command.emplace_back("--allow-run-as-root");
  if (on_terminal()) command.insert(command.end(), {"-x", std::string(kTerminalVariable) + "=1"});
  command.push_back(std::filesystem::read_symlink("/proc/self/exe"));
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

int run_under_mpirun(int ranks, const std::string& hostfile, std::span<const std::string> words,
                     const std::function<void(std::string_view)>& overhear) try {
  Subprocess mpirun(mpirun_command(ranks, hostfile, words), kMpirunSettings);
  mpirun_pid = mpirun.id();
  pass_signals_on();
  const MpirunMessages messages = relay(mpirun, overhear);
  const int code = mpirun.wait().code;
  // A run that was asked to stop may still fail. The code of an mpirun that was ended says nothing.
  const bool failed = code >= kExitFailure && code <= kExitInput;
  if (stopped_by != 0 && (forced != 0 || !failed)) return 128 + stopped_by;
  if (code > kExitInput) {
    throw std::runtime_error(messages.lost_rank().value_or("mpirun ended with code " + std::to_string(code)) +
                             "; frames that are in place are whole, and --resume goes on after them");
  }
  return code;
} catch (const ProgramNotFound&) {
  throw std::runtime_error("cannot start mpirun: it is not on the PATH (package openmpi-bin)");
}

bool on_terminal() {
  return isatty(STDERR_FILENO) != 0 || std::getenv(kTerminalVariable) != nullptr;
}

int launcher_rank() {
  // Set by Open MPI, by PMIx, and by the PMI of MPICH and Slurm.
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"}) {
    if (const char* rank = std::getenv(name)) return std::atoi(rank);
  }
  return 0;
}

}  // namespace pprt
