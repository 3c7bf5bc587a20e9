#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <random>

#include "parser/text/text_input.h"
#include "unit/parser/anim/script.h"

namespace pprt::anim_limits_test {
namespace {

// A hostile text is either rejected with a report or is an animation that keeps its promises.
void check_survives(std::string_view text) {
  try {
    const Animation a = parse_animation(text, "a.anim").animation;
    CHECK(a.frames >= 1);
    for (std::size_t i = 0; i < a.keys.size(); ++i) {
      CHECK(std::isfinite(a.keys[i].from.length()));
      CHECK((i == 0 || a.keys[i - 1].frame < a.keys[i].frame));
    }
    CHECK((a.keys.empty() || !(a.keys[0].cut || a.keys[0].hold)));
    for (double frame = 0; frame < 50; frame += 3.7) view_at(a, frame, View{});
  } catch (const InputError& error) {
    CHECK(std::string(error.what()).starts_with("a.anim:"));
  }
}

TEST_CASE("a script cut off at any byte is rejected or read") {
  const std::string_view text(kExample);
  for (std::size_t size = 0; size <= text.size(); ++size) check_survives(text.substr(0, size));
}

TEST_CASE("every script that comes with the project, cut off at any byte, is rejected or read") {
  int scripts = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(PPRT_SOURCE_DIR) + "/scenes")) {
    if (entry.path().extension() != ".anim") continue;
    const std::string text = read_text(entry.path().string(), 1 << 20);
    CAPTURE(entry.path().string());
    for (std::size_t size = 0; size <= text.size(); ++size)
      check_survives(std::string_view(text).substr(0, size));
    ++scripts;
  }
  CHECK(scripts > 5);
}

TEST_CASE("scripts with bytes changed, dropped and doubled are rejected or read") {
  std::mt19937 random(1);
  const std::string_view letters(
      "<>{}(),;\"/*#-+^ \n\r\0"
      "0189.ekays",
      29);
  for (int round = 0; round < 3000; ++round) {
    std::string text = kExample;
    for (int change = 0; change < 3; ++change) {
      const std::size_t at = random() % text.size();
      switch (random() % 3) {
        case 0:
          text[at] = letters[random() % letters.size()];
          break;
        case 1:
          text.erase(at, random() % 20);
          break;
        default:
          text.insert(at, text.substr(random() % text.size(), random() % 30));
      }
    }
    check_survives(text);
  }
}

std::string repeated(std::string_view what, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += what;
  return all;
}

TEST_CASE("expressions nest a hundred deep, and no deeper whatever nests") {
  // A component of a vector is one level down already, and the number itself is one.
  CHECK(value(repeated("(", 98) + "1" + repeated(")", 98)) == 1);
  const auto opening = GENERATE("(", "-", "+", "1^", "sin(", "<", "max(1,", "2^-(");
  const std::string text = script_report("animation { frames " + repeated(opening, 100'000) + "1 }");
  CHECK(text.find("error: the expression nests deeper than 100 levels\n") != std::string::npos);
}

TEST_CASE("skipped blocks may nest to any depth") {
  const std::string text =
      script_report("animation { what " + repeated("{", 100'000) + repeated("}", 100'000) + " frames 0 }");
  CHECK(text.find("unknown word 'what'") != std::string::npos);
  CHECK(text.find("'frames' is a whole number") != std::string::npos);
}

TEST_CASE("keys, names and bytes are bounded") {
  std::string keys = "animation { camera { ";
  for (int i = 1; i <= 100'001; ++i) keys += "key " + std::to_string(i) + "{}";
  CHECK(script_report(keys + "}}").find("error: more than 100000 keys") != std::string::npos);

  std::string names;
  for (int i = 0; i <= 100'001; ++i) names += "#declare a" + std::to_string(i) + "=1;";
  CHECK(script_report(names).find("error: more than 100000 names") != std::string::npos);

  CHECK(script_report(std::string((std::size_t{16} << 20) + 1, ' ')) ==
        "a.anim: error: longer than 16777216 bytes, the most for a script");
}

TEST_CASE("any number of problems takes bounded memory and time") {
  const std::string text = script_report(repeated("what {}\n", 200'000));
  CHECK(text.size() < 10'000);
  CHECK(text.ends_with("a.anim: 199950 further problems not shown"));
  const std::string divisions = script_report("#declare R = " + repeated("1/0\n+", 200'000) + "1;");
  CHECK(divisions.size() < 10'000);
}

TEST_CASE("long sums take no stack") {
  CHECK(value(repeated("1+", 200'000) + "1") == 200'001);
}

}  // namespace
}  // namespace pprt::anim_limits_test
