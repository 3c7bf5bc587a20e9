#include "study/rate/held_rates.h"

#include <cmath>
#include <utility>
#include <vector>

#include "image/metrics.h"
#include "study/frame_series.h"

namespace pprt {
TrueFilm true_film_of(const MovingScene& moving, const JudgedFilm& judged) {
  constexpr double kRounding = 1e-6;  // of a picture
  std::vector<Image> pictures;
  for (int i = 0; i < judged.seconds * judged.rate - kRounding; ++i) {
    const Subject subject = subject_at(moving, judged.begin_s + i / judged.rate, judged.size);
    pictures.push_back(converged_reference(subject, judged.cells).image);
  }
  return true_film(judged.rate, judged.begin_s, std::move(pictures));
}

RateResult measure_held(SamplerChoice sampler, double fps, const HeldRun& run) {
  SessionSettings settings{.sampler = sampler};
  settings.width = run.film.pictures.front().width;
  settings.height = run.film.pictures.front().height;
  settings.clock = ClockKind::kWork;
  settings.machine = cluster_machine();
  settings.machine.units_per_second = run.units_per_second;
  settings.frames_per_second = fps;
  settings.budget_units = static_cast<std::uint64_t>(run.units_per_second / fps);
  settings.seed = run.seed;
  std::vector<Image> pictures;
  double samples = 0;
  const int last = frame_seen_at(run.film.moment(run.film.pictures.size() - 1), fps, 1 / fps);
  const std::vector<FrameRequest> frames = frames_at(run.moving, fps, last + 1, settings.width);
  render_series(run.moving.scene, frames, run.ranks, settings, [&](FinishedFrame&& frame) {
    for (const RankReport& rank : frame.ranks) samples += static_cast<double>(rank.samples_in_region);
    pictures.push_back(clamped_to_display(frame.image));
  });
  const double pixels = static_cast<double>(settings.width) * settings.height;
  return {.sampler = sampler,
          .fps = fps,
          .held = errors_of({fps, 1 / fps, pictures}, run.film),
          .samples = samples / (pixels * static_cast<double>(pictures.size()))};
}

}  // namespace pprt
