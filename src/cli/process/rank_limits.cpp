#include "cli/process/rank_limits.h"

#include <fmt/core.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "base/counted.h"
#include "base/system/available_memory.h"

namespace pprt {
namespace {

constexpr std::uint64_t kFiles = 64, kFilesOfARank = 4;
constexpr std::uint64_t kBytesOfARank = 16'000'000 + (std::uint64_t{4} << 20);
constexpr unsigned kMostRanksPerCore = 128;

std::uint64_t files_for(int ranks) {
  return kFiles + kFilesOfARank * static_cast<std::uint64_t>(ranks);
}

// Whether a batch system, or a file in Open MPI's settings, names the hosts.
bool hosts_are_given() {
  constexpr const char* kSigns[] = {"SLURM_JOB_ID", "PBS_JOBID", "LSB_JOBID", "PE_HOSTFILE",
                                    "OMPI_MCA_orte_default_hostfile"};
  return std::any_of(std::begin(kSigns), std::end(kSigns),
                     [](const char* sign) { return std::getenv(sign) != nullptr; });
}

}  // namespace

std::optional<std::string> lack_of_room(int ranks, const HostRoom& host) {
  const auto count = static_cast<std::uint64_t>(ranks);
  if (count > std::uint64_t{kMostRanksPerCore} * host.cores) {
    return fmt::format("{} ranks are too many for this host: it has {}, with room for {} ranks each", ranks,
                       counted(host.cores, "core", "cores"), kMostRanksPerCore);
  }
  if (count * kBytesOfARank > host.memory_bytes) {
    return fmt::format(
        "{} ranks are too many for this host: they need at least {} MB of memory, of which {} MB are free",
        ranks, count * kBytesOfARank / 1'000'000, host.memory_bytes / 1'000'000);
  }
  if (files_for(ranks) > host.open_files) {
    return fmt::format("{} ranks are too many: mpirun would open {} files, and 'ulimit -Hn' allows {}", ranks,
                       files_for(ranks), host.open_files);
  }
  return std::nullopt;
}

void make_room_for(int ranks) {
  if (hosts_are_given()) return;
  rlimit files{};
  getrlimit(RLIMIT_NOFILE, &files);
  const HostRoom host{std::max(1u, std::thread::hardware_concurrency()), available_memory(), files.rlim_max};
  if (const std::optional<std::string> lack = lack_of_room(ranks, host)) {
    throw std::runtime_error(*lack + "; --hostfile adds hosts");
  }
  if (files.rlim_cur >= files_for(ranks)) return;
  files.rlim_cur = files_for(ranks);
  setrlimit(RLIMIT_NOFILE, &files);
}

}  // namespace pprt
