#include "parallel/virtual_ranks.h"

#include "parallel/network/local_communicator.h"

namespace pprt {

void run_virtual_ranks(int ranks, const SessionSettings& settings,
                       const std::function<Probe(int rank)>& make_probe, const CameraSource& source,
                       const FrameSink& sink) {
  LocalNetwork network(ranks);
  run_on_threads(network, [&](Communicator& rank) {
    const Probe probe = make_probe(rank.rank());
    if (rank.rank() == 0) {
      run_as_master(rank, settings, probe, source, sink);
    } else {
      run_as_worker(rank, settings, probe);
    }
  });
}

}  // namespace pprt
