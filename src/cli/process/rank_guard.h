// A process beside each rank that tells the launcher what becomes of the rank.
#pragma once

namespace pprt {

// Returns in a new process, which is the rank. The process that called becomes its guard and never returns:
// - It tells run_under_mpirun() that it is there, and when a signal kills, stops or continues the rank. On
// the
//   launcher's host it says once a second that it is there. From another host nothing may come regularly: the
//   system asks only a silent connection whether the other host still answers.
// - It kills the rank when mpirun, or its daemon on this host, has ended. A guard that is killed takes the
//   rank along.
// - It ends as the rank does, so mpirun sees what it would see without a guard.
// To be called before any thread begins, and only where run_under_mpirun() has started this process.
void guard_this_rank();

}  // namespace pprt
