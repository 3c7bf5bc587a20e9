#include "study/paper/measures.h"

#include <algorithm>
#include <cmath>

namespace pprt {

double relative_deviation(const FrameMeasures& m) {
  return m.mean_weight_deviation / m.mean_weight;
}

double received_per_sample(const FrameMeasures& m) {
  return static_cast<double>(m.samples_received) / static_cast<double>(m.samples);
}

double cpu_ms(const FrameMeasures& m) {
  return m.cpu_ms.sampling + m.cpu_ms.casting + m.cpu_ms.reconstruction + m.cpu_ms.balancing;
}

FrameMeasure time_of(double StageTimes::*stage) {
  return [stage](const FrameMeasures& m) { return m.cpu_ms.*stage; };
}

FrameMeasure kilobytes_of(std::uint64_t BytesSent::*kind) {
  return [kind](const FrameMeasures& m) { return 1e-3 * static_cast<double>(m.bytes.*kind); };
}

double mean(const MeasuredRun& run, Frames frames, const FrameMeasure& measure) {
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
    if (r.experiment == experiment && (!choice || choice(r))) found.push_back(&r);
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

std::vector<int> Runs::distinct(std::string_view experiment, int PaperRun::*member) const {
  std::vector<int> values;
  for (const MeasuredRun* r : all(experiment)) values.push_back(r->*member);
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

std::vector<Speedup> speedups(const Runs& runs) {
  std::vector<Speedup> values;
  const auto refinement = [](const MeasuredRun& run) {
    return mean(run, kStill, &FrameMeasures::mean_weight);
  };
  for (const int side : runs.distinct(kScaling, &PaperRun::side)) {
    for (const int ranks : runs.distinct(kScaling, &PaperRun::ranks)) {
      const auto is_this = [=](const PaperRun& run) { return run.side == side && run.ranks == ranks; };
      if (runs.all(kScaling, is_this).empty()) continue;
      const auto on_ranks = [&](int count) {
        return refinement(runs.find(kScaling, [=](const PaperRun& run) {
          return run.side == side && run.ranks == count && run.balance == BalanceMode::kCombined;
        }));
      };
      const MeasuredRun& short_frame = runs.find(kShortFrame, [=](const PaperRun& run) {
        return run.side == side && std::abs(run.share * ranks - 1) < 1e-9;
      });
      const double here = on_ranks(ranks);
      values.push_back({ranks, side, refinement(short_frame) / here, on_ranks(1) / here});
    }
  }
  return values;
}

Table frames_table(const PaperResults& results) {
  using Run = MeasuredRun;
  using F = FrameMeasures;
  const Columns<Run> of_run = {
      {"experiment", &Run::experiment},
      {"sequence", &Run::sequence},
      {"ranks", &Run::ranks},
      {"side [pixels]", &Run::side},
      {"balance", &Run::balance},
      {"cast", &Run::cast},
      {"keep samples", [](const Run& run) { return word_for(run.keep_samples); }},
      {"share of work", &Run::share},
      {"latency [s]", [](const Run& run) { return run.machine.latency_s; }},
      {"bandwidth [bytes/s]", [](const Run& run) { return run.machine.bytes_per_second; }}};
  const auto bytes_of = [](std::uint64_t BytesSent::*kind) {
    return [kind](const F& m) { return m.bytes.*kind; };
  };
  const Columns<F> of_frame = {{"frame", &F::number},
                               {"mean_weight", &F::mean_weight},
                               {"deviation", &F::mean_weight_deviation},
                               {"distance to serial", &F::distance},
                               {"density at borders", &F::border_density},
                               {"samples", &F::samples},
                               {"samples cast", &F::samples_cast},
                               {"samples received", &F::samples_received},
                               {"repartitioned", &F::repartitioned},
                               {"late [ms]", &F::late_ms},
                               {"sampling [ms]", time_of(&StageTimes::sampling)},
                               {"casting [ms]", time_of(&StageTimes::casting)},
                               {"reconstruction [ms]", time_of(&StageTimes::reconstruction)},
                               {"balancing [ms]", time_of(&StageTimes::balancing)},
                               {"idle [ms]", time_of(&StageTimes::idle)},
                               {"sample bytes", bytes_of(&BytesSent::samples)},
                               {"progress bytes", bytes_of(&BytesSent::progress)},
                               {"balance bytes", bytes_of(&BytesSent::balance)},
                               {"pixel bytes", bytes_of(&BytesSent::pixels)},
                               {"picture hash", &F::picture_hash}};
  return table_of_parts(results.runs, &Run::frames, of_run, of_frame);
}

}  // namespace pprt
