// Starting mpirun for the user.
#pragma once

#include <string>

namespace pprt {

// Runs this same command line under mpirun with so many ranks and returns its exit code. SIGINT and SIGTERM
// are passed on as a wish to end after the frame at hand, SIGUSR1 as it is; after the former the code is 128
// + signal. Throws std::runtime_error when mpirun cannot be started.
int run_under_mpirun(int ranks, const std::string& hostfile, char** argv);

}  // namespace pprt
