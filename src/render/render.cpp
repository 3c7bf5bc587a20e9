#include "render/render.h"

#include <fmt/core.h>
#include <malloc.h>

#include <iostream>
#include <utility>

#include "base/content_hash.h"
#include "base/diagnostics.h"
#include "cli/exit.h"
#include "cli/launch.h"
#include "cli/log.h"
#include "cli/rank_limits.h"
#include "cli/stop_signals.h"
#include "parallel/network/local_communicator.h"
#include "parallel/network/mpi_communicator.h"
#include "parallel/session.h"
#include "render/frame_recorder.h"
#include "render/frame_requests.h"
#include "render/memory_check.h"
#include "render/output_check.h"
#include "render/preflight.h"
#include "render/render_job.h"
#include "render/render_plan.h"
#include "render/run_record.h"
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

// The master's one message to the other ranks before a run, for which they wait: the job, or that there is
// none.
class JobBroadcast {
 public:
  explicit JobBroadcast(Communicator& network) : network_(network) {}

  // Whether the other ranks have their job. Then they cannot be dismissed any more.
  bool run_begun() const { return run_begun_; }

  void send(const RenderJob& job) {
    Bytes bytes = encode(job);
    network_.broadcast(bytes);
    run_begun_ = job.go;
  }

  // Lets the other ranks leave, unless they have their job.
  void dismiss() {
    if (!run_begun_) send(RenderJob());
  }

 private:
  Communicator& network_;
  bool run_begun_ = false;
};

// What the master reads and checks before any other rank is told to begin.
struct PreparedRun {
  RenderPlan plan;
  RenderJob job;
  CompiledScene scene;
};

PreparedRun prepare(const RenderOptions& options) {
  RenderPlan plan = plan_render(options);
  std::cerr << plan.warnings;
  log_info(fmt::format("read {} objects of {}", plan.scene.primitive_count(), plan.scene.name));
  RenderJob job{.go = true,
                .settings = plan.settings,
                .compile = plan.compile,
                .scene_name = plan.scene.name,
                .scene_nff = canonical_nff(plan.scene)};
  CompiledScene scene = compile_scene(job);
  log_info(fmt::format("compiled for effects: {}", to_string(scene.effects())));
  require_eyes_in_reach(plan, scene);
  if (plan.renders) require_memory(plan);
  if (plan.report.census) print_output(scene.census());
  return {std::move(plan), std::move(job), std::move(scene)};
}

void log_frame(const FinishedFrame& frame) {
  log_debug(fmt::format("frame {} whole at {:.3f} s, reserve {:.1f} ms, {:+.1f} ms to its deadline",
                        frame.order.number, frame.finished_s, 1e3 * frame.order.reserve_s, frame.late_ms));
}

int run_frames(Communicator& network, const PreparedRun& run, ProgressReporter& progress,
               JobBroadcast& broadcast) {
  // Open the outputs, which may fail, while the other ranks wait.
  const RunIdentity identity{run.plan, network.size(), content_hash(run.job.scene_nff)};
  FrameRecorder recorder(run.plan, run.scene, run_key(identity), run_record(identity, run.scene.effects()),
                         progress);
  const auto finished_before = [&](int frame) { return recorder.finished_before(frame); };
  const CameraSource source =
      camera_source(frame_requests(run.plan, run.scene, network.size(), finished_before), recorder);

  // Render with all ranks.
  broadcast.send(run.job);
  watch_signals();
  const StatusPrinter printer([&recorder] { recorder.status(); }, [&progress] { progress.stopping(); });
  Tracer tracer(run.scene, Camera());
  run_as_master(network, run.plan.settings, probe_of(tracer), source, [&](FinishedFrame&& frame) {
    log_frame(frame);
    if (!recorder.finished_before(frame.order.number)) recorder.record(std::move(frame));
  });

  // All other ranks have finished: a file that cannot be written now concerns this rank alone.
  try {
    recorder.finish(stop_requested().has_value());
  } catch (const std::exception& e) {
    print_message(fmt::format("pprt-render: error: {}\n", message_of(e)));
    progress.fail(message_of(e));
    return kExitFailure;
  }
  if (run.plan.report.census) print_rays(recorder.totals());
  return stop_requested() ? 128 + *stop_requested() : kExitDone;
}

int master_rank(Communicator& network, const RenderOptions& options, ProgressReporter& progress,
                JobBroadcast& broadcast) {
  try {
    const PreparedRun run = prepare(options);
    if (!run.plan.renders) {
      broadcast.dismiss();
      return kExitDone;
    }
    check_files(run.plan);
    std::cerr << preflight(run.plan, run.scene);
    return run_frames(network, run, progress, broadcast);
  } catch (...) {
    broadcast.dismiss();
    throw;
  }
}

int worker_rank(Communicator& network) {
  ignore_signals();
  Bytes bytes;
  network.broadcast(bytes);
  const RenderJob job = decode_job(bytes);
  if (!job.go) return kExitDone;
  const CompiledScene scene = compile_scene(job);
  Tracer tracer(scene, Camera());
  run_as_worker(network, job.settings, probe_of(tracer));
  return kExitDone;
}

// No exception may leave a rank while others wait for it. An error of the master before the run dismisses the
// other ranks; any later error aborts all ranks at once.
int run_mpi_rank(const RenderOptions& options, ProgressReporter& progress) {
  MpiCommunicator network;
  set_up_log(options.log, network.rank());
  JobBroadcast broadcast(network);
  try {
    return network.rank() == 0 ? master_rank(network, options, progress, broadcast) : worker_rank(network);
  } catch (const std::exception& e) {
    if (network.rank() == 0 && !broadcast.run_begun()) throw;
    print_message(fmt::format("pprt-render: rank {}: error: {}\n", network.rank(), message_of(e)));
    progress.fail(message_of(e));
    network.abort_all(kExitFailure);
  }
}

// Keeps freed memory in the process. Every frame needs the same large arrays again, and what glibc gives back
// to the system between frames costs page faults. Measured over 60 frames of spd:tree:3 at 512x512 pixels on
// one rank, median of five runs: 10,000 page faults in place of 46,000, 0.06 s of system time in place of
// 0.17. At 256x256 pixels nothing changes.
void keep_freed_memory() {
  constexpr int kBytes = 1 << 30;
  mallopt(M_MMAP_THRESHOLD, kBytes);
  mallopt(M_TRIM_THRESHOLD, kBytes);
}

int run(const RenderOptions& options, ProgressReporter& progress, std::span<const std::string> words) {
  keep_freed_memory();
  if (started_by_mpi_launcher()) return run_mpi_rank(options, progress);
  if (options.ranks > 1) {
    if (options.hostfile.empty()) make_room_for(options.ranks);
    return run_under_mpirun(options.ranks, options.hostfile, words,
                            [&](std::string_view said) { progress.overhear(said); });
  }
  set_up_log(options.log, 0);
  LocalNetwork alone(1);
  LocalCommunicator network(alone, 0);
  JobBroadcast broadcast(network);
  return master_rank(network, options, progress, broadcast);
}

}  // namespace

int render(const RenderOptions& options, std::span<const std::string> words) {
  ProgressReporter progress(options.progress);
  try {
    const int code = run(options, progress, words);
    progress.close(code);
    return code;
  } catch (const std::exception& e) {
    progress.fail(message_of(e));
    throw;
  }
}

}  // namespace pprt
