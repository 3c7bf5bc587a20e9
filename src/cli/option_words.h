// The words that may stand behind an option, told once: they are checked, completed by the shell, and offered
// for a misspelled one. Private to src/app: shows CLI11.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

namespace pprt {

// Each is to be the option's first check.

// One of the words; the label is made of them. What is none of them is refused.
void take_one_of(CLI::Option& option, const std::vector<std::string>& words);

// Some of the words, with commas between them; who reads the list checks it.
void take_some_of(CLI::Option& option, const std::vector<std::string>& words);

// A path, for which the words may stand in; whatever the shell has no word for is right.
void take_path_or(CLI::Option& option, const std::vector<std::string>& words);

enum class WordUse { kOneOf, kSomeOf, kPathOr };

struct OptionWords {
  WordUse use;
  std::vector<std::string> words;
};

// What the above was told.
std::optional<OptionWords> words_of(CLI::Option& option);

}  // namespace pprt
