#include "render/render.h"

#include <optional>

#include "cli/process/exit.h"
#include "cli/process/hostfile.h"
#include "cli/process/launch.h"
#include "cli/process/launched.h"
#include "cli/process/rank_limits.h"
#include "render/run/run_process.h"

namespace pprt {
namespace {

int start_processes(const RankOptions& ranks, bool ends_by_signal, ProgressReporter& progress,
                    std::span<const std::string> words) {
  std::optional<Hostfile> hosts;
  if (ranks.hostfile.empty()) {
    make_room_for(ranks.processes.value_or(1));
  } else {
    hosts.emplace(ranks.hostfile);
  }
  const Launch launch{.processes = ranks.processes.value_or(1),
                      .hostfile = hosts ? hosts->path() : "",
                      .goes_on = ranks.go_on,
                      .ends_by_signal = ends_by_signal};
  return run_under_mpirun(launch, words, [&](std::string_view said) { progress.overhear(said); });
}

}  // namespace

int render(const RenderOptions& options, std::span<const std::string> words) {
  ProgressReporter progress(options.progress);
  try {
    const bool is_launched = started_by_mpi_launcher();
    const bool starts_processes = options.ranks.processes.value_or(1) > 1 && !is_launched;
    const bool ends_by_signal = options.live && options.output.pictures.empty();
    const auto make_plan = [&options] { return plan_render(options); };
    const int code = starts_processes ? start_processes(options.ranks, ends_by_signal, progress, words)
                                      : run_process(make_plan, ranks_in_process(options, is_launched),
                                                    options.log, progress);
    progress.close(code);
    return code;
  } catch (const std::exception& e) {
    progress.fail(message_of(e));
    throw;
  }
}

}  // namespace pprt
