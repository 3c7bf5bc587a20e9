// Completion of command lines by the shell.
#pragma once

#include <string>
#include <string_view>

#include "cli/option_table.h"

namespace pprt {

enum class Shell { kBash, kZsh, kFish };

// A script that tells the shell all of the program's options and the words and files behind them.
std::string completion_script(const OptionTable& table, Shell shell);

}  // namespace pprt
