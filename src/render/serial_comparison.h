// How far frames' sample patterns are from the serial ones (--compare-serial), measured beside the frame
// loop.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <future>
#include <mutex>
#include <thread>
#include <vector>

#include "base/camera.h"
#include "parallel/session_settings.h"
#include "pipeline/sample.h"
#include "trace/compiled_scene.h"

namespace pprt {

// Renders every frame once more, serially, in a thread of its own and of the lowest priority. With ranks that
// keep all cores busy it falls behind.
class SerialComparison {
 public:
  // Bytes of samples that may wait: some 200 frames of 19,000. Then distance() waits.
  static constexpr std::size_t kMemoryBound = std::size_t{256} << 20;

  // The scene must outlive it.
  SerialComparison(const CompiledScene& scene, const SessionSettings& settings);
  SerialComparison(const SerialComparison&) = delete;
  SerialComparison& operator=(const SerialComparison&) = delete;

  // Leaves what still waits undone: its futures are broken.
  ~SerialComparison();

  // Of all samples of a frame to as many that a single rank would have placed, 0 to 1.
  std::future<double> distance(int frame, const Camera& camera, std::vector<Sample> samples);

  // Does all that waits in the caller's thread, whose priority gets it done: when the last frame is whole,
  // ranks of other processes may still spin until this one ends.
  void catch_up();

 private:
  struct Task {
    int frame;
    Camera camera;
    std::vector<Sample> samples;
    std::promise<double> result;
  };

  void run();
  void do_first(std::unique_lock<std::mutex>& lock);  // of what waits
  double measure(const Task& task) const;

  const CompiledScene& scene_;
  const SessionSettings settings_;

  std::mutex mutex_;  // guards what follows, but the thread
  std::condition_variable work_;
  std::condition_variable room_;
  std::deque<Task> waiting_;
  std::size_t bytes_ = 0;  // of samples, waiting and being compared
  bool stopping_ = false;

  std::thread thread_;  // last: it uses all of the above
};

}  // namespace pprt
