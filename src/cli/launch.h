// Starting mpirun.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace pprt {

// Runs this same command line under mpirun with `ranks` ranks and returns its exit code.
//
// The first SIGINT or SIGTERM asks rank 0 to end after its frame; a second one ends mpirun. Either makes the
// code 128 + signal, unless the run failed. SIGUSR1 is passed on. `overhear` gets what the ranks print on
// standard error, which is printed too.
//
// Throws std::runtime_error when mpirun cannot be started, or with the rank that a signal has ended.
int run_under_mpirun(int ranks, const std::string& hostfile, char** argv,
                     const std::function<void(std::string_view)>& overhear);

// Whether standard error is a terminal, also when run_under_mpirun() stands between.
bool on_terminal();

// Returns this process's rank as its launcher tells it before MPI begins; 0 without a launcher.
int launcher_rank();

}  // namespace pprt
