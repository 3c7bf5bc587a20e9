// The options of a program as plain values, from which help and shell completion are made.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace pprt {

enum class ValueKind {
  kNone,    // a flag
  kAny,     // cannot be listed: numbers and the like
  kChoice,  // one of `words`
  kList,    // some of `words`, with commas between them
  kPath,    // a file or directory, or one of `words`
};

struct OptionWord {
  OptionWord(std::string its_word, std::string its_help = {})  // NOLINT(google-explicit-constructor)
      : word(std::move(its_word)), help(std::move(its_help)) {}
  OptionWord(const char* its_word) : word(its_word) {}  // NOLINT(google-explicit-constructor)

  std::string word;
  std::string help;  // what it chooses; empty: not described

  friend bool operator==(const OptionWord&, const OptionWord&) = default;
};

struct OptionRow {
  std::vector<std::string> names;  // "-o", "--output"; of a positional its one name, "SCENE"
  std::string group;               // heading in the help
  std::string label;               // of the value: "FILE", "wall|work"
  std::string description;
  std::string default_value;  // empty: none to show
  ValueKind value = ValueKind::kNone;
  std::vector<OptionWord> words;
  bool positional = false;
  bool required = false;
  bool many = false;  // a positional that may be given more than once
};

struct OptionTable {
  std::string program;  // "pprt-study"; of a subcommand "counts"
  std::string description;
  std::vector<OptionRow> rows;
  std::vector<OptionTable> subcommands;
};

// Reads the options of the program and of its subcommands; hidden ones are left out.
OptionTable option_table(CLI::App& app);

}  // namespace pprt
