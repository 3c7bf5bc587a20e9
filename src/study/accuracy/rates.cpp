#include "study/accuracy/rates.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <exception>
#include <iterator>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "image/metrics.h"
#include "parallel/virtual_ranks.h"
#include "study/accuracy/reference.h"
#include "study/accuracy/verdicts.h"
#include "study/cast_errors.h"
#include "trace/tracer_probe.h"

namespace pprt {
namespace {

// The vector turned about a unit axis (Rodrigues).
Vec3d turned(const Vec3d& v, const Vec3d& axis, double degrees) {
  const double angle = degrees * M_PI / 180;
  return v * std::cos(angle) + axis.cross(v) * std::sin(angle) + axis * (axis.dot(v) * (1 - std::cos(angle)));
}

SessionSettings session_settings(const RateSettings& settings, const Camera& camera, CastChoice cast,
                                 double fps) {
  SessionSettings s;
  s.width = camera.width;
  s.height = camera.height;
  s.clock = ClockKind::kWork;
  s.machine = cluster_machine();
  s.machine.units_per_second = settings.units_per_second;
  s.frames_per_second = fps;
  s.budget_units = static_cast<std::uint64_t>(settings.units_per_second / fps);
  s.cast = cast;
  s.seed = settings.seed;
  return s;
}

// Of every frame.
struct Told {
  std::vector<Image> pictures;
  std::vector<double> late_ms;
  std::vector<double> samples;
};

Told play(const CompiledScene& scene, const std::vector<Shot>& shots, int ranks,
          const SessionSettings& settings) {
  std::vector<Tracer> tracers(static_cast<std::size_t>(ranks), Tracer(scene, Camera()));
  Told told;
  run_virtual_ranks(
      ranks, settings, [&](int rank) { return probe_of(tracers[static_cast<std::size_t>(rank)]); },
      [&](int index) -> std::optional<FrameRequest> {
        if (index >= static_cast<int>(shots.size())) return std::nullopt;
        const Shot& shot = shots[static_cast<std::size_t>(index)];
        return FrameRequest{index + 1, shot.camera, shot.cut};
      },
      [&](FinishedFrame&& frame) {
        told.pictures.push_back(clamped_to_display(frame.image));
        told.late_ms.push_back(frame.late_ms);
        double& samples = told.samples.emplace_back(0);
        for (const RankReport& r : frame.ranks) samples += static_cast<double>(r.samples_in_region);
      });
  return told;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

RatePoint measure(const std::string& name, const CompiledScene& scene, const std::vector<Shot>& shots,
                  const std::vector<Image>& references, const RateSettings& settings, CastChoice cast,
                  double fps) {
  const Camera& camera = shots.front().camera;
  Told told = play(scene, shots, settings.ranks, session_settings(settings, camera, cast, fps));
  RatePoint point;
  point.scene = name, point.cast = cast, point.fps = fps;
  judge_sequence(shots, told.pictures, references, point);
  point.samples = mean_of(told.samples) / (static_cast<double>(camera.width) * camera.height);
  return point;
}

// Until the first frame from `cut` on whose error is at most `enough`.
double frames_until(const std::vector<double>& errors, std::size_t cut, double enough) {
  std::size_t i = cut;
  while (i < errors.size() && errors[i] > enough) ++i;
  return static_cast<double>(i - cut);
}

// y where x is on the polyline through (x, y) by increasing x, in logarithms; NaN outside.
double interpolated(const std::vector<std::pair<double, double>>& line, double x) {
  if (line.size() == 1 && line.front().first == x) return line.front().second;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const auto& [x0, y0] = line[i - 1];
    const auto& [x1, y1] = line[i];
    if (x < std::min(x0, x1) || x > std::max(x0, x1)) continue;
    if (x0 == x1) return y0;
    return y0 * std::pow(y1 / y0, std::log(x / x0) / std::log(x1 / x0));
  }
  return kNoValue;
}

}  // namespace

std::vector<Shot> sequence_of(const CompiledScene& scene, const View& view, const Animation* script, int size,
                              int most) {
  constexpr int kFrames = 6;
  constexpr double kStep = 2, kJump = 120;  // degrees
  View base = view;
  base.width = base.height = size;
  std::vector<Shot> shots;
  const int frames = std::min(most, script ? script->frames : kFrames);
  for (int frame = 1; frame <= frames; ++frame) {
    if (script) {
      shots.push_back({scene.camera(view_at(*script, frame, base)), cut_before(*script, frame)});
      continue;
    }
    const bool second = frame > kFrames / 2;
    View here = base;
    const Vec3d axis = view.up / std::sqrt(view.up.dot(view.up));
    here.from = view.at + turned(view.from - view.at, axis, kStep * (frame - 1) + (second ? kJump : 0));
    shots.push_back({scene.camera(here), frame == kFrames / 2 + 1});
  }
  return shots;
}

std::vector<Shot> orbit_of(const CompiledScene& scene, const View& view, int size, double fps, int frames) {
  constexpr double kDegreesPerSecond = 14.4;
  View here = view;
  here.width = here.height = size;
  const Vec3d axis = view.up / std::sqrt(view.up.dot(view.up));
  std::vector<Shot> shots;
  for (int frame = 0; frame < frames; ++frame) {
    here.from = view.at + turned(view.from - view.at, axis, kDegreesPerSecond / fps * frame);
    shots.push_back({scene.camera(here), false});
  }
  return shots;
}

double measured_units_per_second(const Subject& subject) {
  constexpr double kUnits = 2e8;
  RateSettings settings;
  settings.units_per_second = kUnits;
  const SessionSettings session = session_settings(settings, subject.camera, CastChoice::kOff, 1);
  const std::clock_t begin = std::clock();
  play(subject.scene, {{subject.camera, false}}, 1, session);
  return kUnits * CLOCKS_PER_SEC / static_cast<double>(std::max<std::clock_t>(1, std::clock() - begin));
}

std::vector<RatePoint> measure_rates(const std::string& name, const CompiledScene& scene,
                                     const std::vector<Shot>& shots, const std::vector<Image>& references,
                                     const RateSettings& settings) {
  const std::size_t ways = settings.casts.size();
  std::vector<RatePoint> points(ways * settings.rates.size());
  std::atomic<std::size_t> next = 0;
  std::mutex failing;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t i = next++; i < points.size(); i = next++) {
      try {
        points[i] = measure(name, scene, shots, references, settings, settings.casts[i % ways],
                            settings.rates[i / ways]);
      } catch (...) {
        const std::lock_guard lock(failing);
        failure = std::current_exception();
        next = points.size();
      }
    }
  };
  {
    std::vector<std::jthread> workers(std::max(1u, std::thread::hardware_concurrency()));
    for (std::jthread& worker : workers) worker = std::jthread(work);
  }
  if (failure) std::rethrow_exception(failure);
  return points;
}

