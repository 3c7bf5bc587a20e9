#include "study/accuracy/rates.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "image/metrics.h"
#include "render/records/frame_summary.h"
#include "scene/animation/camera_path.h"
#include "study/accuracy/methods.h"
#include "study/accuracy/statistics.h"

namespace pprt {
namespace {

SessionSettings settings_of(const Sequence& sequence, CastChoice cast, double fps, ClockKind clock) {
  SessionSettings s{.sampler = sequence.sampler};
  s.width = sequence.frames.front().camera.width;
  s.height = sequence.frames.front().camera.height;
  s.clock = clock;
  s.machine = cluster_machine();
  s.machine.units_per_second = sequence.units_per_second;
  s.frames_per_second = fps;
  s.budget_units = static_cast<std::uint64_t>(sequence.units_per_second / fps);
  s.cast = cast;
  s.seed = sequence.seed;
  return s;
}

// What a sequence's frames came to.
struct PlayedFrames {
  std::vector<Image> pictures;
  std::vector<double> samples;
  RunTotals totals;

  double samples_per_pixel() const {
    return mean_of(samples) / (static_cast<double>(pictures.front().width) * pictures.front().height);
  }
};

PlayedFrames play(const Sequence& sequence, CastChoice cast, double fps, ClockKind clock = ClockKind::kWork) {
  PlayedFrames played;
  render_series(sequence.scene, sequence.frames, sequence.ranks, settings_of(sequence, cast, fps, clock),
                [&](FinishedFrame&& frame) {
                  const FrameSummary summary = summarize(frame);
                  played.pictures.push_back(clamped_to_display(frame.image));
                  played.samples.push_back(static_cast<double>(summary.samples));
                  played.totals.add(summary);
                });
  return played;
}

RatePoint measure(const Sequence& sequence, CastChoice cast, double fps) {
  const PlayedFrames played = play(sequence, cast, fps);
  RatePoint point{.scene = sequence.name, .cast = cast, .fps = fps};
  judge_sequence(sequence, played.pictures, point);
  point.samples = played.samples_per_pixel();
  return point;
}

// Frames from `first` on until the error is at most `enough`.
double frames_until(const std::vector<double>& errors, std::size_t first, double enough) {
  std::size_t i = first;
  while (i < errors.size() && errors[i] > enough) ++i;
  return static_cast<double>(i - first);
}

// The frames so often that they last so many seconds; each round starts with a camera cut.
std::vector<FrameRequest> repeated(const std::vector<FrameRequest>& frames, double fps, double seconds) {
  const double rounds = std::max(1.0, std::ceil(seconds * fps / static_cast<double>(frames.size())));
  std::vector<FrameRequest> all;
  for (int round = 0; round < rounds; ++round) {
    for (const FrameRequest& frame : frames) {
      all.push_back(frame);
      all.back().number = static_cast<int>(all.size());
      all.back().cut = frame.cut || &frame == frames.data();
    }
  }
  return all;
}

// Returns the errors of a sequence's pictures, played once or more often, one reference a frame. Throws
// std::invalid_argument if a round is not whole.
MeanErrors mean_errors(std::span<const Image> pictures, std::span<const Image> references) {
  if (pictures.empty() || references.empty() || pictures.size() % references.size() != 0)
    throw std::invalid_argument("a sequence needs a picture and a reference for every frame");
  const std::vector<FlipReference> seen(references.begin(), references.end());
  std::vector<double> rmse(pictures.size()), flip(pictures.size());
  run_concurrently(pictures.size(), [&](std::size_t i) {
    const std::size_t frame = i % references.size();
    rmse[i] = rmse_of(pictures[i], references[frame]), flip[i] = seen[frame].mean(pictures[i]);
  });
  return {mean_of(rmse), mean_of(flip)};
}

}  // namespace

std::vector<FrameRequest> orbit(const CompiledScene& scene, const View& view, int size, int count,
                                double degrees_per_frame, int cut) {
  constexpr double kJump = 120;  // degrees
  const Vec3d axis = view.up / std::sqrt(view.up.dot(view.up));
  std::vector<FrameRequest> frames;
  for (int i = 0; i < count; ++i) {
    const double degrees = degrees_per_frame * i + (cut >= 0 && i >= cut ? kJump : 0);
    View turned = view;
    turned.from = view.at + rotated(view.from - view.at, axis, degrees * M_PI / 180);
    frames.push_back({.number = i + 1, .camera = square_camera(scene, turned, size), .cut = i == cut});
  }
  return frames;
}

void judge_sequence(const Sequence& sequence, const std::vector<Image>& pictures, RatePoint& point) {
  const std::vector<FrameRequest>& frames = sequence.frames;
  const std::vector<Image>& references = sequence.references;
  if (pictures.size() != frames.size() || references.size() != frames.size() || frames.empty()) {
    throw std::invalid_argument("a sequence needs a picture and a reference for every frame");
  }
  std::vector<double> errors, after_cut, others, recovery;
  double wrong = 0, own = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    errors.push_back(rmse_of(pictures[i], references[i]));
    if (i == 0 || frames[i].cut) {
      after_cut.push_back(errors[i]);
      continue;
    }
    others.push_back(errors[i]);
    wrong += std::pow(flicker(pictures[i - 1], pictures[i], references[i - 1], references[i]), 2);
    own += std::pow(rmse_of(references[i - 1], references[i]), 2);
  }
  const double enough = 1.1 * spread_of(others.empty() ? errors : others).median;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i == 0 || frames[i].cut) recovery.push_back(frames_until(errors, i, enough));
  }
  point.rmse = mean_of(errors);
  point.rmse_after_cut = mean_of(after_cut);
  point.recovery = mean_of(recovery);
  point.flicker = own > 0 ? std::sqrt(wrong / own) : kNoValue;
}

