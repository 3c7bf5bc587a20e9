#include "render/records/advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace pprt {
namespace {

// Whether frames are late often: one in twenty, and not by chance alone.
bool is_late(const RunFigures& run) {
  constexpr int kFewest = 3;
  constexpr double kShare = 0.05;
  return run.late >= kFewest && run.late > kShare * run.frames;
}

// Beyond this a viewer sees blurred and jagged edges in every frame.
bool is_coarse(const RunFigures& run) {
  constexpr double kForgivenRmse = 0.03;
  return run.least_rmse > kForgivenRmse;
}

// The rate at which 95 % of the frames would have been on time.
double punctual_rate(const RunFigures& run) {
  return 1 / (1 / run.frames_per_second + 1e-3 * std::max(0.0, run.late_p95_ms));
}

// 59.4 -> "59", 3.96 -> "3.9": never above.
std::string rate_text(double rate) {
  return rate >= 10 ? fmt::format("{:.0f}", std::floor(rate))
                    : fmt::format("{:.1f}", std::floor(10 * rate) / 10);
}

}  // namespace

std::string advice_on(const RunFigures& run) {
  if (run.frames_per_second <= 0 || (!is_late(run) && !is_coarse(run))) return "";
  std::vector<std::string> lines;
  if (is_late(run)) {
    lines.push_back(fmt::format("{} of {} frames were late; 95 % of them would not have been at --fps {}",
                                run.late, run.frames, rate_text(punctual_rate(run))));
  }
  if (is_coarse(run)) {
    const double smaller = std::sqrt(0.5);
    lines.push_back(
        fmt::format("{:.2g} samples a pixel are few; --fps {} or --size {}x{} gives twice as many",
                    run.samples_per_pixel, rate_text(run.frames_per_second / 2),
                    std::lround(run.width * smaller), std::lround(run.height * smaller)));
  }
  if (run.ranks < run.cores) {
    lines.push_back(fmt::format("{} of {} cores were used; --threads auto uses all", run.ranks, run.cores));
  } else if (run.ranks > run.cores) {
    lines.push_back(
        fmt::format("{} ranks share {} cores of this host; more hosts (--hostfile) or fewer ranks help",
                    run.ranks, run.cores));
  } else {
    lines.push_back("all cores were used; more hosts (--hostfile) help");
  }
  return fmt::format("{}", fmt::join(lines, "; "));
}

}  // namespace pprt