Punctuality measure_in_real_time(const std::string& name, const CompiledScene& scene,
                                 const std::vector<Shot>& shots, const std::vector<Image>& references,
                                 const RateSettings& settings, CastChoice cast, double fps) {
  constexpr double kSeconds = 2;
  const Camera& camera = shots.front().camera;
  const auto rounds =
      static_cast<std::size_t>(std::max(1.0, std::ceil(kSeconds * fps / static_cast<double>(shots.size()))));
  std::vector<Shot> played;
  for (std::size_t round = 0; round < rounds; ++round) {
    played.insert(played.end(), shots.begin(), shots.end());
    played[round * shots.size()].cut = true;
  }
  SessionSettings session = session_settings(settings, camera, cast, fps);
  session.clock = ClockKind::kWall;
  Told told = play(scene, played, settings.ranks, session);

  Punctuality point;
  point.scene = name, point.cast = cast, point.fps = fps, point.ranks = settings.ranks;
  point.frames = static_cast<int>(told.pictures.size());
  for (std::size_t i = 0; i < told.pictures.size(); ++i)
    point.rmse += rmse_of(told.pictures[i], references[i % shots.size()]) / point.frames;
  point.fewest_samples = fewest_after_fifth(told.samples);
  point.samples = mean_of(told.samples) / (static_cast<double>(camera.width) * camera.height);
  std::vector<double>& late = told.late_ms;
  std::sort(late.begin(), late.end());
  const auto quantile = [&](double q) {
    return late[static_cast<std::size_t>(std::ceil(q * static_cast<double>(late.size() - 1)))];
  };
  point.late_p50_ms = quantile(0.5), point.late_p95_ms = quantile(0.95), point.late_p99_ms = quantile(0.99);
  point.late_max_ms = late.back();
  point.on_time =
      static_cast<double>(std::count_if(late.begin(), late.end(), [](double ms) { return ms <= 0; })) /
      point.frames;
  return point;
}

