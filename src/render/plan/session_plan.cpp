#include "render/plan/session_plan.h"

#include <fmt/core.h>

#include "base/diagnostics.h"
#include "parallel/exchange/samplers.h"
#include "parallel/session.h"
#include "render/options/render_options.h"

namespace pprt {
SessionSettings settled_method(SessionSettings method, WeightRule weights) {
  if (method.sampler == SamplerChoice::kAuto && needs_triangulation(method, weights))
    method.sampler = SamplerChoice::kDelaunay;
  method.learned_weights = weights == WeightRule::kLearned;
  return method;
}

void settle_end(const FrameEnd& end, double fps, bool goes_on, SessionSettings& settings) {
  settings.frames_per_second = fps;
  if (fps > 0) {
    if (end.needs_no_rate()) {
      throw UsageError(fmt::format(
          "--time, --samples and a FLIP as --quality end frames without a rate, but the rate is {:g} "
          "frames/s; --fps 0 turns it off",
          fps));
    }
    if (end.quality) settings.stop.rmse = end.quality->rmse;
    settings.budget_units = end.budget.value_or(default_budget_units(fps));
    return;
  }
  if (end.budget) throw UsageError("--budget needs a frame rate (--fps)");
  if (goes_on) {
    throw UsageError(
        "--go-on needs a frame rate (--fps): without one a frame waits for all ranks; --resume goes on after "
        "a run that has ended");
  }
  settings.stop = {.seconds = end.time.value_or(0),
                   .samples = end.samples.value_or(0),
                   .flip = end.quality.value_or(Quality()).flip,
                   .rmse = end.quality.value_or(Quality()).rmse,
                   .weight = end.has_stop_rule() ? 0 : traits_of(settings.sampler).still_weight};
}

SessionSettings photo_settings(const SessionSettings& live) {
  constexpr double kLongest_s = 60;
  SessionSettings photo = live;
  photo.frames_per_second = 0;
  photo.budget_units = 0;
  photo.stop = {.seconds = kLongest_s,
                .samples = 0,
                .flip = 0,
                .rmse = 0,
                .weight = traits_of(live.sampler).still_weight};
  photo.is_still = true;
  photo.late_orders = false;
  return photo;
}

}  // namespace pprt
