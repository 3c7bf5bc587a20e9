#include "render/output/run_record.h"

#include <fmt/core.h>
#include <unistd.h>

#include "base/content_hash.h"
#include "cli/options/version.h"
#include "parallel/clock/make_clocks.h"
#include "parallel/settings/session_words.h"
#include "render/records/json_names.h"

namespace pprt {
namespace {

std::string host_name() {
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  return host;
}

// What --effects asks for.
std::string effects_word(const CompileOptions& compile) {
  return compile.effects ? to_string(*compile.effects) : "auto";
}

Json options_record(const RenderPlan& plan) {
  const SessionSettings& s = plan.settings;
  Json options = {{"fps", s.frames_per_second},
                  {"balance", word_for(s.balance)},
                  {"cast", word_for(s.cast)},
                  {"keep_samples", word_for(s.keep_samples)},
                  {"sampler", word_for<SamplerChoice>(s.sampler)},
                  {"weights", word_for(weight_rule(s))},
                  {"pixels", word_for(s.pixel_rule)},
                  {"seed", s.seed},
                  {"max_depth", plan.compile.max_depth},
                  {"cull", plan.compile.cull}};
  if (is_reproducible(s)) options["budget"] = s.budget_units;
  if (s.frames_per_second <= 0) {
    options["time"] = s.stop.seconds;
    options["samples"] = s.stop.samples;
    options["quality"] = s.stop.flip;
  }
  if (s.stop.rmse > 0) options["quality_rmse"] = s.stop.rmse;
  if (plan.film_time) options["film_time"] = *plan.film_time;
  return options;
}

}  // namespace

std::string run_key(const RunIdentity& run) {
  const SessionSettings& s = run.plan.settings;
  const CompileOptions& c = run.plan.compile;
  std::string text = fmt::format("{} {} {} {} {} {} {} {} {} {}", run.scene_hash, run.ranks, s.width,
                                 s.height, word_for(s.clock), s.frames_per_second, s.budget_units,
                                 s.stop.seconds, s.stop.samples, s.stop.flip);
  text += fmt::format(" {}{}{}{}{} {} {} {} {}{}", word_for(s.balance), word_for(s.keep_samples),
                      word_for<SamplerChoice>(s.sampler), word_for(s.pixel_rule), word_for(weight_rule(s)),
                      word_for(s.cast), s.seed, c.max_depth, effects_word(c), c.cull ? " cull" : "");
  if (s.stop.rmse > 0) text += fmt::format(" rmse {}", s.stop.rmse);
  if (run.plan.film_time) text += fmt::format(" film {}", *run.plan.film_time);
  for (const PlannedFrame& f : run.plan.script_frames) {
    const View& v = f.view;
    text += fmt::format("\n{} {} {} {} {} {} {} {} {} {} {} {}", f.number, f.cut, v.from.x, v.from.y,
                        v.from.z, v.at.x, v.at.y, v.at.z, v.up.x, v.up.y, v.up.z, v.angle_degrees);
    if (f.time != 0) text += fmt::format(" {}", f.time);
  }
  text += run.plan.script_keys;
  return content_hash(text);
}

Json run_record(const RunIdentity& run, EffectSet effects) {
  const SessionSettings& s = run.plan.settings;
  return {{"record", "run"},
          {"format", kLedgerFormat},
          {"version", kVersion},
          {"scene", json_name(run.plan.scene.name)},
          {"scene_hash", run.scene_hash},
          {"script", json_name(run.plan.script_name)},
          {"options", options_record(run.plan)},
          {"effects", to_string(effects)},
          {"ranks", run.ranks},
          {"size", {s.width, s.height}},
          {"clock", word_for(s.clock)},
          {"host", host_name()}};
}

}  // namespace pprt
