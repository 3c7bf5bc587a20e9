// What a process knows of the launcher that has started it, and tells it.
#pragma once

#include "cli/process/rank_news.h"

namespace pprt {

// Set by run_under_mpirun() for the ranks: whether the pipe that is their standard error ends at a terminal.
inline constexpr const char* kLauncherVariable = "PPRT_LAUNCHED";
inline constexpr std::string_view kFromTerminal = "from-terminal", kFromElsewhere = "from-elsewhere";

// Whether run_under_mpirun() has started this process.
bool started_by_pprt();

// Whether any MPI launcher has. A variable that merely has the name of one of its own does not count.
bool started_by_mpi_launcher();

// Returns this process's rank as its launcher tells it before MPI begins; 0 without a launcher.
int launcher_rank();

// Whether standard error is a terminal, also when run_under_mpirun() stands between.
bool on_terminal();

// Tells run_under_mpirun() something, if it stands between.
void tell_launcher(const RankNews& news);

}  // namespace pprt
