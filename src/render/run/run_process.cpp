#include "render/run/run_process.h"

#include <fmt/core.h>
#include <malloc.h>

#include <algorithm>
#include <functional>
#include <iostream>
#include <span>
#include <utility>
#include <vector>

#include "base/counted.h"
#include "base/diagnostics.h"
#include "base/system/host_cores.h"
#include "cli/process/exit.h"
#include "cli/process/launched.h"
#include "cli/process/log.h"
#include "cli/process/stop_signals.h"
#include "parallel/clock/make_clocks.h"
#include "parallel/network/mpi_communicator.h"
#include "parallel/network/process_ranks.h"
#include "parallel/session.h"
#include "render/output/frame_recorder.h"
#include "render/output/output_check.h"
#include "render/plan/film_time.h"
#include "render/plan/frame_requests.h"
#include "render/plan/memory_check.h"
#include "render/plan/preflight.h"
#include "render/run/live_run.h"
#include "render/run/render_job.h"
#include "scene/bytes/scene_bytes.h"
#include "trace/tracer_probe.h"

namespace pprt {
namespace {

// Returns the requests one after the other, until a signal or a failed write ends the run.
CameraSource camera_source(std::vector<FrameRequest> requests, const FrameRecorder& recorder) {
  return [requests = std::move(requests), &recorder](int index) -> std::optional<FrameRequest> {
    if (stop_requested() || recorder.failed()) return std::nullopt;
    const auto i = static_cast<std::size_t>(index);
    return i < requests.size() ? std::optional(requests[i]) : std::nullopt;
  };
}

void print_rays(const RunTotals& totals) {
  const RayCounts& rays = totals.rays();
  print_output(
      fmt::format("rays traced: {} primary, {} shadow, {} reflection, {} refraction, {} visibility\n",
                  rays.primary, rays.shadow, rays.reflection, rays.refraction, rays.visibility));
}

// The first process's message to the others before a run, for which they wait: the job, or that there is
// none.
class JobBroadcast {
 public:
  // Null: there are no others.
  explicit JobBroadcast(MpiCommunicator* processes) : processes_(processes) {}

  bool has_others() const { return processes_ != nullptr; }

  // Whether the others have their job. Then they cannot be dismissed any more.
  bool run_begun() const { return run_begun_; }

  void send(const RenderJob& job) {
    Bytes bytes = encode(job);
    if (processes_ != nullptr) processes_->broadcast(bytes);
    run_begun_ = job.go;
  }

  // The others await a job that does not come.
  void end() { run_begun_ = false, dismiss(); }

  // Throws std::runtime_error where some did not come to the end of their last job.
  void require_others() const {
    if (processes_ != nullptr && !processes_->all_finished())
      throw std::runtime_error("a rank did not come to the end of its frames");
  }

  // Lets the others leave, unless they have their job.
  void dismiss() {
    if (!run_begun_) send(RenderJob());
  }

