// One run on all ranks, from the first order to the last frame. worker.h shows how ranks work together in
// one.
#pragma once

#include <functional>

#include "base/probe.h"
#include "parallel/clock/host_time.h"
#include "parallel/master/loss_watch.h"
#include "parallel/master/master.h"
#include "parallel/network/communicator.h"
#include "parallel/rank/frame_goal.h"
#include "parallel/settings/session_settings.h"

namespace pprt {

// What may happen to a run on the wall clock besides its frames. Called on the master's thread.
struct SessionEvents {
  // A rank's clock was found to have gone ahead by so many seconds more than it should.
  std::function<void(int rank, double seconds)> clock_jumped = [](int, double) {};
  LossRule loss = {};
  // Without a rate: how far rank 0 is in its frame. Called after each of its packets of samples.
  std::function<void(const SamplingProgress&)> sampled = {};
  // Without a rate: whether frames need not get better than they are. Asked often; true stays true.
  std::function<bool()> is_enough = [] { return false; };
};

// Both return when every frame has been delivered to the master's sink. Throw std::runtime_error when ranks
// do not answer and the run cannot go on without them. All ranks get equal settings. A worker's `now` tells
// the time as monotonic_seconds() does, since a moment of its own.
void run_as_master(Communicator& network, const SessionSettings& settings, const Probe& probe,
                   const CameraSource& source, const FrameSink& sink, const SessionEvents& events = {});
void run_as_worker(Communicator& network, const SessionSettings& settings, const Probe& probe,
                   std::function<double()> now = monotonic_seconds);

// Returns the tiles of the image: the units of balancing, which suit the sampler.
TileGrid tile_grid(const SessionSettings& settings, int ranks);

// Returns the partition of the first frame: regions of equal areas.
Partition equal_areas(const TileGrid& grid, int ranks);

// A frame's budget in work units when the user gives none: what the virtual processor does in one period.
std::uint64_t default_budget_units(double frames_per_second);

}  // namespace pprt