double fewest_after_fifth(std::span<const double> samples_of_frames) {
  constexpr std::size_t kSettling = 5;
  const auto settled = samples_of_frames.subspan(std::min(kSettling, samples_of_frames.size() - 1));
  return *std::min_element(settled.begin(), settled.end());
}

double uniform_rmse_in(double seconds, const CompiledScene& scene, const std::vector<Shot>& shots,
                       const std::vector<Image>& references) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const Image uniform = uniform_picture_in(seconds, {scene, shots[i].camera}, thread_cpu_seconds);
    errors.push_back(rmse_of(clamped_to_display(uniform), references[i]));
  }
  return mean_of(errors);
}

std::vector<Punctuality> measure_punctuality(const std::string& name, const CompiledScene& scene,
                                             const std::vector<Shot>& shots,
                                             const std::vector<Image>& references,
                                             const RateSettings& settings) {
  std::vector<Punctuality> points;
  for (const double fps : settings.rates) {
    points.push_back(measure_in_real_time(name, scene, shots, references, settings, CastChoice::kAuto, fps));
    points.back().uniform_rmse = uniform_rmse_in(settings.ranks / fps, scene, shots, references);
  }
  return points;
}

void judge_sequence(const std::vector<Shot>& shots, const std::vector<Image>& pictures,
                    const std::vector<Image>& references, RatePoint& point) {
  if (pictures.size() != shots.size() || references.size() != shots.size() || shots.empty()) {
    throw std::invalid_argument("a sequence needs a picture and a reference for every frame");
  }
  std::vector<double> errors, after_cut, others, recovery;
  double wrong = 0, own = 0;
  for (std::size_t i = 0; i < shots.size(); ++i) {
    errors.push_back(rmse_of(pictures[i], references[i]));
    if (i == 0 || shots[i].cut) {
      after_cut.push_back(errors[i]);
      continue;
    }
    others.push_back(errors[i]);
    wrong += std::pow(flicker(pictures[i - 1], pictures[i], references[i - 1], references[i]), 2);
    own += std::pow(rmse_of(references[i - 1], references[i]), 2);
  }
  const double enough = 1.1 * spread_of(others.empty() ? errors : others).median;
  for (std::size_t i = 0; i < shots.size(); ++i) {
    if (i == 0 || shots[i].cut) recovery.push_back(frames_until(errors, i, enough));
  }
  point.rmse = mean_of(errors);
  point.rmse_after_cut = mean_of(after_cut);
  point.recovery = mean_of(recovery);
  point.flicker = own > 0 ? std::sqrt(wrong / own) : kNoValue;
}

