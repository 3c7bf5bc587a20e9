#include "render/render.h"

#include <fmt/core.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <limits>
#include <sstream>
#include <utility>

#include "base/content_hash.h"
#include "base/diagnostics.h"
#include "cli/exit.h"
#include "cli/launch.h"
#include "cli/log.h"
#include "cli/stop_signals.h"
#include "cli/version.h"
#include "parallel/network/local_communicator.h"
#include "parallel/network/mpi_communicator.h"
#include "parallel/session.h"
#include "parser/nff_parser.h"
#include "render/frame_recorder.h"
#include "render/preflight.h"
#include "render/render_job.h"
#include "render/render_plan.h"
#include "scene/nff_writer.h"
#include "trace/tracer_probe.h"

namespace pprt {
namespace {

std::string nff_text(const SceneDescription& scene) {
  std::ostringstream text;
  write_nff(scene, text);
  return std::move(text).str();
}

// What decides the pictures, but not which of them are made: two runs with equal keys may continue each
// other.
std::string run_key(const RenderOptions& o, const RenderPlan& plan, int ranks,
                    const std::string& scene_hash) {
  const SessionSettings& s = plan.settings;
  std::string text =
      fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} {} {} {}", scene_hash, ranks, s.width, s.height,
                  o.clock, s.frames_per_second, s.budget_units, s.stop.seconds, s.stop.samples,
                  s.stop.quality, o.balance + o.keep_samples + o.pixels + o.weights, o.cast, s.seed,
                  o.max_depth, o.effects + (o.cull ? " cull" : ""));
  for (const PlannedFrame& f : plan.script_frames) {
    const View& v = f.view;
    text += fmt::format("\n{} {} {} {} {} {} {} {} {} {} {} {}", f.number, f.cut, v.from.x, v.from.y,
                        v.from.z, v.at.x, v.at.y, v.at.z, v.up.x, v.up.y, v.up.z, v.angle_degrees);
  }
  return content_hash(text);
}

Json run_record(const RenderOptions& o, const RenderPlan& plan, int ranks, const CompiledScene& scene,
                const std::string& scene_hash) {
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  const SessionSettings& s = plan.settings;
  Json options = {{"fps", s.frames_per_second},
                  {"balance", o.balance},
                  {"cast", o.cast},
                  {"keep_samples", o.keep_samples},
                  {"weights", o.weights},
                  {"pixels", o.pixels},
                  {"seed", s.seed},
                  {"max_depth", o.max_depth},
                  {"cull", o.cull}};
  if (s.clock == ClockKind::kWork) options["budget"] = s.budget_units;
  if (s.frames_per_second <= 0) {
    options["time"] = s.stop.seconds, options["samples"] = s.stop.samples,
    options["quality"] = s.stop.quality;
  }
  return {{"record", "run"},
          {"version", kVersion},
          {"scene", plan.scene.name},
          {"scene_hash", scene_hash},
          {"script", plan.script_name},
          {"options", options},
          {"effects", to_string(scene.effects())},
          {"ranks", ranks},
          {"size", {s.width, s.height}},
          {"clock", o.clock},
          {"host", std::string(host)}};
}

// Where a run that goes on must begin, by index into the plan. Real time never repeats itself: at the first
// frame that is missing. On the work clock the pictures must equal those of an undisturbed run, so it begins
// where that frame's samples came from; where ranks share load, who owns what follows from all frames before.
std::size_t first_to_render(const RenderPlan& plan, int ranks, const FrameRecorder& recorder) {
  const std::vector<PlannedFrame>& frames = plan.frames;
  std::size_t first = 0;
  while (first < frames.size() && recorder.finished_before(frames[first].number)) ++first;
  if (plan.settings.clock == ClockKind::kWall || first == frames.size()) return first;
  if (ranks > 1 && plan.settings.balance != BalanceMode::kNone) return 0;
  const auto follows = [&](std::size_t i) {
    return plan.settings.cast != CastChoice::kOff && !frames[i].cut &&
           frames[i].number == frames[i - 1].number + 1;
  };
  while (first > 0 && follows(first)) --first;
  return first;
}