 private:
  MpiCommunicator* processes_;
  bool run_begun_ = false;
};

// What the first process reads and checks before any other is told to begin.
struct PreparedRun {
  RenderPlan plan;
  RenderJob job;
  CompiledScene scene;
};

// `has_others`: other processes take part.
PreparedRun prepare(const PlanMaker& make_plan, bool has_others) {
  RenderPlan plan = make_plan();
  std::cerr << plan.warnings;
  log_info(fmt::format("read {} of {}", counted(plan.scene.primitive_count(), "object", "objects"),
                       plan.scene.name));
  RenderJob job{.go = true,
                .settings = plan.settings,
                .compile = plan.compile,
                .scene = has_others ? encode(plan.scene) : Bytes()};
  CompiledScene scene = compile(plan.scene, plan.compile);
  log_info(fmt::format("compiled for effects: {}", to_string(scene.effects())));
  require_eyes_in_reach(plan, scene);
  const SessionSettings& s = plan.settings;
  if (plan.renders) require_memory(s.width, s.height, s.frames_per_second > 0);
  if (plan.report.census) print_output(scene.census());
  return {std::move(plan), std::move(job), std::move(scene)};
}

void log_frame(const FinishedFrame& frame) {
  log_debug(fmt::format("frame {} whole at {:.3f} s, reserve {:.1f} ms, {:+.1f} ms to its deadline",
                        frame.order.number, frame.finished_s, 1e3 * frame.order.reserve_s, frame.late_ms));
}

void warn_of_jump(int rank, double seconds) {
  print_message(
      fmt::format("pprt-render: warning: the clock of rank {} has jumped by {:+.3f} s\n", rank, seconds));
}

SessionEvents events_of(bool goes_on, const ProcessRanks& ranks) {
  const auto host_of = [&ranks](int rank) { return ranks.host_of(rank); };
  LossRule loss;
  loss.goes_on = goes_on;
  loss.host_of = host_of;
  loss.told = [host_of, patience_s = loss.patience_s](std::span<const int> lost) {
    print_message(fmt::format("pprt-render: warning: no answer for {} s from {}; the run goes on without\n",
                              patience_s, name_ranks(lost, host_of)));
  };
  return {.clock_jumped = warn_of_jump, .loss = loss};
}

// Calls run(communicator, probe) for each rank of this process, with a tracer of its own.
void run_ranks(ProcessRanks& ranks, const CompiledScene& scene,
               const std::function<void(Communicator&, const Probe&)>& run) {
  ranks.run([&](Communicator& network) {
    Tracer tracer(scene, Camera());
    run(network, probe_of(tracer));
  });
}

// Renders one sequence with all ranks; its frames come to the sink.
void run_sequence(ProcessRanks& ranks, const CompiledScene& scene, const SessionSettings& settings,
                  const CameraSource& source, const FrameSink& sink, const SessionEvents& events) {
  const FrameSink logged = [&sink](FinishedFrame&& frame) {
    log_frame(frame);
    sink(std::move(frame));
  };
  run_ranks(ranks, scene, [&](Communicator& network, const Probe& probe) {
    if (network.rank() == 0) {
      run_as_master(network, settings, probe, source, logged, events);
    } else {
      run_as_worker(network, settings, probe);
    }
  });
}

void warn_of_few_cores(const LocalRanks& ranks) {
  const int installed = installed_cores();
  if (ranks.cores >= std::min(ranks.on_host, installed)) return;
  print_message(fmt::format(
      "pprt-render: warning: {} ranks may use only {} of this host's {} cores, by their affinity; "
      "mpirun's --bind-to none lifts it\n",
      ranks.on_host, ranks.cores, installed));
}

// All other ranks have finished: a file that cannot be written now concerns this rank alone.
int finish_files(FrameRecorder& recorder, ProgressReporter& progress) try {
  recorder.finish(stop_requested().has_value());
  return stop_requested() ? 128 + *stop_requested() : kExitDone;
} catch (const std::exception& e) {
  print_message(fmt::format("pprt-render: error: {}\n", message_of(e)));
  progress.fail(message_of(e));
  return kExitFailure;
}

void listen_to_signals() {
  watch_signals();
  tell_launcher({.event = RankEvent::kListens});
}

// A live view without files has no end of its own: a signal is the usual one.
int run_live_view(ProcessRanks& ranks, const PreparedRun& run, const SessionEvents& events,
                  ProgressReporter& progress, JobBroadcast& broadcast) {
  const int size = ranks.ranks().size;
  std::optional<FrameRecorder> recorder;
  if (!run.plan.output.pictures.empty()) {
    recorder.emplace(RunIdentity{run.plan, size, hash_of(run.plan.scene)}, run.scene, progress);
  }
  listen_to_signals();
  const auto status = [&recorder] {
    if (recorder) recorder->status();
  };
  const StatusPrinter printer(status, [&progress] { progress.stopping(); });
  RenderJob job = run.job;
  job.again = true;
  run_live(run.plan, run.scene, size, recorder ? &*recorder : nullptr,
           [&](const SessionSettings& settings, const CameraSource& source, const FrameSink& sink,
               const std::function<bool()>& is_enough) {
             SessionEvents with_end = events;
             with_end.is_enough = is_enough;
             job.settings = settings;
             broadcast.send(job);
             job.scene.clear();
             run_sequence(ranks, run.scene, settings, source, sink, with_end);
             broadcast.require_others();
           });
  broadcast.end();
  return recorder ? finish_files(*recorder, progress) : kExitDone;
}

// Tells what a frame takes at least and at most.
void tell_division(std::span<const double> times, double seconds, std::size_t priced, double pricing_s) {
  const auto [least, most] = std::minmax_element(times.begin(), times.end());
  const double mean_s = seconds / static_cast<double>(times.size());
  print_message(
      fmt::format("pprt-render: {} of {} frames were priced in {:.3g} s; a frame gets {:.3g} to {:.3g} s\n",
                  priced, times.size(), pricing_s, *least * mean_s, *most * mean_s));
}

// Prices the frames of a film by a quick pass, and gives each its time. Returns the job of the pass proper.
RenderJob divide_film_time(ProcessRanks& ranks, const PreparedRun& run, const SessionEvents& events,
                           JobBroadcast& broadcast, std::vector<FrameRequest>& requests) {
  const double film_time = *run.plan.film_time, begin_s = monotonic_seconds();
  const std::vector<FrameRequest> quick = pricing_requests(requests);
  RenderJob job = run.job;
  job.again = true;
  job.settings = pricing_settings(run.plan.settings, quick.size(), film_time);
  broadcast.send(job);
  std::vector<ErrorEstimate> prices;
  const CameraSource source = [&](int index) -> std::optional<FrameRequest> {
    const auto i = static_cast<std::size_t>(index);
    return i < quick.size() && !stop_requested() ? std::optional(quick[i]) : std::nullopt;
  };
  run_sequence(
      ranks, run.scene, job.settings, source,
      [&](FinishedFrame&& frame) { prices.push_back(frame.error ? frame.error->own : ErrorEstimate()); },
      events);
  broadcast.require_others();

  const double passed_s =
      is_reproducible(job.settings) ? kPricingShare * film_time : monotonic_seconds() - begin_s;
  constexpr double kLeastLeft = 0.1;  // of the film's time, on a machine too slow for the quick pass
  const double left_s = std::max(film_time - passed_s, kLeastLeft * film_time);
  job.again = false;
  job.settings = pass_settings(run.plan.settings, requests.size(), left_s);
  job.scene.clear();
  if (prices.size() < quick.size()) return job;  // a signal has ended the pass
  const std::vector<double> times = divided_time(requests, prices);
  for (std::size_t i = 0; i < times.size(); ++i) requests[i].periods = times[i];
  tell_division(times, left_s, quick.size(), passed_s);
  return job;
}

int run_frames(ProcessRanks& ranks, const PreparedRun& run, const SessionEvents& events,
               ProgressReporter& progress, JobBroadcast& broadcast) {
  // Open the outputs, which may fail, while the other processes wait.
  const int size = ranks.ranks().size;
  FrameRecorder recorder({run.plan, size, hash_of(run.plan.scene)}, run.scene, progress);
  const auto finished_before = [&](int frame) { return recorder.finished_before(frame); };
  std::vector<FrameRequest> requests = frame_requests(run.plan, run.scene, size, finished_before);

  // Render with all ranks.
  listen_to_signals();
  RenderJob job = run.job;
  if (run.plan.film_time) job = divide_film_time(ranks, run, events, broadcast, requests);
  broadcast.send(job);
  const CameraSource source = camera_source(std::move(requests), recorder);
  const StatusPrinter printer([&recorder] { recorder.status(); }, [&progress] { progress.stopping(); });
  const bool has_deadlines = run.plan.settings.frames_per_second > 0 && !is_reproducible(run.plan.settings);
  bool is_first = true;
  const FrameSink sink = [&](FinishedFrame&& frame) {
    recorder.record(std::move(frame));
    if (std::exchange(is_first, false) && has_deadlines) tell_launcher({.event = RankEvent::kSpares});
  };
  SessionEvents with_progress = events;
  with_progress.sampled = [&recorder](const SamplingProgress& now) { recorder.sampled(now); };
  run_sequence(ranks, run.scene, job.settings, source, sink, with_progress);

  const int code = finish_files(recorder, progress);
  if (code != kExitFailure && run.plan.report.census) print_rays(recorder.totals());
  return code;
}

int run_first_process(ProcessRanks& ranks, const PlanMaker& make_plan, ProgressReporter& progress,
                      JobBroadcast& broadcast) {
  try {
    const PreparedRun run = prepare(make_plan, broadcast.has_others());
    if (!run.plan.renders) {
      broadcast.dismiss();
      return kExitDone;
    }
    check_files(run.plan);
    std::cerr << preflight(run.plan, run.scene);
    warn_of_few_cores(ranks.ranks());
    const auto run_all = run.plan.live ? run_live_view : run_frames;
    return run_all(ranks, run, events_of(run.plan.goes_on, ranks), progress, broadcast);
  } catch (...) {
    broadcast.dismiss();
    throw;
  }
}

int run_further_process(MpiCommunicator& processes, ProcessRanks& ranks) {
  ignore_signals();
  std::optional<CompiledScene> scene;
  RenderJob job;
  job.again = true;
  while (job.again) {
    Bytes bytes;
    processes.broadcast(bytes);
    job = decode_job(bytes);
    if (!job.go) break;
    if (!scene) scene.emplace(compile_scene(job));
    run_ranks(ranks, *scene, [&](Communicator& network, const Probe& probe) {
      run_as_worker(network, job.settings, probe);
    });
  }
  return kExitDone;
}

// Most hosts that do not reach each other have a network of their own besides.
void meet_others(MpiCommunicator& processes) try {
  processes.meet_others();
} catch (const std::exception& e) {
  print_message(fmt::format("pprt-render: error: {}\n", message_of(e)));
  processes.abort_all(kExitFailure);
}

// A process of another launcher's, or of none, would render what others render too, or keep silent for them.
void require_rank(MpiCommunicator& processes, int told_rank) {
  if (processes.rank() == told_rank) return;
  print_message(fmt::format(
      "pprt-render: error: the environment says that this is rank {} of an MPI run (PMIX_RANK or PMI_RANK), "
      "but for MPI it is rank {}; was it started by another MPI's launcher?\n",
      told_rank, processes.rank()));
  processes.abort_all(kExitFailure);
}

// No exception may leave a process while others wait for it. An error of the first before the run dismisses
// the others; any later error aborts all at once.
int run_mpi_process(const PlanMaker& make_plan, std::optional<int> threads, LogLevel log,
                    ProgressReporter& progress) {
  const int told_rank = launcher_rank();  // before MPI, which sets variables of its own
  MpiCommunicator processes;
  meet_others(processes);
  require_rank(processes, told_rank);
  if (processes.rank() == 0) tell_launcher({.event = RankEvent::kMet});
  const int share = std::clamp(processes.cores_on_host() / processes.ranks_on_host(), 1, kMostThreads);
  ProcessRanks ranks(processes, threads.value_or(share));
  set_up_log(log, ranks.ranks().first);
  JobBroadcast broadcast(&processes);
  const bool is_first = processes.rank() == 0;
  try {
    const int code = is_first ? run_first_process(ranks, make_plan, progress, broadcast)
                              : run_further_process(processes, ranks);
    // mpirun may not notice the end: a host that it waits for may be out of reach.
    if (is_first) tell_launcher({.event = RankEvent::kEnded, .number = code});
    if (processes.all_finished()) return code;
    progress.close(code);
    processes.abort_all(code);
  } catch (const std::exception& e) {
    if (is_first && !broadcast.run_begun()) throw;
    print_message(fmt::format("pprt-render: rank {}: error: {}\n", ranks.ranks().first, message_of(e)));
    progress.fail(message_of(e));
    // With --go-on mpirun ends with 0 where it was told to do without a rank.
    if (is_first) tell_launcher({.event = RankEvent::kEnded, .number = kExitFailure});
    processes.abort_all(kExitFailure);
  }
}

// Keeps freed memory in the process. Every frame needs the same large arrays again, and what glibc gives back
// to the system between frames costs page faults. Measured over 60 frames of spd:tree:3 at 512x512 pixels on
// one rank, median of five runs: 10,000 page faults in place of 46,000, 0.06 s of system time in place of
// 0.17. At 256x256 pixels nothing changes.
void keep_freed_memory() {
  constexpr int kKeptBytes = 1 << 30;
  mallopt(M_MMAP_THRESHOLD, kKeptBytes);
  mallopt(M_TRIM_THRESHOLD, kKeptBytes);
}

}  // namespace

int run_process(const PlanMaker& make_plan, std::optional<int> threads, LogLevel log,
                ProgressReporter& progress) {
  keep_freed_memory();
  if (started_by_mpi_launcher()) return run_mpi_process(make_plan, threads, log, progress);
  set_up_log(log, 0);
  ProcessRanks ranks(threads.value_or(std::min(usable_cores(), kMostThreads)));
  JobBroadcast broadcast(nullptr);
  return run_first_process(ranks, make_plan, progress, broadcast);
}

}  // namespace pprt
