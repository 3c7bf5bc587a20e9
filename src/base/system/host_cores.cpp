#include "base/system/host_cores.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>

namespace pprt {

CoreSet own_cores() {
  static_assert(kMostCores == CPU_SETSIZE);
  CoreSet cores;
  cpu_set_t mask;
  CPU_ZERO(&mask);
  if (sched_getaffinity(0, sizeof mask, &mask) != 0) return cores;
  for (std::size_t i = 0; i < cores.size(); ++i) cores[i] = CPU_ISSET(i, &mask) != 0;
  return cores;
}

int usable_cores() {
  return std::max(1, static_cast<int>(own_cores().count()));
}

int installed_cores() {
  return std::max(1, static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN)));
}

}  // namespace pprt
