#include "cli/options/help.h"

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>

#include "cli/options/option_words.h"

namespace pprt::help_test {
namespace {

OptionTable sample_table() {
  CLI::App app("Makes a thing of many words, so many that its description needs a second line to stand on.",
               "make-thing");
  std::string scene, clock, file, list;
  bool dry = false;
  int count = 3;
  auto* option = app.add_option("SCENE", scene, "What is made");
  option->required()->type_name("");
  take_path_or(*option, {"spd:tree"});
  option = app.add_option("--clock", clock, "Which time counts");
  option->default_str("wall")->group("Run");
  take_one_of(*option, {{"wall", "real time"}, "work"});
  app.add_option("-n,--count", count, "How often")
      ->check(CLI::Range(1, 9))
      ->capture_default_str()
      ->type_name("N")
      ->group("Run");
  app.add_flag("--dry", dry, "Make nothing")->group("Run");
  app.add_option("-o,--output", file, "Where to")->type_name("FILE")->group("Files");
  option = app.add_option("--very-long-name-of-an-option", list, "Which of them");
  option->type_name("LIST")->group("Files");
  take_some_of(*option, {"a", "b"});
  app.set_help_flag("-h,--help", "Help");
  return option_table(app);
}

}  // namespace

TEST_CASE("the option table holds names, kind of value, words and default of each option") {
  const OptionTable table = sample_table();
  const auto row = [&](const std::string& name) {
    for (const OptionRow& r : table.rows) {
      if (r.names.back() == name) return r;
    }
    throw std::runtime_error("no option " + name);
  };
  CHECK(row("SCENE").positional);
  CHECK(row("SCENE").required);
  CHECK(row("SCENE").value == ValueKind::kPath);
  CHECK(row("SCENE").words == std::vector<OptionWord>{"spd:tree"});
  CHECK(row("--clock").value == ValueKind::kChoice);
  CHECK(row("--clock").words == std::vector<OptionWord>{{"wall", "real time"}, "work"});
  CHECK(row("--count").names == std::vector<std::string>{"-n", "--count"});
  CHECK(row("--count").value == ValueKind::kAny);
  CHECK(row("--count").label == "N");
  CHECK(row("--count").default_value == "3");
  CHECK(row("--dry").value == ValueKind::kNone);
  CHECK(row("--dry").label.empty());
  CHECK(row("--output").value == ValueKind::kPath);
  CHECK(row("--very-long-name-of-an-option").value == ValueKind::kList);
  CHECK(row("--help").value == ValueKind::kNone);
}

TEST_CASE("help lists options in groups, in their order, within 79 columns") {
  CHECK(help_text(sample_table(), "make-thing") ==
        "Makes a thing of many words, so many that its description needs a second line\n"
        "to stand on.\n"
        "Usage: make-thing [OPTIONS] SCENE\n"
        "\n"
        "  SCENE                 What is made\n"
        "\n"
        "Run:\n"
        "  --clock wall|work     Which time counts [wall]\n"
        "  -n,--count N          How often [3]\n"
        "  --dry                 Make nothing\n"
        "\n"
        "Files:\n"
        "  -o,--output FILE      Where to\n"
        "  --very-long-name-of-an-option LIST\n"
        "                        Which of them\n"
        "\n"
        "Options:\n"
        "  -h,--help             Help\n");
}

TEST_CASE("usual options are listed alone, in their own order") {
  const std::vector<std::string> usual = {"--output", "--count"};
  const std::string text = help_text(sample_table(), "make-thing", usual);
  CHECK(text.substr(text.find("Usual")) ==
        "Usual options:\n"
        "  -o,--output FILE      Where to\n"
        "  -n,--count N          How often [3]\n"
        "\n"
        "All options: make-thing --help all\n");
}

TEST_CASE("the label of a value may have an optional part with a colon") {
  CLI::App app("", "make-thing");
  std::string text;
  app.add_option("--live", text, "Where")->type_name("[ADDRESS:]PORT");
  const OptionTable table = option_table(app);
  CHECK(table.rows.back().label == "[ADDRESS:]PORT");
}

}  // namespace pprt::help_test