std::string plan(const std::string& scene, const std::vector<RatePoint>& points, const Wish& wish) {
  std::vector<std::pair<double, double>> line;  // rate, error
  for (const RatePoint& p : points) {
    if (p.scene == scene && p.cast == CastChoice::kAuto) line.emplace_back(p.fps, p.rmse);
  }
  if (line.empty()) throw std::invalid_argument("nothing was measured of " + scene);
  std::sort(line.begin(), line.end());
  const auto& [slowest, least] = line.front();
  const auto& [fastest, most] = line.back();
  if (wish.fps) {
    const double rmse = interpolated(line, *wish.fps);
    if (!std::isnan(rmse))
      return fmt::format("{}: at {:g} frames/s the RMSE will be about {:.4f}.", scene, *wish.fps, rmse);
    return *wish.fps < slowest ? fmt::format("{}: below {:g} frames/s the RMSE will be {:.4f} or less.",
                                             scene, slowest, least)
                               : fmt::format("{}: above {:g} frames/s the RMSE will be {:.4f} or more.",
                                             scene, fastest, most);
  }
  const double wanted = wish.rmse.value_or(0);
  if (wanted >= most)
    return fmt::format("{}: an RMSE of {:g} is kept at {:g} frames/s and more.", scene, wanted, fastest);
  if (wanted < least) {
    return fmt::format("{}: an RMSE of {:g} needs less than {:g} frame/s, at which it is {:.4f}.", scene,
                       wanted, slowest, least);
  }
  // The fastest rate that still has it.
  std::reverse(line.begin(), line.end());
  for (auto& [x, y] : line) std::swap(x, y);
  return fmt::format("{}: an RMSE of {:g} can be had at about {:.3g} frames/s.", scene, wanted,
                     interpolated(line, wanted));
}

std::string plan_in_real_time(std::span<const Punctuality> with, std::span<const Punctuality> without,
                              std::span<const double> uniform_rmse) {
  if (with.empty() || with.size() != without.size() || with.size() != uniform_rmse.size())
    throw std::invalid_argument("a turn has a run with casting, one without and uniform grids");
  int frames = 0;
  double on_time = 0, late_max_ms = with.front().late_max_ms, fewest = with.front().fewest_samples;
  std::vector<double> rmse, over_without, over_uniform;
  for (std::size_t i = 0; i < with.size(); ++i) {
    const Punctuality& run = with[i];
    frames += run.frames, on_time += run.on_time * run.frames;
    late_max_ms = std::max(late_max_ms, run.late_max_ms), fewest = std::min(fewest, run.fewest_samples);
    rmse.push_back(run.rmse);
    over_without.push_back(run.rmse / without[i].rmse), over_uniform.push_back(run.rmse / uniform_rmse[i]);
  }
  const Spread ratio = spread_of(over_without);
  const int ranks = with.front().ranks;
  return fmt::format(
      "{}: in real time {:.0f} of {} frames were on time on {}, the latest {:.1f} ms {}, none after the "
      "fifth of fewer than {:.0f} samples; RMSE {:.4f}, by turns {:.2f} ({:.2f} to {:.2f}) of that without "
      "casting and {:.2f} of what uniform sampling has in all of their time.",
      with.front().scene, on_time, frames, ranks == 1 ? "one rank" : fmt::format("{} ranks", ranks),
      std::abs(late_max_ms), late_max_ms > 0 ? "late" : "early", fewest, spread_of(rmse).median, ratio.median,
      ratio.low, ratio.high, spread_of(over_uniform).median);
}

Table rates_table(const std::vector<RatePoint>& points) {
  Table table{{"scene", "cast", "frames/s", "rmse", "rmse after a cut", "frames to recover", "flicker",
               "samples a pixel"},
              {},
              {}};
  for (const RatePoint& p : points) {
    table.rows.push_back({p.scene, std::string(to_word(p.cast)), p.fps, p.rmse, p.rmse_after_cut, p.recovery,
                          p.flicker, p.samples});
  }
  return table;
}

Table punctuality_table(const std::vector<Punctuality>& points) {
  Table table{{"scene", "frames/s", "ranks", "frames", "on time", "late p50 ms", "late p95 ms", "late p99 ms",
               "late max ms", "rmse", "uniform rmse", "samples a pixel"},
              {},
              {}};
  for (const Punctuality& p : points) {
    table.rows.push_back({p.scene, p.fps, static_cast<double>(p.ranks), static_cast<double>(p.frames),
                          p.on_time, p.late_p50_ms, p.late_p95_ms, p.late_p99_ms, p.late_max_ms, p.rmse,
                          p.uniform_rmse, p.samples});
  }
  return table;
}

}  // namespace pprt
