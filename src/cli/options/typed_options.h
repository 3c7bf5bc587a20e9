// Options that hold a parsed value: their text is parsed once, while the command line is read. Private to the
// programs: shows CLI11.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/words.h"
#include "cli/options/option_words.h"

namespace pprt {

// Returns the words of an enum (base/words.h) as options take them.
template <typename E>
std::vector<OptionWord> option_words() {
  std::vector<OptionWord> words;
  for (const Word<E>& entry : kWords<E>) words.emplace_back(std::string(entry.word), std::string(entry.help));
  return words;
}

// Adds an option that takes one of the words of an enum. `value` holds the default.
template <typename E>
CLI::Option& add_choice(CLI::App& app, const std::string& name, E& value, const std::string& description) {
  // The check below lets no other words through.
  const auto set = [&value](const std::string& word) { value = find_word<E>(word).value(); };
  CLI::Option& option = *app.add_option_function<std::string>(name, set, description);
  take_one_of(option, option_words<E>());
  option.default_str(std::string(word_for(value)));
  return option;
}

// Adds an option whose text `parse` makes a T of, or throws UsageError. An empty text counts as no value.
template <typename T, typename Parse>
CLI::Option& add_parsed(CLI::App& app, const std::string& name, Parse parse, std::optional<T>& value,
                        const std::string& description) {
  const auto set = [&value, parse](const std::string& text) {
    value = text.empty() ? std::nullopt : std::optional<T>(parse(text));
  };
  return *app.add_option_function<std::string>(name, set, description);
}

}  // namespace pprt