// The frames to render: those that are missing, and on the work clock those before them that they follow
// from.
std::vector<FrameRequest> frame_requests(const RenderPlan& plan, const CompiledScene& scene, int ranks,
                                         const FrameRecorder& recorder) {
  const bool again = plan.settings.clock == ClockKind::kWork;
  std::vector<FrameRequest> requests;
  std::size_t wanted = 0;  // requests up to the last frame that is missing
  int before = 0;
  for (std::size_t i = first_to_render(plan, ranks, recorder); i < plan.frames.size(); ++i) {
    const PlannedFrame& frame = plan.frames[i];
    const bool finished = recorder.finished_before(frame.number);
    if (finished && !again) continue;
    // What does not follow its predecessor carries nothing over from it.
    requests.push_back({.number = frame.number,
                        .camera = scene.camera(frame.view),
                        .cut = frame.cut,
                        .carries_nothing = frame.number != before + 1,
                        .left_out = static_cast<int>(i - requests.size())});
    before = frame.number;
    if (!finished) wanted = requests.size();
  }
  requests.resize(wanted);
  return requests;
}

// The script as the camera source: one frame after the other, until a signal or a full disk ends it.
CameraSource camera_source(std::vector<FrameRequest> requests, const FrameRecorder& recorder) {
  return [requests = std::move(requests), &recorder](int index) -> std::optional<FrameRequest> {
    if (stop_requested() || recorder.failed()) return std::nullopt;
    const auto i = static_cast<std::size_t>(index);
    return i < requests.size() ? std::optional(requests[i]) : std::nullopt;
  };
}

void print_rays(const RunTotals& totals) {
  const RayCounts& rays = totals.rays();
  fmt::print("rays traced: {} primary, {} shadow, {} reflection, {} refraction, {} visibility\n",
             rays.primary, rays.shadow, rays.reflection, rays.refraction, rays.visibility);
}

// Reads and checks everything before any other rank is told to begin.
struct Prepared {
  RenderPlan plan;
  CompiledScene scene;
};

Prepared prepare(const RenderOptions& options) {
  RenderPlan plan = plan_render(options);
  std::cerr << plan.warnings;
  log_info(fmt::format("read {} objects of {}", plan.scene.primitive_count(), plan.scene.name));
  CompiledScene scene = compile(plan.scene, plan.compile);
  log_info(fmt::format("compiled for effects: {}", to_string(scene.effects())));
  if (options.census) std::cout << scene.census() << std::flush;
  return {std::move(plan), std::move(scene)};
}

// `told` becomes true once the other ranks know what to do.
int run_frames(Communicator& network, const RenderOptions& options, const Prepared& prepared,
               Progress& progress, bool& told) {
  const std::string nff = nff_text(prepared.plan.scene);
  const RenderPlan& plan = prepared.plan;
  const std::string scene_hash = content_hash(nff);
  const Json run = run_record(options, plan, network.size(), prepared.scene, scene_hash);
  FrameRecorder recorder(options, plan, prepared.scene, run_key(options, plan, network.size(), scene_hash),
                         run, progress);
  const CameraSource source =
      camera_source(frame_requests(plan, prepared.scene, network.size(), recorder), recorder);

  Bytes job = encode(RenderJob{true, plan.settings, plan.compile, nff});
  network.broadcast(job);
  told = true;
  watch_signals();
  const StatusTeller teller([&recorder] { recorder.status(); });
  Tracer tracer(prepared.scene, Camera());
  run_as_master(network, plan.settings, probe_of(tracer), source, [&](FinishedFrame&& frame) {
    log_debug(fmt::format("frame {} whole at {:.3f} s, reserve {:.1f} ms, {:+.1f} ms to its deadline",
                          frame.order.number, frame.finished_s, 1e3 * frame.order.reserve_s, frame.late_ms));
    if (!recorder.finished_before(frame.order.number)) recorder.record(std::move(frame));
  });
  // All ranks have come to their end: what cannot be written now is this rank's matter alone.
  try {
    recorder.finish(stop_requested().has_value());
  } catch (const std::exception& e) {
    fmt::print(stderr, "pprt-render: error: {}\n", e.what());
    progress.fail(e.what());
    return kExitFailure;
  }
  if (options.census) print_rays(recorder.totals());
  return stop_requested() ? 128 + *stop_requested() : kExitDone;
}

