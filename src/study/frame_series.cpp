#include "study/frame_series.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "parallel/virtual_ranks.h"
#include "trace/tracer_probe.h"

namespace pprt {

std::vector<FrameRequest> frames_of(const CompiledScene& scene, const Animation& animation, int count,
                                    View base, int size) {
  base.width = base.height = size;
  std::vector<FrameRequest> frames;
  for (int number = 1; number <= count; ++number) {
    frames.push_back({number, scene.camera(view_at(animation, number, base)), cut_before(animation, number)});
  }
  return frames;
}

void render_series(const CompiledScene& scene, const std::vector<FrameRequest>& frames, int ranks,
                   const SessionSettings& settings, const FrameSink& sink) {
  std::vector<Tracer> tracers(static_cast<std::size_t>(ranks), Tracer(scene, Camera()));
  const auto next = [&](int index) -> std::optional<FrameRequest> {
    const auto i = static_cast<std::size_t>(index);
    return i < frames.size() ? std::optional(frames[i]) : std::nullopt;
  };
  run_virtual_ranks(
      ranks, settings, [&](int rank) { return probe_of(tracers[static_cast<std::size_t>(rank)]); }, next,
      sink);
}

double samples_in(const FinishedFrame& frame) {
  double samples = 0;
  for (const RankReport& rank : frame.ranks) samples += static_cast<double>(rank.samples_in_region);
  return samples;
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
