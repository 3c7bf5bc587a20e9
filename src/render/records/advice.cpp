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

// Names a rate by the option or the control, which has whole rates from 1 on. Nothing where it has none.
std::vector<std::string> rate_remedy(double rate, Remedies remedies) {
  if (remedies == Remedies::kOptions) return {"--fps " + rate_text(rate)};
  if (rate < 1) return {};
  return {fmt::format("a Rate of {:.0f} {}/s", std::floor(rate), rate < 2 ? "frame" : "frames")};
}

// What gives twice as many samples a pixel: half the rate, or half the pixels.
std::vector<std::string> doubling_remedies(const RunFigures& run, Remedies remedies) {
  std::vector<std::string> found = rate_remedy(run.frames_per_second / 2, remedies);
  const double smaller = std::sqrt(0.5);
  if (remedies == Remedies::kOptions)
    found.push_back(
        fmt::format("--size {}x{}", std::lround(run.width * smaller), std::lround(run.height * smaller)));
  if (remedies == Remedies::kPage) found.emplace_back("a Size of half as many pixels");
  return found;
}

std::string on_late_frames(const RunFigures& run, Remedies remedies) {
  std::string line = fmt::format("{} of {} frames were late", run.late, run.frames);
  for (const std::string& rate : rate_remedy(punctual_rate(run), remedies))
    line += fmt::format("; 95 % of them would not have been at {}", rate);
  return line;
}

std::string on_coarse_frames(const RunFigures& run, Remedies remedies) {
  std::string line = fmt::format("{:.2g} samples a pixel are few", run.samples_per_pixel);
  const std::vector<std::string> found = doubling_remedies(run, remedies);
  if (!found.empty()) line += fmt::format("; {} gives twice as many", fmt::join(found, " or "));
  return line;
}

// The page has no control for ranks: it names the options of the next run, too.
std::string on_cores(const RunFigures& run) {
  if (run.ranks < run.cores)
    return fmt::format("{} of {} cores were used; --threads auto uses all", run.ranks, run.cores);
  if (run.ranks > run.cores)
    return fmt::format("{} ranks share {} cores of this host; more hosts (--hostfile) or fewer ranks help",
                       run.ranks, run.cores);
  return "all cores were used; more hosts (--hostfile) help";
}

}  // namespace

std::string advice_on(const RunFigures& run, Remedies remedies) {
  if (run.frames_per_second <= 0 || (!is_late(run) && !is_coarse(run))) return "";
  std::vector<std::string> lines;
  if (is_late(run)) lines.push_back(on_late_frames(run, remedies));
  if (is_coarse(run)) lines.push_back(on_coarse_frames(run, remedies));
  lines.push_back(on_cores(run));
  return fmt::format("{}", fmt::join(lines, "; "));
}

}  // namespace pprt
