// The options of a program as plain values: help and shell completion are both made from them.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace pprt {

enum class ValueKind {
  kNone,    // a flag
  kAny,     // numbers and the like, which nobody can list
  kChoice,  // one of `words`
  kList,    // some of `words`, with commas between them
  kPath,    // a file or directory, or one of `words`
};

struct OptionRow {
  std::vector<std::string> names;  // "-o", "--output"; of a positional its one name, "SCENE"
  std::string group;               // heading in the help
  std::string label;               // of the value: "FILE", "wall|work"
  std::string description;
  std::string default_value;  // empty: none to tell
  ValueKind value = ValueKind::kNone;
  std::vector<std::string> words;
  bool positional = false;
  bool required = false;
  bool many = false;  // a positional that may stand more than once
};

struct OptionTable {
  std::string program;  // "pprt-study"; of a subcommand "counts"
  std::string description;
  std::vector<OptionRow> rows;
  std::vector<OptionTable> subcommands;
};

OptionTable option_table(CLI::App& app);

}  // namespace pprt
