#include "study/paper/measures.h"

#include <algorithm>
#include <cmath>

namespace pprt {
namespace {

std::vector<int> in_order(std::vector<int> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

}  // namespace

double mean(const MeasuredRun& run, Frames frames, const Measure& measure) {
  double sum = 0;
  int count = 0;
  for (const FrameMeasures& m : run.frames) {
    if (m.frame < frames.first || m.frame > frames.last) continue;
    sum += measure(m);
    ++count;
  }
  return count > 0 ? sum / count : kNoValue;
}

double frames_to_settle(const MeasuredRun& run, Frames part, double level) {
  if (run.frames.empty() || run.frames.back().frame < part.last) return kNoValue;
  for (const FrameMeasures& m : run.frames) {
    if (m.frame < part.first || m.frame > part.last || !(relative_deviation(m) <= level)) continue;
    if (mean(run, {m.frame, part.last}, relative_deviation) <= level) return m.frame - part.first + 1;
  }
  return kNever;
}

double worst_loss(const MeasuredRun& run) {
  double worst = kNoValue;
  for (std::size_t i = 1; i < run.frames.size(); ++i) {
    if (!run.frames[i].repartitioned) continue;
    const double loss = std::max(0.0, 1 - run.frames[i].samples / run.frames[i - 1].samples);
    worst = std::isnan(worst) ? loss : std::max(worst, loss);
  }
  return worst;
}

int repartitions(const MeasuredRun& run) {
  return static_cast<int>(std::count_if(run.frames.begin(), run.frames.end(),
                                        [](const FrameMeasures& m) { return m.repartitioned; }));
}

std::vector<const MeasuredRun*> Runs::all(std::string_view experiment) const {
  std::vector<const MeasuredRun*> found;
  for (const MeasuredRun& r : results_.runs) {
    if (r.run.experiment == experiment) found.push_back(&r);
  }
  return found;
}

const MeasuredRun& Runs::find(std::string_view experiment,
                              const std::function<bool(const PaperRun&)>& choice) const {
  for (const MeasuredRun* r : all(experiment)) {
    if (choice(r->run)) return *r;
  }
  return none_;
}

const MeasuredRun& Runs::find(std::string_view experiment, int ranks, BalanceMode balance) const {
  return find(experiment, [&](const PaperRun& run) { return run.ranks == ranks && run.balance == balance; });
}

std::vector<int> Runs::ranks_of(std::string_view experiment) const {
  std::vector<int> ranks;
  for (const MeasuredRun* r : all(experiment)) ranks.push_back(r->run.ranks);
  return in_order(std::move(ranks));
}

std::vector<int> Runs::sides_of(std::string_view experiment) const {
  std::vector<int> sides;
  for (const MeasuredRun* r : all(experiment)) sides.push_back(r->run.side);
  return in_order(std::move(sides));
}

std::vector<Speedup> speedups(const Runs& runs) {
  constexpr Frames kStill = {5, 10};
  std::vector<Speedup> values;
  for (const MeasuredRun* r : runs.all(kScaling)) {
    if (r->run.balance != BalanceMode::kCombined) continue;
    const auto same_side = [&](const PaperRun& run) { return run.side == r->run.side; };
    const MeasuredRun& alone = runs.find(kScaling, [&](const PaperRun& run) {
      return same_side(run) && run.ranks == 1 && run.balance == BalanceMode::kCombined;
    });
    const MeasuredRun& short_frame = runs.find(kShortFrame, [&](const PaperRun& run) {
      return same_side(run) && std::abs(run.share * r->run.ranks - 1) < 1e-9;
    });
    const double here = mean(*r, kStill, refinement);
    values.push_back({r->run.ranks, r->run.side, mean(short_frame, kStill, refinement) / here,
                      mean(alone, kStill, refinement) / here});
  }
  return values;
}

}  // namespace pprt
