#include "parallel/virtual_ranks.h"

#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "parallel/network/local_communicator.h"

namespace pprt {

void run_virtual_ranks(int ranks, const SessionSettings& settings,
                       const std::function<Probe(int rank)>& make_probe, const CameraSource& source,
                       const FrameSink& sink) {
  LocalNetwork network(ranks);
  std::exception_ptr first_failure;
  std::once_flag failed;
  const auto run_rank = [&](int rank) {
    LocalCommunicator communicator(network, rank);
    try {
      const Probe probe = make_probe(rank);
      if (rank == 0) {
        run_as_master(communicator, settings, probe, source, sink);
      } else {
        run_as_worker(communicator, settings, probe);
      }
    } catch (...) {
      std::call_once(failed, [&] { first_failure = std::current_exception(); });
      network.fail();
    }
  };
  std::vector<std::thread> threads;
  threads.reserve(static_cast<std::size_t>(ranks));
  for (int rank = 0; rank < ranks; ++rank) threads.emplace_back(run_rank, rank);
  for (std::thread& thread : threads) thread.join();
  if (first_failure) std::rethrow_exception(first_failure);
}

}  // namespace pprt
