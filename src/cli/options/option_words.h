// The words that an option takes, given once: they are checked, completed by the shell, and offered for a
// misspelled one. Private to the programs: shows CLI11.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/options/option_table.h"

namespace pprt {

// Each of these three must be the option's first check.

// Takes one of the words, of which the label is made; refuses any other.
void take_one_of(CLI::Option& option, const std::vector<OptionWord>& words);

// Takes some of the words, with commas between them. Whoever reads the list checks it.
void take_some_of(CLI::Option& option, const std::vector<std::string>& words);

// Takes a path, in whose place the words may stand. Refuses nothing.
void take_path_or(CLI::Option& option, const std::vector<std::string>& words);

enum class WordUse { kOneOf, kSomeOf, kPathOr };

struct OptionWords {
  WordUse use;
  std::vector<OptionWord> words;
};

// Returns what one of the functions above was given for the option.
std::optional<OptionWords> words_of(CLI::Option& option);

}  // namespace pprt
