#include "render/run/live_run.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <set>
#include <utility>

#include "base/diagnostics.h"
#include "base/system/host_cores.h"
#include "base/system/host_networks.h"
#include "cli/process/exit.h"
#include "cli/process/stop_signals.h"
#include "layers/overlay.h"
#include "live/live_view.h"
#include "parallel/session.h"
#include "render/plan/memory_check.h"
#include "render/plan/session_plan.h"
#include "render/run/live_figures.h"

namespace pprt {
namespace {

// Returns the time of what moves in a frame of the script; empty: there is no such frame.
std::optional<double> time_at(const RenderPlan& plan, int frame) {
  const int place = frame - plan.frames.front().number;
  if (place < 0 || place >= static_cast<int>(plan.frames.size())) return std::nullopt;
  return plan.frames[static_cast<std::size_t>(place)].time;
}

std::optional<Vec3d> seen_at(const RenderPlan& plan, const CompiledScene& scene, const View& view,
                             const Vec2d& point, int moment) {
  const Camera camera = scene.camera(view);
  Tracer tracer(scene, camera);
  tracer.set_time(time_at(plan, moment).value_or(plan.frames.front().time));
  const float depth = tracer.first_hit(point.x, point.y).depth;
  if (!std::isfinite(depth)) return std::nullopt;
  return view.from + ray_direction(camera, point.x, point.y) * depth;  // the compiled space has the same axes
}

// Whether something but the camera moves while the frames play.
bool moves(const RenderPlan& plan, const CompiledScene& scene) {
  const double first = plan.frames.front().time;
  return std::any_of(plan.frames.begin(), plan.frames.end(),
                     [&](const PlannedFrame& frame) { return scene.moves_between(first, frame.time); });
}

LiveShow show_of(const RenderPlan& plan, const CompiledScene& scene, int ranks) {
  LiveShow show{.title = plan.scene.name,
                .scene_name = plan.scene_name,
                .objects = plan.objects,
                .daylight = plan.daylight,
                .home = plan.frames.front().view,
                .script = {},
                .frames_per_second = plan.settings.frames_per_second,
                .moves = moves(plan, scene),
                .bounds = bounds(plan.scene),
                .ranks = ranks,
                .records = !plan.output.pictures.empty(),
                .require_camera = [&scene](const View& view) { scene.camera(view); },
                .require_size = [](int width, int height) { require_memory(width, height, true); },
                .seen_at =
                    [&](const View& view, double x, double y, int moment) {
                      return seen_at(plan, scene, view, {x, y}, moment);
                    }};
  if (plan.script_name.empty() && plan.frames.size() < 2) return show;
  for (const PlannedFrame& frame : plan.frames) show.script.push_back({frame.number, frame.view, frame.cut});
  return show;
}

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "HOST";
}

std::string where_to_look(const LiveView& view, const LiveAddress& address) {
  const std::string& at = address.address;
  std::string text = fmt::format("pprt-render: live at {}\n", view.url());
  if (at == "0.0.0.0" || at == "::") {
    for (const HostNetwork& network : host_networks())
      text += fmt::format("pprt-render: from {}: {}\n", network.interface, view.url_at(network.host));
  } else if (at == "127.0.0.1" || at == "::1") {
    text += fmt::format("pprt-render: to open it on another host, run there first: ssh -L {0}:{1}:{0} {2}\n",
                        view.port(), at == "::1" ? "[::1]" : "localhost", host_name());
  }
  return text + "pprt-render: Ctrl-C ends it\n";
}

// An overlay bears the name of its layer.
std::optional<Layer> layer_of(Overlay overlay) {
  const auto is_it = [&](Layer layer) { return name_of(layer) == word_for(overlay); };
  const auto found = std::find_if(kAllLayers.begin(), kAllLayers.end(), is_it);
  return found == kAllLayers.end() ? std::nullopt : std::optional(*found);
}

// Tells when a picture at rest is finished. It is when nothing in it is worth a sample, by the rule of a
// still. It is, too, when its frames have no time left for samples: reconstructing a large picture takes all
// of it. Either must hold for as many whole frames as a second has.
class StillWatch {
 public:
  StillWatch(double still_weight, double frames_per_second)
      : still_weight_(still_weight), frames_(static_cast<int>(std::ceil(frames_per_second))) {}

