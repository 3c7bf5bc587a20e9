#include "render/output/run_record.h"

#include <catch2/catch.hpp>
#include <functional>

namespace pprt::run_record_test {
namespace {

RenderPlan one_frame() {
  RenderPlan plan;
  plan.script_frames = {{.number = 1, .view = {}, .cut = false}};
  return plan;
}

std::string key_with(const std::function<void(RenderPlan&)>& change) {
  RenderPlan plan = one_frame();
  change(plan);
  return run_key({plan, 4, "hash"});
}

const std::string kPlain = key_with([](RenderPlan&) {});

}  // namespace

TEST_CASE("a run's key changes with every setting that decides its pictures") {
  const std::vector<std::function<void(RenderPlan&)>> changes = {
      [](RenderPlan& p) { p.settings.width = 7; },
      [](RenderPlan& p) { p.settings.height = 7; },
      [](RenderPlan& p) { p.settings.clock = ClockKind::kWork; },
      [](RenderPlan& p) { p.settings.frames_per_second = 3; },
      [](RenderPlan& p) { p.settings.budget_units = 3; },
      [](RenderPlan& p) { p.settings.stop.seconds = 3; },
      [](RenderPlan& p) { p.settings.stop.samples = 3; },
      [](RenderPlan& p) { p.settings.stop.flip = 3; },
      [](RenderPlan& p) { p.settings.stop.rmse = 3; },
      [](RenderPlan& p) { p.film_time = 3; },
      [](RenderPlan& p) { p.settings.balance = BalanceMode::kLocal; },
      [](RenderPlan& p) { p.settings.keep_samples = false; },
      [](RenderPlan& p) { p.settings.pixel_rule = PixelRule::kMean; },
      [](RenderPlan& p) { p.settings.sampler = SamplerChoice::kGrid; },
      [](RenderPlan& p) { p.settings.learned_weights = false; },
      [](RenderPlan& p) { p.settings.cast = CastChoice::kOff; },
      [](RenderPlan& p) { p.settings.seed = 2; },
      [](RenderPlan& p) { p.compile.max_depth = 2; },
      [](RenderPlan& p) { p.compile.effects = EffectSet(); },
      [](RenderPlan& p) { p.compile.cull = true; },
      [](RenderPlan& p) { p.script_keys = "key"; },
      [](RenderPlan& p) { p.script_frames[0].cut = true; },
      [](RenderPlan& p) { p.script_frames[0].number = 2; },
      [](RenderPlan& p) { p.script_frames[0].time = 2; },
      [](RenderPlan& p) { p.script_frames[0].view.angle_degrees = 2; },
      [](RenderPlan& p) { p.script_frames.push_back(p.script_frames[0]); }};
  std::set<std::string> keys = {kPlain};
  for (const auto& change : changes) keys.insert(key_with(change));
  for (int axis = 0; axis < 3; ++axis) {
    for (Vec3d View::*member : {&View::from, &View::at, &View::up})
      keys.insert(key_with([&](RenderPlan& p) { (p.script_frames[0].view.*member)[axis] = 2; }));
  }
  keys.insert(run_key({one_frame(), 5, "hash"}));
  keys.insert(run_key({one_frame(), 4, "another hash"}));
  CHECK(keys.size() == 1 + changes.size() + 3 * 3 + 2);
}

TEST_CASE("a run's key does not depend on which frames are rendered, nor on reports") {
  CHECK(key_with([](RenderPlan& p) { p.frames = p.script_frames; }) == kPlain);
  CHECK(key_with([](RenderPlan& p) { p.report.ledger = "-"; }) == kPlain);
  CHECK(key_with([](RenderPlan& p) { p.output.existing = ExistingFiles::kResume; }) == kPlain);
}

TEST_CASE("the ledger's first record spells choices as the options do") {
  RenderPlan plan;
  plan.settings.clock = ClockKind::kWork;
  plan.settings.balance = BalanceMode::kNone;
  plan.settings.keep_samples = false;
  plan.settings.learned_weights = false;
  plan.settings.pixel_rule = PixelRule::kCenter;
  const Json record = run_record({plan, 4, "hash"}, parse_effects("shadows"));
  CHECK((record["clock"] == "work" && record["effects"] == "shadows" && record["ranks"] == 4));
  const Json& options = record["options"];
  CHECK((options["balance"] == "none" && options["cast"] == "auto" && options["keep_samples"] == "off"));
  CHECK((options["weights"] == "paper" && options["pixels"] == "center" && options["max_depth"] == 5));
}

TEST_CASE("the ledger's first record has what ends frames, the measured error with a rate, too") {
  const auto options = [](double rate) {
    RenderPlan plan;
    plan.settings.frames_per_second = rate;
    plan.settings.stop = {.seconds = 2, .samples = 3, .flip = 0.25, .rmse = 0.5};
    return run_record({plan, 4, "hash"}, EffectSet())["options"];
  };
  const Json still = options(0), moving = options(GENERATE(25.0, 0.25));
  CHECK((still["time"] == 2 && still["samples"] == 3 && still["quality"] == 0.25));
  CHECK((!moving.contains("time") && !moving.contains("samples") && !moving.contains("quality")));
  CHECK((still["quality_rmse"] == 0.5 && moving["quality_rmse"] == 0.5));
  CHECK((moving["fps"] > 0 && !moving.contains("budget") && !moving.contains("film_time")));
  RenderPlan plan;
  plan.settings.clock = ClockKind::kWork, plan.settings.budget_units = 7, plan.film_time = 9;
  const Json film = run_record({plan, 4, "hash"}, EffectSet())["options"];
  CHECK((film["budget"] == 7 && film["film_time"] == 9 && !film.contains("quality_rmse")));
}

}  // namespace pprt::run_record_test
