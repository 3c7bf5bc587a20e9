#include "render/render_options.h"

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>

namespace pprt {
namespace {

RenderOptions parse(std::vector<std::string> words) {
  words.insert(words.begin(), "pprt-render");
  std::vector<const char*> argv;
  for (const std::string& word : words) argv.push_back(word.c_str());
  std::vector<std::string> rest = with_long_np(static_cast<int>(argv.size()), argv.data());
  std::reverse(rest.begin(), rest.end());  // as CLI11 wants them
  CLI::App app;
  RenderOptions options;
  add_render_options(app, options);
  app.parse(rest);
  return options;
}

}  // namespace

TEST_CASE("mpirun's -np is one option, wherever it stands") {
  CHECK(parse({"-np", "32", "spd:tree"}).ranks == 32);
  CHECK(parse({"spd:tree", "a.anim", "-np", "3", "--fps", "4"}).ranks == 3);
  CHECK(parse({"spd:tree", "--np", "3"}).ranks == 3);
  CHECK(parse({"spd:tree"}).ranks == 1);
}

TEST_CASE("scene and script keep their places among the options") {
  const RenderOptions options = parse({"-s", "8x8", "spd:tree", "--cast", "paper", "a.anim", "-o", "%d.png"});
  CHECK((options.input == "spd:tree" && options.script == "a.anim" && options.size == "8x8"));
  CHECK(options.cast == "paper");
}

TEST_CASE("an output may be given twice and takes one word each time") {
  const RenderOptions options = parse({"-o", "%d.png", "spd:tree", "-o", "%d.exr"});
  CHECK(options.outputs == std::vector<std::string>{"%d.png", "%d.exr"});
  CHECK(options.input == "spd:tree");
}

TEST_CASE("numbers outside their range and words that are none are refused") {
  for (const auto& [option, value] : std::vector<std::pair<std::string, std::string>>{{"-np", "0"},
                                                                                      {"-np", "two"},
                                                                                      {"--fps", "-1"},
                                                                                      {"--clock", "sun"},
                                                                                      {"--samples", "0"},
                                                                                      {"--quality", "nan"},
                                                                                      {"--cast", "iron"},
                                                                                      {"--max-depth", "65"},
                                                                                      {"--seed", "-1"}}) {
    INFO(option << " " << value);
    CHECK_THROWS_AS(parse({"spd:tree", option, value}), CLI::ParseError);
  }
  CHECK_THROWS_AS(parse({"spd:tree", "--resume", "--overwrite"}), CLI::ParseError);
}

}  // namespace pprt
