// The ranks of one process: threads that share what the process holds, beside those of other processes.
//
//   process 0                        process 1
//   rank 0  rank 1  rank 2           rank 3  rank 4        threads; each has a mailbox
//     \       |       /                 \       /
//      LocalNetwork                   LocalNetwork         to a rank of this process: no copy, no system call
//           |                              |
//     the main thread ------ MPI ------ the main thread    to another process's
#pragma once

#include <functional>
#include <vector>

#include "parallel/network/local_communicator.h"
#include "parallel/network/mpi_communicator.h"

namespace pprt {

class ProcessRanks {
 public:
  // The run is this process alone.
  explicit ProcessRanks(int threads);

  // All processes of the run make theirs together; they may have different numbers of threads. Ranks are
  // numbered process by process. Only the thread that makes it calls MPI.
  ProcessRanks(MpiCommunicator& processes, int threads);

  const LocalRanks& ranks() const { return ranks_; }

  // Runs each rank of this process; returns when all have ended. A process with one rank runs it on the
  // caller's thread. The first exception of a rank ends this process's ranks and is thrown here.
  void run(const std::function<void(Communicator&)>& run_rank);

 private:
  void carry_messages(LocalNetwork& network);
  int process_of(int rank) const;

  MpiCommunicator* processes_ = nullptr;  // null: there is one
  std::vector<int> ends_;                 // of each process's ranks
  LocalRanks ranks_;
};

}  // namespace pprt
