// How many ranks a host has room for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace pprt {

// What the ranks of a host share.
struct HostRoom {
  unsigned cores = 1;
  std::uint64_t memory_bytes = 0;  // available
  std::uint64_t open_files = 0;    // that a process may have at most
};

// Returns why so many ranks cannot run on one host, with the figures; nullopt if they can.
//
// Measured with Open MPI 4.1.4: a small scene, 4 to 64 ranks, 2 cores. mpirun opens about 40 files, and 4 for
// each rank. With fewer it never ends. A rank needs 10 to 17 MB of its own. Its messages take up to 4 MiB. 64
// ranks start in 5 s. The time grows with the square of their number.
std::optional<std::string> lack_of_room(int ranks, const HostRoom& host);

// Lets mpirun open as many files as so many ranks need. Throws std::runtime_error with lack_of_room() of this
// host. Where a batch system chooses the hosts, nothing is known and nothing is refused.
void make_room_for(int ranks);

}  // namespace pprt
