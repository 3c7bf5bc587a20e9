#include "render/options/render_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <catch2/catch.hpp>
#include <utility>

#include "base/diagnostics.h"

namespace pprt::render_options_test {
namespace {

using Catch::Contains;

RenderOptions parse(std::vector<std::string> words) {
  words = with_long_np(std::move(words));
  std::reverse(words.begin(), words.end());  // as CLI11 wants them
  CLI::App app;
  RenderOptions options;
  add_render_options(app, options);
  app.parse(words);
  return options;
}

}  // namespace

TEST_CASE("mpirun's -np is accepted anywhere on the command line") {
  CHECK(parse({"-np", "32", "spd:tree"}).ranks.processes == 32);
  CHECK(parse({"spd:tree", "a.anim", "-np", "3", "--fps", "4"}).ranks.processes == 3);
  CHECK(parse({"spd:tree", "--np", "3"}).ranks.processes == 3);
  CHECK_FALSE(parse({"spd:tree"}).ranks.processes);
}

TEST_CASE(
    "all cores are used unless processes are named, counted work is to be the same, or a launcher is at "
    "work") {
  const auto ranks = [](std::vector<std::string> words, bool is_launched = false) {
    words.insert(words.begin(), "spd:tree");
    return ranks_in_process(parse(std::move(words)), is_launched).value_or(-1);
  };
  constexpr int kAll = -1;
  CHECK(ranks({}) == kAll);
  CHECK(ranks({"--fps", "24"}) == kAll);
  CHECK(ranks({"--clock", "work"}) == 1);
  CHECK(ranks({"-np", "2"}) == 1);
  CHECK(ranks({"-np", "1"}) == 1);
  CHECK(ranks({}, true) == 1);
  for (const bool is_launched : {false, true}) {
    CHECK(ranks({"--threads", "auto", "--clock", "work", "-np", "2"}, is_launched) == kAll);
    CHECK(ranks({"--threads", "3"}, is_launched) == 3);
  }
}

TEST_CASE("scene and script may stand among the options, in their order") {
  const RenderOptions options = parse({"-s", "8x8", "spd:tree", "--cast", "paper", "a.anim", "-o", "%d.png"});
  CHECK((options.source.input == "spd:tree" && options.source.script == "a.anim"));
  REQUIRE(options.size);
  CHECK((options.size->width == 8 && options.size->height == 8));
  CHECK(options.method.cast == CastChoice::kPaper);
}

TEST_CASE("the option --output may be given twice and takes one word each time") {
  const RenderOptions options = parse({"-o", "%d.png", "spd:tree", "-o", "%d.exr"});
  REQUIRE(options.output.pictures.size() == 2);
  CHECK((options.output.pictures[0].text == "%d.png" && options.output.pictures[1].text == "%d.exr"));
  CHECK(options.source.input == "spd:tree");
}

TEST_CASE("the option --output takes a film's name as --film does") {
  const RenderOptions film = parse({"spd:tree", "-o", "turn.mp4"});
  CHECK((film.output.film == "turn.mp4" && film.output.pictures.empty()));
  const RenderOptions both = parse({"spd:tree", "-o", "%d.png", "-o", "turn.gif"});
  CHECK((both.output.film == "turn.gif" && both.output.pictures.size() == 1));
}

TEST_CASE("a script before its scene is taken for what it is") {
  for (const auto& words : {std::vector<std::string>{"a.anim", "b.nff"}, {"b.nff", "a.anim"}}) {
    SourceOptions source = parse(words).source;
    put_in_order(source);
    CHECK((source.input == "b.nff" && source.script == "a.anim"));
  }
  SourceOptions alone = parse({"a.anim"}).source;
  put_in_order(alone);
  CHECK((alone.input == "a.anim" && alone.script.empty()));
}

TEST_CASE("numbers outside their range and unknown words are refused") {
  for (const auto& [option, value] : std::vector<std::pair<std::string, std::string>>{{"-np", "0"},
                                                                                      {"-np", "two"},
                                                                                      {"--fps", "-1"},
                                                                                      {"--clock", "sun"},
                                                                                      {"--samples", "0"},
                                                                                      {"--cast", "iron"},
                                                                                      {"--max-depth", "65"},
                                                                                      {"--seed", "-1"}}) {
    INFO(option << " " << value);
    CHECK_THROWS_AS(parse({"spd:tree", option, value}), CLI::ParseError);
  }
  for (const char* quality : {"nan", "0", "rmse=0", "rmse=nan", "rmse=", "mse=0.1"})
    CHECK_THROWS_AS(parse({"spd:tree", "--quality", quality}), UsageError);
  CHECK_THROWS_AS(parse({"spd:tree", "--resume", "--overwrite"}), CLI::ParseError);
}

TEST_CASE("every word of an option stands for its own value") {
  const auto clock = [](const std::string& word) {
    return parse({"spd:tree", "--clock", word}).method.clock;
  };
  CHECK((clock("wall") == ClockKind::kWall && clock("work") == ClockKind::kWork));
  for (const Word<BalanceMode>& entry : kWords<BalanceMode>) {
    CHECK(parse({"spd:tree", "--balance", std::string(entry.word)}).method.balance == entry.value);
  }
  for (const Word<CastChoice>& entry : kWords<CastChoice>) {
    CHECK(parse({"spd:tree", "--cast", std::string(entry.word)}).method.cast == entry.value);
  }
  for (const Word<PixelRule>& entry : kWords<PixelRule>) {
    CHECK(parse({"spd:tree", "--pixels", std::string(entry.word)}).method.pixel_rule == entry.value);
  }
  for (const Word<ProgressKind>& entry : kWords<ProgressKind>) {
    CHECK(parse({"spd:tree", "--progress", std::string(entry.word)}).progress == entry.value);
  }
  for (const Word<LogLevel>& entry : kWords<LogLevel>) {
    CHECK(parse({"spd:tree", "--log", std::string(entry.word)}).log == entry.value);
  }
  CHECK(parse({"spd:tree", "--weights", "paper"}).weights == WeightRule::kPaper);
  CHECK_FALSE(parse({"spd:tree", "--keep-samples", "off"}).method.keep_samples);
}

TEST_CASE("a mistyped word of an option is refused with the nearest one") {
  CHECK_THROWS_WITH(parse({"spd:tree", "--cast", "verfied"}), Contains("did you mean 'verified'?"));
  CHECK_THROWS_WITH(parse({"spd:tree", "--balance", "Global"}), Contains("did you mean 'global'?"));
}

TEST_CASE("a size that is no width and height is a usage error") {
  for (const std::string size :
       {"64", "x48", "64x", "0x48", "64x-1", "64x48x2", "64 x48", "20000x4", "a x b", "99999999999x1"}) {
    CHECK_THROWS_AS(parse({"spd:tree", "--size=" + size}), UsageError);
    CHECK_THROWS_WITH(parse({"spd:tree", "--size=" + size}),
                      Contains("--size " + size + ": want WIDTHxHEIGHT"));
  }
}

TEST_CASE("frames that are no range of numbers from 1 are a usage error") {
  for (const std::string frames : {"0-3", "4-2", "a-b", "3-", "-3-4", "1-99999999999"}) {
    CHECK_THROWS_AS(parse({"spd:tree", "--frames=" + frames}), UsageError);
    CHECK_THROWS_WITH(parse({"spd:tree", "--frames=" + frames}),
                      Contains("--frames " + frames + ": want FIRST-LAST"));
  }
  const RenderOptions one = parse({"spd:tree", "--frames", "7"});
  REQUIRE(one.frames);
  CHECK((one.frames->first == 7 && one.frames->last == 7));
}

TEST_CASE("file names, layers and effects that do not exist are usage errors") {
  const auto refuse = [](const std::string& option, const std::string& value, const std::string& message) {
    CHECK_THROWS_AS(parse({"spd:tree", option, value}), UsageError);
    CHECK_THROWS_WITH(parse({"spd:tree", option, value}), Contains(message));
  };
  refuse("--output", "%04d.jpg", "%04d.jpg");
  refuse("--reference", "%04d.jpg", "--reference '%04d.jpg'");
  refuse("--layers", "depth,colour", "--layers depth,colour: 'colour' is none of");
  refuse("--effects", "glitter", "glitter");
}

TEST_CASE("effects are all that the scene calls for unless some are listed") {
  CHECK_FALSE(parse({"spd:tree"}).compile.effects);
  CHECK_FALSE(parse({"spd:tree", "--effects", "auto"}).compile.effects);
  CHECK(parse({"spd:tree", "--effects", "none"}).compile.effects == EffectSet());
  CHECK(parse({"spd:tree", "--effects", "all"}).compile.effects == EffectSet::all());
}

}  // namespace pprt::render_options_test
