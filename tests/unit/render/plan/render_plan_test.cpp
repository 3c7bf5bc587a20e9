#include "render/plan/render_plan.h"

#include <catch2/catch.hpp>
#include <fstream>

#include "base/diagnostics.h"
#include "parallel/exchange/samplers.h"
#include "render/options/render_options.h"
#include "render/plan/session_plan.h"
#include "unit/image/temporary_directory.h"

namespace pprt::render_plan_test {
namespace {

using Catch::Contains;

constexpr const char* kScript =
    "animation { frames 10 fps 4 resolution <64, 48>\n"
    "  camera { key 1 { from <5, 0, 2> at <0, 0, 1> up <0, 0, 1> angle 45 }\n"
    "           cut 6 { from <0, 5, 2> } } }\n";

// Files of a run, in a directory of their own.
class Files {
 public:
  std::string add(const std::string& name, const std::string& text) const {
    const std::string path = (directory_.path() / name).string();
    std::ofstream(path) << text;
    return path;
  }

 private:
  TemporaryDirectory directory_;
};

FramePattern pattern(const char* text) {
  return parse_frame_pattern(text, FrameCount::kOne);
}

RenderOptions options_for(const std::string& input, const std::string& script = "") {
  RenderOptions options;
  options.source.input = input, options.source.script = script;
  return options;
}

RenderPlan checked_plan(const RenderOptions& options) {
  check_usage(options);
  return plan_render(options);
}

RenderOptions scripted(const Files& files) {
  RenderOptions options = options_for("spd:tree:1", files.add("a.anim", kScript));
  options.output.pictures = {pattern("out/%04d.png")};
  return options;
}

}  // namespace

TEST_CASE("a still has the scene's view and ends at the weight for stills") {
  const RenderPlan plan = plan_render(options_for("spd:tree:1"));
  REQUIRE(plan.frames.size() == 1);
  CHECK((plan.frames[0].number == 1 && !plan.frames[0].cut));
  CHECK((plan.settings.width == 512 && plan.settings.height == 512));
  CHECK((plan.frames[0].view.width == 512 && plan.frames[0].view.height == 512));
  CHECK(plan.settings.frames_per_second == 0);
  CHECK(plan.settings.stop.weight == traits_of(SamplerChoice::kAuto).still_weight);
  CHECK((plan.settings.stop.samples == 0 && plan.settings.stop.seconds == 0));
  REQUIRE(plan.output.pictures.size() == 1);
  CHECK(file_name(plan.output.pictures[0], 1) == "frame_0001.png");
}

TEST_CASE("samples are sent to the master only for layers and reports made of them") {
  RenderOptions options = options_for("spd:tree:1");
  CHECK_FALSE(plan_render(options).settings.report_samples);
  options.output.layers = {Layer::kDepth, Layer::kRegions, Layer::kNormal, Layer::kId};
  CHECK_FALSE(plan_render(options).settings.report_samples);
  options.output.layers.push_back(Layer::kAge);
  CHECK(plan_render(options).settings.report_samples);
  options.output.layers.clear();
  options.report.compare_serial = true, options.report.ledger = "-";
  CHECK(plan_render(options).settings.report_samples);
}

TEST_CASE("weights are learned unless the paper's are asked for") {
  RenderOptions options = options_for("spd:tree:1");
  CHECK(plan_render(options).settings.learned_weights);
  options.weights = WeightRule::kPaper;
  CHECK_FALSE(plan_render(options).settings.learned_weights);
}

TEST_CASE("layers become pictures beside PNG outputs, and none beside EXR outputs") {
  RenderOptions options = options_for("spd:tree:1");
  options.output.pictures = {pattern("a_%04d.exr"), pattern("b_%04d.png")};
  options.output.layers = {Layer::kAge, Layer::kId};
  std::vector<std::string> names;
  for (const FramePattern& file : files_of_a_frame(plan_render(options).output))
    names.push_back(file_name(file, 2));
  CHECK(names == std::vector<std::string>{"a_0002.exr", "b_0002.png", "b_0002.age.png", "b_0002.id.png"});
}

TEST_CASE("the size of the options precedes the script's, and that the scene's") {
  const Files files;
  RenderOptions options = scripted(files);
  CHECK(plan_render(options).settings.width == 64);
  CHECK(plan_render(options).frames[3].view.height == 48);
  options.size = {200, 100};
  CHECK(plan_render(options).settings.width == 200);
  CHECK(plan_render(options).frames[3].view.height == 100);
}

TEST_CASE("the frame rate of the options precedes the script's, and 0 turns it off") {
  const Files files;
  RenderOptions options = scripted(files);
  CHECK(plan_render(options).settings.frames_per_second == 4);
  CHECK(plan_render(options).settings.budget_units == 12'500'000);
  options.end.fps = 10;
  CHECK(plan_render(options).settings.budget_units == 5'000'000);
  options.method.clock = ClockKind::kWork, options.end.budget = 123;
  CHECK(plan_render(options).settings.budget_units == 123);
  options.end.budget.reset(), options.end.fps = 0;
  CHECK(plan_render(options).settings.stop.weight == traits_of(SamplerChoice::kAuto).still_weight);
}

TEST_CASE("the triangulation is taken where an option asks for what it alone knows") {
  RenderOptions options = options_for("spd:tree:1");
  CHECK(plan_render(options).settings.sampler == SamplerChoice::kAuto);
  CHECK(plan_render(options).settings.is_still);
  const auto with = [&](const auto& change) {
    RenderOptions changed = options;
    change(changed);
    check_usage(changed);
    return plan_render(changed).settings;
  };
  CHECK(with([](RenderOptions& o) { o.method.cast = CastChoice::kPaper; }).sampler ==
        SamplerChoice::kDelaunay);
  CHECK(with([](RenderOptions& o) { o.weights = WeightRule::kPaper; }).sampler == SamplerChoice::kDelaunay);
  CHECK(with([](RenderOptions& o) { o.method.pixel_rule = PixelRule::kMean; }).sampler ==
        SamplerChoice::kDelaunay);
  CHECK(with([](RenderOptions& o) { o.method.pixel_rule = PixelRule::kMean; }).stop.weight ==
        traits_of(SamplerChoice::kDelaunay).still_weight);
  options.method.sampler = SamplerChoice::kGrid;
  CHECK(with([](RenderOptions&) {}).stop.weight == 0);
  options.method.cast = CastChoice::kPaper;
  CHECK_THROWS_WITH(check_usage(options), Catch::Contains("--sampler grid has no triangles"));
}

TEST_CASE("a stop rule that is given replaces the weight for stills") {
  RenderOptions options = options_for("spd:tree:1");
  options.end.samples = 500;
  CHECK(plan_render(options).settings.stop.samples == 500);
  CHECK(plan_render(options).settings.stop.weight == 0);
  options.end.quality = Quality{.flip = 0.5};
  CHECK((plan_render(options).settings.stop.flip == 0.5 && plan_render(options).settings.stop.weight == 0));
  options.end = FrameEnd();
  options.end.quality = parse_quality("rmse=0.25");
  CHECK((plan_render(options).settings.stop.rmse == 0.25 && plan_render(options).settings.stop.flip == 0));
}

TEST_CASE("a measured RMSE ends frames at a rate, too, which a FLIP does not") {
  const Files files;
  RenderOptions options = scripted(files);
  options.end.fps = 10;
  options.end.quality = parse_quality("rmse=0.02");
  CHECK((plan_render(options).settings.stop.rmse == 0.02 &&
         plan_render(options).settings.frames_per_second == 10));
  options.end.quality = parse_quality("0.02");
  CHECK_THROWS_WITH(plan_render(options), Catch::Contains("a FLIP as --quality"));
  for (const char* text :
       {"", "rmse", "rmse=", "rmse=2", "rmse=nan", "0", "1.5", "flip=.1", "rmse=.1x", "rmse=-1"})
    CHECK_THROWS_WITH(parse_quality(text),
                      Catch::StartsWith("--quality " + std::string(text) + ": want a FLIP or"));
}

TEST_CASE("a film's time makes the mean rate of its frames, which are all whole") {
  const Files files;
  RenderOptions options = scripted(files);
  options.end.film_time = 5;
  const RenderPlan plan = plan_render(options);
  CHECK(plan.settings.frames_per_second == Approx(static_cast<double>(plan.frames.size()) / 5));
  CHECK((plan.settings.awaits_all && plan.film_time == 5.0));
  options.frames = {3, 3};
  CHECK_THROWS_WITH(plan_render(options), Catch::Contains("there is one"));
}

TEST_CASE("all frames, a range or one are planned, and camera cuts keep their frames") {
  const Files files;
  RenderOptions options = scripted(files);
  RenderPlan plan = plan_render(options);
  REQUIRE(plan.frames.size() == 10);
  CHECK(plan.frames[5].cut);
  CHECK(plan.frames[5].view.from.y == 5);
  CHECK_FALSE(plan.frames[4].cut);

  options.frames = {5, 7};
  plan = plan_render(options);
  REQUIRE(plan.frames.size() == 3);
  CHECK((plan.frames[0].number == 5 && plan.frames[2].number == 7));
  CHECK(plan.script_frames.size() == 10);
  CHECK(plan.frames[1].cut);
  options.frames = {7, 7};
  CHECK(plan_render(options).frames.size() == 1);
}

TEST_CASE("of a long script only the frames to render and some to judge it by are planned") {
  const Files files;
  RenderOptions options = options_for(
      "spd:tree:1", files.add("a.anim",
                              "animation { frames 1000000 fps 4 resolution <64, 48>\n"
                              "  camera { key 1 { from <5, 0, 2> at <0, 0, 1> up <0, 0, 1> angle 45 }\n"
                              "           cut 500000 { from <0, 5, 2> } } }\n"));
  options.output.pictures = {pattern("out/%07d.png")};
  options.frames = {499'999, 500'000};
  const RenderPlan plan = plan_render(options);
  REQUIRE(plan.frames.size() == 2);
  CHECK((plan.frames[0].number == 499'999 && plan.frames[1].number == 500'000));
  CHECK((!plan.frames[0].cut && plan.frames[1].cut && plan.frames[1].view.from.y == 5));
  CHECK(plan.script_length == 1'000'000);
  REQUIRE(plan.script_frames.size() == kMostJudged);
  CHECK((plan.script_frames.front().number == 1 && plan.script_frames.back().number == 1'000'000));
  CHECK(plan.script_keys.find("cut ") != std::string::npos);
  options.frames = {1'000'001, 1'000'001};
  CHECK_THROWS_WITH(plan_render(options), "--frames 1000001: the last frame is 1000000");
}

TEST_CASE("a script may name its scene, relative to its own directory") {
  const Files files;
  files.add("ball.nff",
            "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 30\nhither 1\nresolution 8 8\nf 1 1 1 1 0 0 0 0\n"
            "s 0 0 0 1\n");
  const std::string script =
      files.add("b.anim", "animation { scene \"ball.nff\" frames 3 camera { key 1 { from <0, 0, 4> } } }\n");
  RenderOptions options = options_for(script);
  options.output.pictures = {pattern("%d.exr")};
  const RenderPlan plan = plan_render(options);
  CHECK((plan.frames.size() == 3 && plan.settings.width == 8));
  CHECK(plan.script_name == script);
  CHECK_THROWS_WITH(plan_render(options_for(files.add("c.anim", "animation { frames 3 }\n"))),
                    Contains("names no scene"));
}

TEST_CASE("a name without a place for the number gets the first frame, and it is said how to get more") {
  const Files files;
  RenderOptions options = scripted(files);
  options.output.pictures = {pattern("out/one.png")};
  const RenderPlan plan = plan_render(options);
  CHECK((plan.frames.size() == 1 && plan.frames[0].number == 1));
  CHECK(plan.warnings ==
        "pprt-render: 'out/one.png' has no place for a number: only frame 1 of 10 is rendered; "
        "-o 'out/one_%04d.png' gives all, -o 'out/one.mp4' a film\n");
}

TEST_CASE("frames of a film alone stand beside it for a while") {
  const Files files;
  RenderOptions options = scripted(files);
  options.output.film = "films/a.mp4", options.output.pictures.clear();
  const RenderPlan plan = plan_render(options);
  CHECK_FALSE(plan.output.keeps_frames);
  CHECK(file_name(plan.output.pictures.at(0), 7) == "films/a.mp4.frames/000007.png");
  options.output.pictures = {pattern("%d.png")};
  CHECK(plan_render(options).output.keeps_frames);
}

TEST_CASE("options that contradict each other are usage errors that say why") {
  const Files files;
  const auto refuse = [&](const std::function<void(RenderOptions&)>& change, const std::string& message) {
    RenderOptions options = scripted(files);
    change(options);
    INFO(message);
    CHECK_THROWS_AS(checked_plan(options), UsageError);
    CHECK_THROWS_WITH(checked_plan(options), Contains(message));
  };
  refuse([](RenderOptions& o) { o.frames = {3, 11}; }, "the last frame is 10");
  refuse([](RenderOptions& o) { o.end.samples = 10; }, "--fps 0 turns it off");
  refuse([](RenderOptions& o) { o.end.budget = 10; }, "--clock work");
  refuse([](RenderOptions& o) { o.end.budget = 10, o.method.clock = ClockKind::kWork, o.end.fps = 0; },
         "--budget needs a frame rate");
  refuse([](RenderOptions& o) { o.output.pictures = {pattern("one.png")}, o.frames = {1, 2}; }, "one.png");
  refuse([](RenderOptions& o) { o.report.compare_serial = true; },
         "--compare-serial tells the ledger: it needs --stats");
}

TEST_CASE("a degenerate camera is reported with its place in the script") {
  const Files files;
  RenderOptions options = scripted(files);
  options.source.script =
      files.add("d.anim", "animation { frames 2\n  camera { key 1 { from <1, 1, 1> at <1, 1, 1> } } }\n");
  CHECK_THROWS_AS(plan_render(options), InputError);
  CHECK_THROWS_WITH(plan_render(options), Contains("d.anim:2:"));
}

TEST_CASE("a scene without a view needs a script that gives one") {
  const Files files;
  const std::string scene = files.add("blind.nff", "f 1 1 1 1 0 0 0 0\ns 0 0 0 1\n");
  CHECK_THROWS_AS(plan_render(options_for(scene)), InputError);
  RenderOptions options = options_for(scene, files.add("a.anim", kScript));
  options.output.pictures = {pattern("%d.png")};
  CHECK(plan_render(options).frames.size() == 10);
}

}  // namespace pprt::render_plan_test
