// What --help prints.
#pragma once

#include <string>

#include "cli/option_table.h"

namespace pprt {

// Lines of at most 79 columns; each group of options, with its heading, fits on a screen of 24 lines.
// `usage_name` is what stands before the options: "pprt-study counts".
std::string help_text(const OptionTable& table, const std::string& usage_name);

}  // namespace pprt
