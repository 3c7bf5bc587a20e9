// Completion of command lines by the shell.
#pragma once

#include <string>

#include "base/words.h"
#include "cli/options/option_table.h"

namespace pprt {

enum class Shell { kBash, kZsh, kFish };

template <>
inline constexpr std::array<Word<Shell>, 3> kWords<Shell>{
    {{Shell::kBash, "bash", ""}, {Shell::kZsh, "zsh", ""}, {Shell::kFish, "fish", ""}}};

// Returns a script that defines the completion of the program's options and their values. Zsh and fish show
// the words' help beside them; bash cannot.
std::string completion_script(const OptionTable& table, Shell shell);

}  // namespace pprt
