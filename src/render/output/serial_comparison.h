// The distance of frames' sample patterns to the serial ones (--compare-serial), measured beside the frame
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
#include "parallel/settings/session_settings.h"
#include "pipeline/core/sample.h"
#include "trace/compiled_scene.h"

namespace pprt {

// Renders every frame once more, serially, in a thread of its own of the lowest priority. It falls behind
// when the ranks keep all cores busy.
class SerialComparison {
 public:
  // Usual bytes of samples that may wait, some 200 frames of 19,000 samples. Beyond them distance() waits.
  static constexpr std::size_t kMemoryBound = std::size_t{256} << 20;

  // The scene must outlive it.
  SerialComparison(const CompiledScene& scene, const SessionSettings& settings,
                   std::size_t memory_bound = kMemoryBound);
  SerialComparison(const SerialComparison&) = delete;
  SerialComparison& operator=(const SerialComparison&) = delete;

  // Abandons what still waits; its futures are broken.
  ~SerialComparison();

  // Returns the distance, 0 to 1, of all samples of a frame to as many that a single rank would have placed.
  std::future<double> distance(int frame, const Camera& camera, double time, std::vector<Sample> samples);

  // Does all that waits in the caller's thread, which has the usual priority. After the last frame the ranks
  // of other processes may still be spinning until this one ends.
  void catch_up();

 private:
  struct Task {
    int frame;
    Camera camera;
    double time;  // of what moves, seconds
    std::vector<Sample> samples;
    std::promise<double> result;
  };

  void run();
  void do_first(std::unique_lock<std::mutex>& lock);  // of what waits
  double measure(const Task& task) const;

  const CompiledScene& scene_;
  const SessionSettings settings_;
  const std::size_t memory_bound_;

  std::mutex mutex_;  // guards what follows, but the thread
  std::condition_variable work_;
  std::condition_variable room_;
  std::deque<Task> waiting_;
  std::size_t bytes_ = 0;  // of samples, waiting and being compared
  bool stopping_ = false;

  std::thread thread_;  // last: it uses all of the above
};

}  // namespace pprt
