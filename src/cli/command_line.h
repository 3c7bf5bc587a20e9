// The one way in which all programs read their command line. Private to src/app: shows CLI11.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace pprt {

// Gives the program its --help and --version flags.
void add_common_flags(CLI::App& app);

// Parses into the options bound to `app`. False: --help or --version was asked for and has been printed, and
// nothing is left to do. Throws UsageError when the command line makes no sense.
bool parse_command_line(CLI::App& app, int argc, const char* const* argv);
bool parse_command_line(CLI::App& app, std::vector<std::string> words);  // without the program's name

}  // namespace pprt
