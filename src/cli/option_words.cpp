#include "cli/option_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "base/nearest_word.h"

namespace pprt {
namespace {

// A check's name is the one thing that CLI11 keeps and gives back: "use:word,word".
constexpr std::array<std::string_view, 3> kUses = {"one of", "some of", "path or"};

std::string check_name(WordUse use, const std::vector<std::string>& words) {
  return fmt::format("{}:{}", kUses[static_cast<std::size_t>(use)], fmt::join(words, ","));
}

CLI::Validator anything(WordUse use, const std::vector<std::string>& words) {
  return CLI::Validator([](std::string&) { return std::string(); }, "", check_name(use, words));
}

std::vector<std::string> split(std::string_view text) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    words.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

}  // namespace

void take_one_of(CLI::Option& option, const std::vector<std::string>& words) {
  const auto check = [words](const std::string& word) -> std::string {
    if (std::find(words.begin(), words.end(), word) != words.end()) return {};
    return fmt::format("'{}' is none of {}{}", word, fmt::join(words, ", "),
                       did_you_mean(word, std::vector<std::string_view>(words.begin(), words.end())));
  };
  option.check(CLI::Validator([check](std::string& word) { return check(word); }, "",
                              check_name(WordUse::kOneOf, words)));
  option.type_name(fmt::format("{}", fmt::join(words, "|")));
}

void take_some_of(CLI::Option& option, const std::vector<std::string>& words) {
  option.check(anything(WordUse::kSomeOf, words));
}

void take_path_or(CLI::Option& option, const std::vector<std::string>& words) {
  option.check(anything(WordUse::kPathOr, words));
}

std::optional<OptionWords> words_of(CLI::Option& option) {
  std::string name;
  try {
    name = option.get_validator(0)->get_name();
  } catch (const CLI::OptionNotFound&) {
    return std::nullopt;  // it has no check at all
  }
  for (const WordUse use : {WordUse::kOneOf, WordUse::kSomeOf, WordUse::kPathOr}) {
    const std::string_view prefix = kUses[static_cast<std::size_t>(use)];
    if (name.starts_with(prefix) && name.substr(prefix.size(), 1) == ":") {
      return OptionWords{use, split(std::string_view(name).substr(prefix.size() + 1))};
    }
  }
  return std::nullopt;
}

}  // namespace pprt
