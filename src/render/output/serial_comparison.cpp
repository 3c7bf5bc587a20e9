#include "render/output/serial_comparison.h"

#include <exception>
#include <utility>

#include "base/system/thread_priority.h"
#include "parallel/serial_pattern.h"
#include "trace/tracer_probe.h"

namespace pprt {
namespace {

std::size_t bytes_of(const std::vector<Sample>& samples) {
  return samples.size() * sizeof(Sample);
}

}  // namespace

SerialComparison::SerialComparison(const CompiledScene& scene, const SessionSettings& settings,
                                   std::size_t memory_bound)
    : scene_(scene), settings_(settings), memory_bound_(memory_bound), thread_([this] { run(); }) {}

SerialComparison::~SerialComparison() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  work_.notify_one();
  thread_.join();
}

std::future<double> SerialComparison::distance(int frame, const Camera& camera, double time,
                                               std::vector<Sample> samples) {
  std::future<double> result;
  {
    std::unique_lock lock(mutex_);
    const std::size_t size = bytes_of(samples);
    room_.wait(lock, [&] { return bytes_ == 0 || bytes_ + size <= memory_bound_; });
    bytes_ += size;
    waiting_.push_back({frame, camera, time, std::move(samples), {}});
    result = waiting_.back().result.get_future();
  }
  work_.notify_one();
  return result;
}

void SerialComparison::run() {
  take_lowest_priority();
  std::unique_lock lock(mutex_);
  for (;;) {
    work_.wait(lock, [&] { return stopping_ || !waiting_.empty(); });
    if (stopping_) return;
    do_first(lock);
  }
}

void SerialComparison::catch_up() {
  std::unique_lock lock(mutex_);
  while (!waiting_.empty()) do_first(lock);
}

void SerialComparison::do_first(std::unique_lock<std::mutex>& lock) {
  Task task = std::move(waiting_.front());
  waiting_.pop_front();
  lock.unlock();
  try {
    task.result.set_value(measure(task));
  } catch (...) {
    task.result.set_exception(std::current_exception());
  }
  lock.lock();
  bytes_ -= bytes_of(task.samples);
  room_.notify_one();
}

double SerialComparison::measure(const Task& task) const {
  Tracer tracer(scene_, task.camera);
  return bucket_distance(
      task.samples, serial_samples(settings_, task.camera, task.time, task.samples.size(), probe_of(tracer)));
}

}  // namespace pprt
