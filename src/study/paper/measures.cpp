#include "study/paper/measures.h"

#include <algorithm>
#include <cmath>

namespace pprt {

double relative_deviation(const FrameMeasures& m) {
  return m.refinement_deviation / m.refinement;
}

double received_per_sample(const FrameMeasures& m) {
  return static_cast<double>(m.samples_received) / static_cast<double>(m.samples);
}

double cpu_ms(const FrameMeasures& m) {
  return m.cpu_ms.sampling + m.cpu_ms.casting + m.cpu_ms.reconstruction + m.cpu_ms.balancing;
}

double mean(const MeasuredRun& run, Frames frames, const Measure& measure) {
  double sum = 0;
  int count = 0;
  for (const FrameMeasures& m : run.frames) {
    if (m.number < frames.first || m.number > frames.last) continue;
    sum += measure(m);
    ++count;
  }
  return count > 0 ? sum / count : kNoValue;
}

double frames_to_settle(const MeasuredRun& run, Frames part, double level) {
  if (std::isnan(level) || run.frames.empty() || run.frames.back().number < part.last) return kNoValue;
  for (const FrameMeasures& m : run.frames) {
    if (m.number < part.first || m.number > part.last || !(relative_deviation(m) <= level)) continue;
    if (mean(run, {m.number, part.last}, relative_deviation) <= level) return m.number - part.first + 1;
  }
  return kNever;
}

double worst_loss(const MeasuredRun& run) {
  const auto samples = [&](std::size_t i) { return static_cast<double>(run.frames[i].samples); };
  double worst = kNoValue;
  for (std::size_t i = 1; i < run.frames.size(); ++i) {
    if (!run.frames[i].repartitioned) continue;
    const double loss = std::max(0.0, 1 - samples(i) / samples(i - 1));
    worst = std::isnan(worst) ? loss : std::max(worst, loss);
  }
  return worst;
}

int repartitions(const MeasuredRun& run) {
  return static_cast<int>(std::count_if(run.frames.begin(), run.frames.end(),
                                        [](const FrameMeasures& m) { return m.repartitioned; }));
}

std::vector<const MeasuredRun*> Runs::all(std::string_view experiment, const Choice& choice) const {
  std::vector<const MeasuredRun*> found;
  for (const MeasuredRun& r : results_.runs) {
    if (r.run.experiment == experiment && (!choice || choice(r.run))) found.push_back(&r);
  }
  return found;
}

const MeasuredRun& Runs::find(std::string_view experiment, const Choice& choice) const {
  const std::vector<const MeasuredRun*> found = all(experiment, choice);
  return found.empty() ? none_ : *found.front();
}

const MeasuredRun& Runs::find(std::string_view experiment, int ranks, BalanceMode balance) const {
  return find(experiment, [&](const PaperRun& run) { return run.ranks == ranks && run.balance == balance; });
}

std::vector<int> Runs::values_of(std::string_view experiment, int PaperRun::*member) const {
  std::vector<int> values;
  for (const MeasuredRun* r : all(experiment)) values.push_back(r->run.*member);
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

std::vector<Speedup> speedups(const Runs& runs) {
  constexpr auto kRefinement = &FrameMeasures::refinement;
  std::vector<Speedup> values;
  for (const MeasuredRun* r : runs.all(kScaling)) {
    if (r->run.balance != BalanceMode::kCombined) continue;
    const auto [ranks, side] = std::pair(r->run.ranks, r->run.side);
    const MeasuredRun& same_work = runs.find(kScaling, [side = side](const PaperRun& run) {
      return run.side == side && run.ranks == 1 && run.balance == BalanceMode::kCombined;
    });
    const MeasuredRun& same_frame = runs.find(kShortFrame, [ranks = ranks, side = side](const PaperRun& run) {
      return run.side == side && std::abs(run.share * ranks - 1) < 1e-9;
    });
    const double here = mean(*r, kStill, kRefinement);
    values.push_back({ranks, side, mean(same_frame, kStill, kRefinement) / here,
                      mean(same_work, kStill, kRefinement) / here});
  }
  return values;
}

}  // namespace pprt
