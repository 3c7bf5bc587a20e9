// Starting mpirun, and following the run to its end.
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
// The first SIGINT, SIGTERM or SIGHUP asks rank 0 to end after its frame. A second SIGINT or SIGTERM ends
// mpirun, and so does the first before rank 0 has begun its frames. Each makes the code 128 + signal, unless
// the run failed. SIGUSR1 is passed on. `overhear` gets what the ranks print on standard error, which is
// printed too.
//
// Throws std::runtime_error when mpirun cannot be started, or has been ended. Throws it, with the name of a
// rank or a host, when the run cannot come to its end without the one or the other (RunWatch).
int run_under_mpirun(const Launch& launch, std::span<const std::string> words,
                     const std::function<void(std::string_view)>& overhear);

}  // namespace pprt
