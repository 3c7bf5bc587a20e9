// The ranks of one process: threads that share what the process holds, beside those of other processes.
// Each rank has a mailbox in its process's LocalNetwork. A message to a rank of the same process is moved
// there. One to another process waits in the outbox. The main thread sends it by MPI, and delivers what
// comes.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "parallel/network/local_communicator.h"
#include "parallel/network/mpi_communicator.h"

namespace pprt {

inline constexpr int kMostThreads = 256;  // ranks in a process, by command line

class ProcessRanks {
 public:
  // The run is this process alone.
  explicit ProcessRanks(int threads);

  // All processes of the run make theirs together; they may have different numbers of threads. Ranks are
  // numbered process by process. Only the thread that makes it calls MPI.
  ProcessRanks(MpiCommunicator& processes, int threads);

  const LocalRanks& ranks() const { return ranks_; }

  // Returns the name of the host that a rank runs on; empty where the run is this process alone.
  std::string host_of(int rank) const;

  // Runs each rank of this process; returns when all have ended. Where each process has one rank, it
  // runs on the caller's thread and calls MPI itself. The first exception of a rank ends this process's ranks
  // and is thrown here.
  void run(const std::function<void(Communicator&)>& run_rank);

 private:
  void carry_messages(LocalNetwork& network);
  void give_up_processes(const LocalNetwork& network);
  int process_of(int rank) const;

  MpiCommunicator* processes_ = nullptr;  // null: there is one
  std::vector<int> ends_;                 // of each process's ranks
  std::vector<std::string> hosts_;        // of each process
  LocalRanks ranks_;
};

}  // namespace pprt
