// The virtual machine of the work clock: its processors' speed and its network.
#pragma once

#include "parallel/settings/work_units.h"

namespace pprt {

struct Machine {
  double units_per_second = kWorkUnitsPerSecond;  // of one processor
  double latency_s = 2e-6;           // seconds from the end of sending to the beginning of receiving
  double bytes_per_second = 12.5e9;  // of one rank's way into the network, and of its way out
  int slow_ranks = 0;                // the first so many ranks, on slower processors:
  double slowness = 1;               // each of them takes so many times as long, at least 1

  friend bool operator==(const Machine&, const Machine&) = default;
};

// How many times as long as the other ranks this one takes.
inline double slowness_of(const Machine& machine, int rank) {
  return rank < machine.slow_ranks ? machine.slowness : 1;
}

// A present-day cluster: each rank has a core like the one that the prices were measured on, and a share of
// a 100 Gbit/s network with 2 microseconds between processes.
inline Machine cluster_machine() {
  return {1e9, 2e-6, 12.5e9};
}

// The paper's IBM SP2 (s. 6.1): POWER2 processors of 66 MHz, 40 MB/s in and out of each at once. Their speed
// is derived: 62 of them took 19,000 samples in a quarter of a second at 256x256 pixels, which costs 450,000
// units each. Latency: the paper gives less than a microsecond for the switch alone; 40 microseconds are what
// a message took between two programs.
inline Machine sp2_machine() {
  return {1.8e6, 40e-6, 40e6};
}

}  // namespace pprt
