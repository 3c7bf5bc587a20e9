// Starting mpirun for the user.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace pprt {

// Runs this same command line under mpirun with so many ranks and returns its exit code. SIGINT and SIGTERM
// are passed on as a wish to end after the frame at hand, SIGUSR1 as it is; after the former the code is 128
// + signal, unless the run failed. Throws std::runtime_error when mpirun cannot be started, or a rank was
// ended by a signal: then the text names it. `overhear` is told what the ranks say on standard error.
int run_under_mpirun(int ranks, const std::string& hostfile, char** argv,
                     const std::function<void(std::string_view)>& overhear);

// Whether people watch standard error: a terminal, which run_under_mpirun() may stand between.
bool on_terminal();

// This process's rank as its launcher tells it before MPI begins; 0 without a launcher.
int launcher_rank();

}  // namespace pprt
