// How all programs read their command line. Private to the programs: shows CLI11.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace pprt {

// Adds --help, --version and --completion. Call it after all other options and subcommands are added.
// `usual`: the options that --help lists, by their long names; "--help all" lists all. Empty: both do.
void add_common_flags(CLI::App& app, std::vector<std::string> usual = {});

// Parses into the options bound to `app`. Returns false when --help, --version or --completion has been
// printed, and nothing is left to do. Throws UsageError for a command line that makes no sense. `words`
// leaves out the program's name.
bool parse_command_line(CLI::App& app, int argc, const char* const* argv);
bool parse_command_line(CLI::App& app, std::vector<std::string> words);

}  // namespace pprt
