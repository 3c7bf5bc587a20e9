// A whole run inside one process: a thread for every rank. Under the work clock it gives the same frames as
// ranks under MPI, so that studies of many ranks need neither MPI nor as many copies of the scene.
#pragma once

#include <functional>

#include "parallel/session.h"

namespace pprt {

// Runs all ranks; returns when every frame has been delivered to the sink. Rank 0 runs on the caller's
// thread, and so the sink. `make_probe` is called once a rank, on that rank's thread; what the probe refers
// to must outlive the call. The first exception of a rank ends all of them and is thrown here.
void run_virtual_ranks(int ranks, const SessionSettings& settings,
                       const std::function<Probe(int rank)>& make_probe, const CameraSource& source,
                       const FrameSink& sink);

}  // namespace pprt