  bool is_finished(const FinishedFrame& frame) {
    if (frame.order.carry != Carry::kAccumulate) in_a_row_ = 0;
    if (frame.order.carry != Carry::kAccumulate || !frame.late_ranks.empty()) return false;
    std::uint64_t samples = 0, fresh = 0;
    bool looks_finished = true;
    for (const RankReport& rank : frame.ranks) {
      samples += rank.samples_in_region;
      fresh += rank.samples_new;
      looks_finished = looks_finished && rank.mean_weight <= still_weight_;
    }
    constexpr std::uint64_t kLeastGain = 200;  // one sample in so many
    in_a_row_ = looks_finished || fresh * kLeastGain < samples ? in_a_row_ + 1 : 0;
    return in_a_row_ > frames_;
  }

 private:
  double still_weight_;
  int frames_;  // of a second
  int in_a_row_ = 0;
};

// Any number of sequences, one after the other.
class LiveRunner {
 public:
  LiveRunner(const RenderPlan& plan, const CompiledScene& scene, int ranks, FrameRecorder* recorder,
             const RunSequence& run_sequence)
      : plan_(plan),
        scene_(scene),
        ranks_(ranks),
        recorder_(recorder),
        run_sequence_(run_sequence),
        view_(*plan.live, show_of(plan, scene, ranks)) {
    time_ = plan.frames.front().time;
    if (recorder == nullptr) return;
    for (const PlannedFrame& frame : plan.frames)
      if (!recorder->finished_before(frame.number)) missing_.insert(frame.number);
  }

  void run() {
    print_message(where_to_look(view_, *plan_.live));
    while (!is_over()) {
      constexpr double kLongestWait_s = 0.1;  // for a signal
      if (!view_.steering().wait_for_change(kLongestWait_s)) continue;
      const LiveRun wanted = view_.steering().next_run();
      if (wanted.photo) {
        take_photo(wanted);
      } else {
        render_frames(wanted);
      }
    }
    view_.end(recorder_ != nullptr && missing_.empty() ? "All frames are rendered: pprt-render has ended."
                                                       : "pprt-render has ended.");
  }

 private:
  bool is_over() {
    if (stop_requested()) return true;
    if (recorder_ == nullptr) return false;
    return recorder_->failed() || (missing_.empty() && view_.steering().is_played_out());
  }

  void take_photo(const LiveRun& wanted) {
    SessionSettings settings = photo_settings(plan_.settings);
    settings.width = wanted.width;
    settings.height = wanted.height;
    View view = wanted.view;
    view.width = wanted.width;
    view.height = wanted.height;
    const auto source = [&](int index) -> std::optional<FrameRequest> {
      if (index > 0) return std::nullopt;
      return FrameRequest{.number = ++number_, .camera = scene_.camera(view), .time = time_};
    };
    // Whoever has asked for it may leave meanwhile, and a signal does not wait for it.
    const auto is_unwanted = [&] { return stop_requested() || !view_.steering().awaits_photo(); };
    const auto sink = [&](FinishedFrame&& frame) {
      if (!is_unwanted()) view_.show_photo(wanted, frame.image);
    };
    run_sequence_(settings, source, sink, is_unwanted);
  }

