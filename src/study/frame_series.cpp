#include "study/frame_series.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <ctime>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "parallel/virtual_ranks.h"
#include "trace/tracer_probe.h"

namespace pprt {

Camera square_camera(const CompiledScene& scene, View view, int size) {
  view.width = view.height = size;
  return scene.camera(view);
}

std::vector<FrameRequest> frames_of(const CompiledScene& scene, const Animation& animation, int count,
                                    const View& base, int size, double speed) {
  std::vector<FrameRequest> frames;
  for (int number = 1; number <= count; ++number) {
    const View view = view_at(animation, 1 + (number - 1) * speed, base);
    frames.push_back(
        {.number = number, .camera = square_camera(scene, view, size), .cut = cut_before(animation, number)});
  }
  return frames;
}

void render_series(const CompiledScene& scene, const std::vector<FrameRequest>& frames, int ranks,
                   const SessionSettings& settings, const FrameSink& sink) {
  std::vector<Tracer> tracers;
  for (int rank = 0; rank < ranks; ++rank) tracers.emplace_back(scene, Camera());
  const auto next = [&](int index) -> std::optional<FrameRequest> {
    const auto i = static_cast<std::size_t>(index);
    return i < frames.size() ? std::optional(frames[i]) : std::nullopt;
  };
  run_virtual_ranks(
      ranks, settings, [&](int rank) { return probe_of(tracers[static_cast<std::size_t>(rank)]); }, next,
      sink);
}

double measured_units_per_second(const Subject& subject, SamplerChoice sampler) {
  constexpr std::uint64_t kUnits = 200'000'000;
  SessionSettings settings{.sampler = sampler};
  settings.width = subject.camera.width, settings.height = subject.camera.height;
  settings.clock = ClockKind::kWork;
  settings.machine = cluster_machine();
  settings.machine.units_per_second = kUnits;
  settings.frames_per_second = 1;
  settings.budget_units = kUnits;
  settings.cast = CastChoice::kOff;
  const std::clock_t begin = std::clock();
  render_series(subject.scene, {{.number = 1, .camera = subject.camera, .time = subject.time}}, 1, settings,
                [](FinishedFrame&&) {});
  return kUnits * static_cast<double>(CLOCKS_PER_SEC) /
         static_cast<double>(std::max<std::clock_t>(1, std::clock() - begin));
}

double work_for_samples(const WorkQuestion& question, const std::function<double(double)>& samples_made) {
  double sampling_units = question.samples * question.guess_per_sample;
  for (int i = 0; i < question.corrections; ++i) {
    sampling_units *= question.samples / samples_made(question.pixel_units + sampling_units);
  }
  return question.pixel_units + sampling_units;
}

void run_concurrently(std::size_t count, const std::function<void(std::size_t)>& task) {
  std::atomic<std::size_t> next = 0;
  std::mutex failing;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        task(i);
      } catch (...) {
        const std::lock_guard lock(failing);
        failure = std::current_exception();
        next = count;
      }
    }
  };
  {
    std::vector<std::jthread> threads(std::max(1u, std::thread::hardware_concurrency()));
    for (std::jthread& thread : threads) thread = std::jthread(work);
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace pprt
