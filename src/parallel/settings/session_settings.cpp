#include "parallel/settings/session_settings.h"

#include "parallel/network/wire.h"

namespace pprt {

static_assert(sizeof(SessionSettings) == 128, "what is added to the settings must be sent as well");

Bytes encode(const SessionSettings& settings) {
  WireWriter out;
  out.put(settings.width), out.put(settings.height), out.put(settings.clock);
  out.put(settings.frames_per_second), out.put(settings.budget_units), out.put(settings.stop);
  out.put(settings.balance), out.put(settings.cast), out.put(settings.keep_samples);
  out.put(settings.pixel_rule), out.put(settings.sampler), out.put(settings.learned_weights);
  out.put(settings.seed);
  out.put(settings.is_still), out.put(settings.report_samples), out.put(settings.report_transfers);
  out.put(settings.late_orders);
  out.put(settings.machine);
  return out.take();
}

SessionSettings decode_settings(const Bytes& bytes) {
  SamplerChoice sampler{};
  SessionSettings settings{.sampler = sampler};
  WireReader in(bytes);
  in.get(settings.width), in.get(settings.height), in.get(settings.clock, ClockKind::kWork);
  in.get(settings.frames_per_second), in.get(settings.budget_units), in.get(settings.stop);
  in.get(settings.balance, BalanceMode::kCombined), in.get(settings.cast, CastChoice::kAuto);
  in.get(settings.keep_samples), in.get(settings.pixel_rule, PixelRule::kEdges);
  in.get(sampler, SamplerChoice::kGrid), in.get(settings.learned_weights), in.get(settings.seed);
  in.get(settings.is_still), in.get(settings.report_samples), in.get(settings.report_transfers);
  in.get(settings.late_orders);
  in.get(settings.machine);
  in.expect_end();
  settings.sampler = sampler;
  return settings;
}

}  // namespace pprt