int master_rank(Communicator& network, const RenderOptions& options, Progress& progress, bool& told) {
  try {
    const Prepared prepared = prepare(options);
    // A census alone renders nothing.
    if (options.census && options.outputs.empty()) {
      Bytes nothing = encode(RenderJob{});
      network.broadcast(nothing);
      return kExitDone;
    }
    check_files(options, prepared.plan);
    std::cerr << check_outlook(prepared.plan, prepared.scene);
    return run_frames(network, options, prepared, progress, told);
  } catch (...) {
    if (!told) {
      Bytes nothing = encode(RenderJob{});
      network.broadcast(nothing);
    }
    throw;
  }
}

// For the master's own text, which may be longer than what it has read: only foreign files need limits.
NffOptions without_limits() {
  NffOptions options;
  options.max_bytes = options.max_primitives = options.max_polygon_vertices = options.max_lights =
      options.max_materials = std::numeric_limits<std::size_t>::max();
  return options;
}

int worker_rank(Communicator& network) {
  ignore_signals();
  Bytes bytes;
  network.broadcast(bytes);
  const RenderJob job = decode_job(bytes);
  if (!job.go) return kExitDone;
  const CompiledScene scene = compile(parse_nff(job.scene_nff, "scene", without_limits()).scene, job.compile);
  Tracer tracer(scene, Camera());
  run_as_worker(network, job.settings, probe_of(tracer));
  return kExitDone;
}

// No exception may pass ranks that others wait for: what keeps the master from beginning ends all ranks in
// order, what comes later ends them at once.
int run_mpi_rank(const RenderOptions& options, Progress& progress, int argc, char** argv) {
  MpiCommunicator network(argc, argv);
  set_up_log(options.log, network.rank());
  bool told = false;
  try {
    return network.rank() == 0 ? master_rank(network, options, progress, told) : worker_rank(network);
  } catch (const std::exception& e) {
    if (network.rank() == 0 && !told) throw;
    fmt::print(stderr, "pprt-render: rank {}: error: {}\n", network.rank(), e.what());
    progress.fail(e.what());
    network.abort_all(kExitFailure);
  }
}

// Every frame needs the same large arrays again; what glibc gives back to the system between frames comes
// back by page faults. Over 60 frames of spd:tree:3 on one rank (median of five runs) keeping it cuts them
// from 46,000 to 10,000 and the system's time from 0.17 s to 0.06 s at 512x512 pixels; at 256x256 it changes
// nothing measurable.
void keep_freed_memory() {
  constexpr int kBytes = 1 << 30;
  mallopt(M_MMAP_THRESHOLD, kBytes);
  mallopt(M_TRIM_THRESHOLD, kBytes);
}

int run(const RenderOptions& options, Progress& progress, int argc, char** argv) {
  keep_freed_memory();
  if (started_by_mpi_launcher()) return run_mpi_rank(options, progress, argc, argv);
  if (options.ranks > 1) {
    return run_under_mpirun(options.ranks, options.hostfile, argv,
                            [&](std::string_view said) { progress.overhear(said); });
  }
  set_up_log(options.log, 0);
  LocalNetwork alone(1);
  LocalCommunicator network(alone, 0);
  bool told = false;
  return master_rank(network, options, progress, told);
}

}  // namespace

int render(const RenderOptions& options, const std::string& config, int argc, char** argv) {
  // Of the ranks of a launcher the first alone speaks.
  Progress progress(launcher_rank() == 0 ? progress_kind(options.progress) : ProgressKind::kNone,
                    options.progress == "none");
  try {
    check_usage(options);
    if (options.write_config) {
      if (launcher_rank() == 0) std::cout << config;
      return kExitDone;
    }
    const int code = run(options, progress, argc, argv);
    progress.close(code);
    return code;
  } catch (const std::exception& e) {
    progress.fail(e.what());
    throw;
  }
}

}  // namespace pprt
