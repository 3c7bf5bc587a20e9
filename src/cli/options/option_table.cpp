#include "cli/options/option_table.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "cli/options/option_words.h"

namespace pprt {
namespace {

ValueKind value_kind(const CLI::Option& option, const std::optional<OptionWords>& words,
                     const std::string& label) {
  constexpr std::array<std::string_view, 4> kPathLabels = {"FILE", "DIR", "PATTERN", "OUT"};
  if (option.get_items_expected_max() == 0) return ValueKind::kNone;
  if (words) {
    switch (words->use) {
      case WordUse::kOneOf:
        return ValueKind::kChoice;
      case WordUse::kSomeOf:
        return ValueKind::kList;
      case WordUse::kPathOr:
        return ValueKind::kPath;
    }
  }
  const bool path = std::find(kPathLabels.begin(), kPathLabels.end(), label) != kPathLabels.end();
  return path ? ValueKind::kPath : ValueKind::kAny;
}

// "N:INT in [1 - 4096]", with what the checks say, -> "N"; "[ADDRESS:]PORT" stays whole.
std::string label_of(const std::string& type) {
  const std::size_t optional_part = type.starts_with('[') ? type.find(']') : 0;
  return type.substr(0, type.find(':', std::min(optional_part, type.size())));
}

OptionRow row_of(CLI::Option& option) {
  OptionRow row;
  row.positional = option.get_positional();
  if (row.positional) {
    row.names = {option.get_name(true)};
    row.many = option.get_expected_max() == CLI::detail::expected_max_vector_size;
  } else {
    for (const std::string& name : option.get_snames()) row.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) row.names.push_back("--" + name);
  }
  row.group = option.get_group();
  std::optional<OptionWords> words = words_of(option);
  const std::string type = option.get_type_name();
  row.label = label_of(type);
  row.description = option.get_description();
  row.value = value_kind(option, words, row.label);
  if (row.value == ValueKind::kNone) row.label.clear();
  row.default_value = option.get_default_str();
  row.required = option.get_required();
  if (words) row.words = std::move(words->words);
  return row;
}

}  // namespace

OptionTable option_table(CLI::App& app) {
  OptionTable table{app.get_name(), app.get_description(), {}, {}};
  for (CLI::Option* option : app.get_options({})) {
    if (!option->get_group().empty()) table.rows.push_back(row_of(*option));
  }
  for (CLI::App* subcommand : app.get_subcommands({})) table.subcommands.push_back(option_table(*subcommand));
  return table;
}

}  // namespace pprt