std::vector<RatePoint> measure_rates(const Sequence& sequence, std::span<const double> rates,
                                     std::span<const CastChoice> casts) {
  std::vector<RatePoint> points(casts.size() * rates.size());
  run_concurrently(points.size(), [&](std::size_t i) {
    points[i] = measure(sequence, casts[i % casts.size()], rates[i / casts.size()]);
  });
  return points;
}

RealTimePoint measure_in_real_time(const Sequence& sequence, CastChoice cast, double fps) {
  Sequence played = sequence;
  played.frames = repeated(sequence.frames, fps, sequence.played_s);
  const PlayedFrames series = play(played, cast, fps, ClockKind::kWall);
  const RunTotals& totals = series.totals;
  RealTimePoint point{.scene = sequence.name,
                      .cast = cast,
                      .fps = fps,
                      .ranks = sequence.ranks,
                      .frames = totals.frames(),
                      .on_time = static_cast<double>(totals.on_time()) / totals.frames(),
                      .late_p50_ms = totals.late_ms(0.5),
                      .late_p95_ms = totals.late_ms(0.95),
                      .late_p99_ms = totals.late_ms(0.99),
                      .late_max_ms = totals.worst_late_ms(),
                      .samples = series.samples_per_pixel(),
                      .fewest_samples = fewest_after_fifth(series.samples)};
  point.errors = mean_errors(series.pictures, sequence.references);
  return point;
}

std::vector<RealTimePoint> measure_in_real_time(const Sequence& sequence, std::span<const double> rates) {
  std::vector<RealTimePoint> points;
  for (const double fps : rates) {
    points.push_back(measure_in_real_time(sequence, CastChoice::kAuto, fps));
    points.back().uniform = uniform_errors_in(sequence.ranks / fps, sequence);
  }
  return points;
}

double fewest_after_fifth(std::span<const double> samples_of_frames) {
  constexpr std::size_t kSettling = 5;
  const auto settled = samples_of_frames.subspan(std::min(kSettling, samples_of_frames.size() - 1));
  return *std::min_element(settled.begin(), settled.end());
}

MeanErrors uniform_errors_in(double seconds, const Sequence& sequence) {
  std::vector<Image> pictures;
  for (const FrameRequest& frame : sequence.frames)
    pictures.push_back(uniform_picture_in(seconds, {sequence.scene, frame.camera, frame.time}));
  return mean_errors(pictures, sequence.references);
}

Table rates_table(const std::vector<RatePoint>& points) {
  using P = RatePoint;
  return table_of<P>(points, {{"scene", &P::scene},
                              {"cast", &P::cast},
                              {"frames/s", &P::fps},
                              {"rmse", &P::rmse},
                              {"rmse after a cut", &P::rmse_after_cut},
                              {"frames to recover", &P::recovery},
                              {"flicker", &P::flicker},
                              {"samples a pixel", &P::samples}});
}

Table real_time_table(const std::vector<RealTimePoint>& points) {
  using P = RealTimePoint;
  return table_of<P>(points, {{"scene", &P::scene},
                              {"frames/s", &P::fps},
                              {"ranks", &P::ranks},
                              {"frames", &P::frames},
                              {"on time", &P::on_time},
                              {"late p50 ms", &P::late_p50_ms},
                              {"late p95 ms", &P::late_p95_ms},
                              {"late p99 ms", &P::late_p99_ms},
                              {"late max ms", &P::late_max_ms},
                              {"rmse", [](const P& p) { return p.errors.rmse; }},
                              {"uniform rmse", [](const P& p) { return p.uniform.rmse; }},
                              {"flip", [](const P& p) { return p.errors.flip; }},
                              {"uniform flip", [](const P& p) { return p.uniform.flip; }},
                              {"samples a pixel", &P::samples}});
}

}  // namespace pprt
