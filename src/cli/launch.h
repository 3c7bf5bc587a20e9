// Starting mpirun, and what its ranks find.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pprt {

// Returns the mpirun command that runs this program with these words on `ranks` ranks.
//
// mpirun looks for words of its own in the whole of its command line. A ":" there begins another program,
// which it starts too. So the user's words are quoted: none stands there as it was given. The path of a
// hostfile is absolute.
std::vector<std::string> mpirun_command(int ranks, const std::filesystem::path& hostfile,
                                        std::span<const std::string> words);

// Returns the words behind the program's name as the user gave them, quoted by mpirun_command() or not.
std::vector<std::string> user_words(int argc, const char* const* argv);

// Runs this program with these words under mpirun with `ranks` ranks and returns its exit code.
//
// The first SIGINT, SIGTERM or SIGHUP asks rank 0 to end after its frame; a second SIGINT or SIGTERM ends
// mpirun. Each makes the code 128 + signal, unless the run failed. SIGUSR1 is passed on. `overhear` gets what
// the ranks print on standard error, which is printed too.
//
// Throws std::runtime_error when mpirun cannot be started, or with the rank that a signal has ended.
int run_under_mpirun(int ranks, const std::string& hostfile, std::span<const std::string> words,
                     const std::function<void(std::string_view)>& overhear);

// Whether standard error is a terminal, also when run_under_mpirun() stands between.
bool on_terminal();

// Returns this process's rank as its launcher tells it before MPI begins; 0 without a launcher.
int launcher_rank();

}  // namespace pprt
