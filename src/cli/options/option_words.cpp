#include "cli/options/option_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "base/nearest_word.h"

namespace pprt {
namespace {

// A check's name is the one thing that CLI11 keeps and gives back: a line for the use, then one for each word
// with its help after a tab.
constexpr std::array<std::string_view, 3> kUses = {"one of", "some of", "path or"};

std::string check_name(WordUse use, const std::vector<OptionWord>& words) {
  std::string name(kUses[static_cast<std::size_t>(use)]);
  for (const OptionWord& entry : words) name += "\n" + entry.word + "\t" + entry.help;
  return name;
}

CLI::Validator anything(WordUse use, const std::vector<std::string>& words) {
  return CLI::Validator([](std::string&) { return std::string(); }, "",
                        check_name(use, std::vector<OptionWord>(words.begin(), words.end())));
}

// "a\nb" -> "a" and "b".
std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

}  // namespace

void take_one_of(CLI::Option& option, const std::vector<OptionWord>& entries) {
  std::vector<std::string> words;
  words.reserve(entries.size());
  for (const OptionWord& entry : entries) words.push_back(entry.word);
  const auto check = [words](const std::string& word) -> std::string {
    if (std::find(words.begin(), words.end(), word) != words.end()) return {};
    return fmt::format("'{}' is none of {}{}", word, fmt::join(words, ", "),
                       did_you_mean(word, std::vector<std::string_view>(words.begin(), words.end())));
  };
  option.check(CLI::Validator([check](std::string& word) { return check(word); }, "",
                              check_name(WordUse::kOneOf, entries)));
  option.type_name(fmt::format("{}", fmt::join(words, "|")));
}

void take_some_of(CLI::Option& option, const std::vector<std::string>& words) {
  option.check(anything(WordUse::kSomeOf, words));
}

void take_path_or(CLI::Option& option, const std::vector<std::string>& words) {
  option.check(anything(WordUse::kPathOr, words));
}

std::optional<OptionWords> words_of(CLI::Option& option) {
  std::vector<std::string> lines;
  try {
    lines = lines_of(option.get_validator(0)->get_name());
  } catch (const CLI::OptionNotFound&) {
    return std::nullopt;  // it has no check at all
  }
  const auto use = std::find(kUses.begin(), kUses.end(), lines.front());
  if (use == kUses.end()) return std::nullopt;
  OptionWords result{static_cast<WordUse>(use - kUses.begin()), {}};
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::size_t tab = lines[i].find('\t');
    result.words.emplace_back(lines[i].substr(0, tab), lines[i].substr(tab + 1));
  }
  return result;
}

}  // namespace pprt
