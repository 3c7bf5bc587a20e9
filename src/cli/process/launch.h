// Starting mpirun, and what its ranks find.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pprt {

// What mpirun is to do.
struct Launch {
  int processes = 1;
  std::filesystem::path hostfile = {};  // empty: this host
  bool goes_on = false;                 // the run may go on without a process that has ended
  bool ends_by_signal = false;          // that is its usual end: then the run's own exit code counts
  double start_patience_s = 60;         // with goes_on: how long the ranks may take to find each other
};

// Returns the mpirun command that runs this program with these words.
//
// mpirun looks for words of its own in the whole of its command line. A ":" there begins another program,
// which it starts too. So the user's words are quoted: none stands there as it was given. The path of a
// hostfile is absolute. A host that does not answer any more is given up after 6 to 7 s.
std::vector<std::string> mpirun_command(const Launch& launch, std::span<const std::string> words);

// Returns the words behind the program's name as the user gave them, quoted by mpirun_command() or not.
std::vector<std::string> user_words(int argc, const char* const* argv);

// Runs this program with these words under mpirun and returns its exit code.
//
// The first SIGINT, SIGTERM or SIGHUP asks rank 0 to end after its frame; a second SIGINT or SIGTERM ends
// mpirun. Each makes the code 128 + signal, unless the run failed. SIGUSR1 is passed on. `overhear` gets what
// the ranks print on standard error, which is printed too.
//
// Throws std::runtime_error when mpirun cannot be started. Throws it when the ranks do not find each other in
// time (Launch). Throws it, with the name of a rank or a host, when a signal has ended the one or the other
// does not answer.
int run_under_mpirun(const Launch& launch, std::span<const std::string> words,
                     const std::function<void(std::string_view)>& overhear);

// Whether standard error is a terminal, also when run_under_mpirun() stands between.
bool on_terminal();

// These tell run_under_mpirun(), if it stands between, that all processes have begun to render, or that the
// run has ended with this code. mpirun may not notice the end: a host that it waits for may be out of reach.
void tell_launcher_of_begin();
void tell_launcher_of_end(int exit_code);

// Returns this process's rank as its launcher tells it before MPI begins; 0 without a launcher.
int launcher_rank();

}  // namespace pprt
