#include "cli/process/launched.h"

#include <unistd.h>

#include <cstdlib>

#include "cli/process/exit.h"

namespace pprt {
namespace {

// Returns the variable that has this process's rank, or null. PMIx (Open MPI, Slurm) names a namespace with
// it, and PMI (MPICH, Slurm) a size.
const char* rank_variable() {
  if (std::getenv("PMIX_RANK") != nullptr && std::getenv("PMIX_NAMESPACE") != nullptr) return "PMIX_RANK";
  if (std::getenv("PMI_RANK") != nullptr && std::getenv("PMI_SIZE") != nullptr) return "PMI_RANK";
  return nullptr;
}

}  // namespace

bool started_by_mpi_launcher() {
  return rank_variable() != nullptr;
}

bool started_by_pprt() {
  return std::getenv(kLauncherVariable) != nullptr && started_by_mpi_launcher();
}

int launcher_rank() {
  const char* variable = rank_variable();
  return variable == nullptr ? 0 : std::atoi(std::getenv(variable));
}

bool on_terminal() {
  const char* launched = std::getenv(kLauncherVariable);
  return isatty(STDERR_FILENO) != 0 || (launched != nullptr && launched == kFromTerminal);
}

void tell_launcher(const RankNews& news) {
  if (started_by_pprt()) print_message(to_text(news));
}

}  // namespace pprt
