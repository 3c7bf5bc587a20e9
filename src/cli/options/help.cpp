#include "cli/options/help.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>
#include <string_view>
#include <vector>

namespace pprt {
namespace {

constexpr std::size_t kColumns = 79;
constexpr std::size_t kIndent = 24;  // where descriptions begin

std::string wrapped(const std::string& text, std::size_t indent) {
  std::istringstream words(text);
  std::string result;
  std::size_t column = indent;
  for (std::string word; words >> word;) {
    if (column > indent && column + 1 + word.size() > kColumns) {
      result += "\n" + std::string(indent, ' ');
      column = indent;
    }
    if (column > indent) result += ' ';
    column += word.size() + (column > indent ? 1 : 0);
    result += word;
  }
  return result;
}

// Returns the name in the left column, and the description beside it, or below a long name.
std::string entry(const std::string& name, const std::string& description) {
  std::string line = "  " + name;
  const bool fits = line.size() + 2 <= kIndent;
  line += fits ? std::string(kIndent - line.size(), ' ') : "\n" + std::string(kIndent, ' ');
  return line + wrapped(description, kIndent) + "\n";
}

std::string entry(const OptionRow& row) {
  const std::string name = fmt::format("{}", fmt::join(row.names, ","));
  const std::string value = row.label.empty() || row.positional ? "" : " " + row.label;
  const std::string fallback = row.default_value.empty() ? "" : " [" + row.default_value + "]";
  return entry(name + value, row.description + fallback);
}

std::string usage(const OptionTable& table, const std::string& name) {
  std::string line = "Usage: " + name + " [OPTIONS]";
  for (const OptionRow& row : table.rows) {
    if (!row.positional) continue;
    const std::string word = row.names.front() + (row.many ? "..." : "");
    line += row.required ? " " + word : " [" + word + "]";
  }
  return line + (table.subcommands.empty() ? "" : " SUBCOMMAND") + "\n";
}

// Returns the headings in the order of their first options.
std::vector<std::string> headings(const OptionTable& table) {
  std::vector<std::string> groups;
  for (const OptionRow& row : table.rows) {
    const bool known = std::find(groups.begin(), groups.end(), row.group) != groups.end();
    if (!row.positional && !known) groups.push_back(row.group);
  }
  return groups;
}

std::string usual_options(const OptionTable& table, std::span<const std::string> usual) {
  std::string text = "\nUsual options:\n";
  for (const std::string& name : usual) {
    for (const OptionRow& row : table.rows)
      if (row.names.back() == name) text += entry(row);
  }
  return text + "\nAll options: " + table.program + " --help all\n";
}

}  // namespace

std::string help_text(const OptionTable& table, const std::string& usage_name,
                      std::span<const std::string> usual) {
  std::string text = wrapped(table.description, 0) + "\n" + usage(table, usage_name);
  const auto has_positional = [&](const OptionRow& row) { return row.positional; };
  if (std::any_of(table.rows.begin(), table.rows.end(), has_positional)) text += "\n";
  for (const OptionRow& row : table.rows) {
    if (row.positional) text += entry(row);
  }
  if (!usual.empty()) return text + usual_options(table, usual);
  for (const std::string& heading : headings(table)) {
    text += "\n" + heading + ":\n";
    for (const OptionRow& row : table.rows) {
      if (!row.positional && row.group == heading) text += entry(row);
    }
  }
  if (table.subcommands.empty()) return text;
  text += "\nSubcommands, each with its own --help:\n";
  for (const OptionTable& subcommand : table.subcommands) {
    text += entry(subcommand.program, subcommand.description);
  }
  return text;
}

}  // namespace pprt