  void render_frames(const LiveRun& wanted) {
    SessionSettings settings = plan_.settings;
    settings.width = wanted.width;
    settings.height = wanted.height;
    settings.frames_per_second = wanted.frames_per_second;
    const TileGrid grid = tile_grid(settings, ranks_);
    const Remedies remedies = recorder_ == nullptr ? Remedies::kPage : Remedies::kPageOfFixedSize;
    LiveFigures last_frames(settings, ranks_, usable_cores(), remedies);
    std::deque<LiveShot> shots;  // of frames that are not delivered
    StillWatch finish(photo_settings(settings).stop.weight, settings.frames_per_second);
    const auto source = [&](int) -> std::optional<FrameRequest> {
      if (is_over()) return std::nullopt;
      const std::optional<LiveShot> shot = view_.steering().next_shot();
      if (!shot) return std::nullopt;
      shots.push_back(*shot);
      const double before = std::exchange(time_, time_at(plan_, shot->moment).value_or(time_));
      return FrameRequest{.number = ++number_,
                          .camera = camera_of(shot->view),
                          .cut = shot->cut,
                          .report_samples = shows_samples(*shot),
                          .time = time_,
                          .moves = scene_.moves_between(before, time_)};
    };
    const auto sink = [&](FinishedFrame&& frame) {
      const LiveShot shot = shots.front();
      shots.pop_front();
      if (finish.is_finished(frame)) view_.steering().rest(shot.change);
      const FrameFigures figures = last_frames.add(frame);
      deliver(std::move(frame), shot, grid, figures);
    };
    run_sequence_(settings, source, sink, [] { return false; });
  }

  // A film goes through cameras that nobody has seen. One that is none is left out.
  Camera camera_of(const View& view) try {
    return last_camera_ = scene_.camera(view);
  } catch (const InputError&) {
    return last_camera_;
  }

  void deliver(FinishedFrame&& frame, const LiveShot& shot, const TileGrid& grid,
               const FrameFigures& figures) {
    const bool is_recorded = missing_.erase(shot.script_frame) > 0;
    LivePicture picture{.image = is_recorded ? frame.image : std::move(frame.image),
                        .shot = shot,
                        .figures = figures,
                        .rests = frame.order.carry == Carry::kAccumulate,
                        .is_partial = !frame.late_ranks.empty() && shows_samples(shot),
                        .overlaid = overlay_of(frame, shot, grid)};
    if (is_recorded) record(std::move(frame), shot.script_frame);
    view_.show(std::move(picture));
  }

  // Late ranks' samples are missing.
  static bool shows_samples(const LiveShot& shot) {
    const std::optional<Layer> layer = layer_of(shot.overlay);
    return layer && needs_samples(*layer);
  }

  static std::function<Image(const Image&)> overlay_of(const FinishedFrame& frame, const LiveShot& shot,
                                                       const TileGrid& grid) {
    const std::optional<Layer> layer = layer_of(shot.overlay);
    if (!layer || (needs_samples(*layer) && frame.samples.empty())) return nullptr;
    return [layer = *layer, sources = LayerSources{.frame_number = frame.order.number,
                                                   .grid = grid,
                                                   .owners = frame.owners,
                                                   .samples = frame.samples,
                                                   .first_hit = {}}](const Image& image) {
      return overlaid(image, layer, sources);
    };
  }

  // Files count as the script does.
  void record(FinishedFrame&& frame, int script_frame) {
    const int later = frame.order.number - script_frame;
    frame.order.number = script_frame;
    for (Sample& sample : frame.samples) sample.frame -= later;
    recorder_->record(std::move(frame));
  }

  const RenderPlan& plan_;
  const CompiledScene& scene_;
  int ranks_;
  FrameRecorder* recorder_;
  const RunSequence& run_sequence_;
  LiveView view_;
  std::set<int> missing_;  // frames of the script that are to be recorded
  int number_ = 0;         // of the frame ordered last
  double time_ = 0;        // of what moves, in the frame ordered last, seconds
  Camera last_camera_;
};

}  // namespace

void run_live(const RenderPlan& plan, const CompiledScene& scene, int ranks, FrameRecorder* recorder,
              const RunSequence& run_sequence) {
  LiveRunner(plan, scene, ranks, recorder, run_sequence).run();
}

}  // namespace pprt
