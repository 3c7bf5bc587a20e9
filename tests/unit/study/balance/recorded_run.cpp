#include "unit/study/balance/recorded_run.h"

#include <cmath>

#include "parallel/session.h"
#include "parallel/virtual_ranks.h"

namespace pprt {
namespace {

Probe uneven_probe(int width) {
  return {[](const Camera&) {},
          [width](double x, double y) {
            RaySample sample;
            const bool is_costly = x > 0.6 * width;
            sample.rays = is_costly ? 40 : 1;
            sample.color = Color(static_cast<float>(std::fmod(std::hypot(x, y), 9) < 4), 0.5f,
                                 static_cast<float>(is_costly));
            return sample;
          },
          [](const Vec3f&, bool) { return true; }, [] { return RayCounts(); }};
}

}  // namespace

SessionSettings uneven_settings(SamplerChoice sampler, BalanceMode balance) {
  SessionSettings settings{.sampler = sampler};
  settings.width = 160, settings.height = 112;
  settings.clock = ClockKind::kWork;
  settings.frames_per_second = 10;
  settings.budget_units = 3'000'000;
  settings.cast = CastChoice::kOff;
  settings.balance = balance;
  settings.report_transfers = true;
  return settings;
}

BalanceTrace recorded_run(const SessionSettings& settings, int ranks, int frames) {
  const TileGrid grid = tile_grid(settings, ranks);
  std::string text = trace_line(
      TraceHeader{.version = "test", .scene = "uneven", .ranks = ranks, .grid = grid, .settings = settings});
  const CameraSource source = [&](int index) -> std::optional<FrameRequest> {
    if (index >= frames) return std::nullopt;
    Camera camera;
    camera.width = settings.width, camera.height = settings.height;
    camera.eye.x = index / 2;  // rests in every other frame
    return FrameRequest{index + 1, camera, false};
  };
  run_virtual_ranks(
      ranks, settings, [&](int) { return uneven_probe(settings.width); }, source,
      [&](FinishedFrame&& frame) { text += trace_line(traced(frame, grid)); });
  return parse_balance_trace(text, "run.trace").runs.at(0);
}

}  // namespace pprt
