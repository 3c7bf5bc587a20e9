#include "parallel/settings/session_settings.h"

#include "base/wire.h"

namespace pprt {

static_assert(sizeof(SessionSettings) == 152, "what is added to the settings must be sent as well");

namespace {

template <typename Code>
void fields_of(Code& code, Either<SessionSettings> auto& s) {
  code(s.width, s.height, s.clock, s.frames_per_second, s.budget_units, s.stop, s.balance, s.cast,
       s.keep_samples, s.pixel_rule, s.sampler.choice(), s.learned_weights, s.seed, s.is_still,
       s.report_samples, s.measures_error, s.awaits_all, s.probe_share, s.report_transfers, s.late_orders,
       s.machine);
}

}  // namespace

Bytes encode(const SessionSettings& settings) {
  WireWriter out;
  FieldWriter code(out);
  fields_of(code, settings);
  return out.take();
}

SessionSettings decode_settings(const Bytes& bytes) {
  WireReader in(bytes);
  FieldReader code(in);
  SessionSettings settings{.sampler = SamplerChoice{}};
  fields_of(code, settings);
  in.expect_end();
  return settings;
}

}  // namespace pprt
