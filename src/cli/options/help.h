// The text of --help.
#pragma once

#include <span>
#include <string>

#include "cli/options/option_table.h"

namespace pprt {

// Returns lines of at most 79 columns. Each group of options, with its heading, fits on a screen of 24 lines.
// `usage_name` is the program, with its subcommand if any: "pprt-study counts".
// `usual`: the only options to list, by their last names and in this order; empty: all.
std::string help_text(const OptionTable& table, const std::string& usage_name,
                      std::span<const std::string> usual = {});

}  // namespace pprt
