#include "study/paper/paper_options.h"

#include <cmath>

#include "study/paper/runs.h"

namespace pprt {

PaperOptions settled(PaperOptions options) {
  if (options.ranks.empty()) options.ranks = options.quick ? std::vector{4, 6} : std::vector{32, 62};
  if (options.frames == 0) options.frames = options.quick ? 6 : 40;
  return options;
}

int picture_side(const PaperOptions& options) {
  constexpr int kQuickSide = 96;
  return options.quick ? kQuickSide : kPaperSide;
}

Machine machine_of(const PaperOptions& options) {
  Machine machine = options.machine == MachineKind::kSp2 ? sp2_machine() : cluster_machine();
  if (!std::isnan(options.latency_us)) machine.latency_s = options.latency_us * 1e-6;
  if (!std::isnan(options.bandwidth_mb_s)) machine.bytes_per_second = options.bandwidth_mb_s * 1e6;
  return machine;
}

}  // namespace pprt
