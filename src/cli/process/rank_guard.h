// A process beside each rank that tells the launcher what becomes of the rank.
#pragma once

namespace pprt {

// Returns in a new process, which is the rank. The process that called becomes its guard and never returns:
// - It tells run_under_mpirun() once a second that it is there, and when a signal kills, stops or continues
//   the rank.
// - It kills the rank when mpirun, or its daemon on this host, has ended. A guard that is killed takes the
//   rank along.
// - It ends as the rank does, so mpirun sees what it would see without a guard.
// To be called before any thread begins, and only where run_under_mpirun() has started this process.
void guard_this_rank();

}  // namespace pprt
