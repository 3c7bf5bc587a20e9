// The text that --config reads and --write-config prints. Private to the programs: shows CLI11.
//
//   ; a comment
//   seed=7
//   output=["a;b.png", 'c.exr']
//   cull
//
// In double quotes \" \\ \n \r and \t stand for one character; in single quotes each stands for itself.
// Values are separated by commas or blanks. A semicolon outside quotes begins a comment, and so does # at the
// beginning of a line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace pprt {

// Returns the options in such a text. CLI11's own reader cannot give back every file name. Throws
// CLI::ConfigError for a quotation mark that is not closed.
std::vector<CLI::ConfigItem> config_items(std::string_view text);

// Returns the options in force as such a file, each below its description, without unset options and flags
// that are off. The reader gives back every value.
std::string config_text(const CLI::App& app);

}  // namespace pprt
