#include "cli/options/config_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace pprt {
namespace {

// The characters of escapes in double quotes, and what they stand for.
constexpr std::string_view kEscapes = "\"\\nrt", kEscaped = "\"\\\n\r\t";

class ConfigScanner {
 public:
  explicit ConfigScanner(std::string_view text) : text_(text) {}

  std::vector<CLI::ConfigItem> read() {
    for (skip(" \t\r\n"); !at_end(); skip(" \t\r\n")) {
      if (peek() == ';' || peek() == '#') {
        skip_line();
      } else if (peek() == '[') {
        section();
      } else {
        item();
      }
    }
    return std::move(items_);
  }

 private:
  bool at_end() const { return at_ == text_.size(); }
  char peek() const { return text_[at_]; }
  bool next_is_any_of(std::string_view set) const { return !at_end() && set.find(peek()) != set.npos; }
  void skip(std::string_view set) { at_ = std::min(text_.find_first_not_of(set, at_), text_.size()); }
  void skip_line() { at_ = std::min(text_.find('\n', at_), text_.size()); }

  // Returns the text before the first of these characters.
  std::string_view take_until(std::string_view set) {
    const std::size_t begin = at_;
    at_ = std::min(text_.find_first_of(set, at_), text_.size());
    return text_.substr(begin, at_ - begin);
  }

  // No program has sections; one is reported with the item in it.
  void section() {
    ++at_;
    const std::string_view name = take_until("]\n");
    section_ = name == "default" ? std::string() : std::string(name);
    skip_line();
  }

  void item() {
    CLI::ConfigItem item;
    if (!section_.empty()) item.parents = {section_};
    item.name = take_until("=;\n");
    item.name.erase(item.name.find_last_not_of(" \t\r") + 1);
    item.inputs = {"true"};
    if (next_is_any_of("=")) {
      ++at_;
      item.inputs = values();
    }
    const bool goes_on = !items_.empty() && items_.back().fullname() == item.fullname();
    if (!goes_on) return items_.push_back(std::move(item));
    std::move(item.inputs.begin(), item.inputs.end(), std::back_inserter(items_.back().inputs));
  }

  // Reads to the end of the line; a list in brackets may have several lines.
  std::vector<std::string> values() {
    std::vector<std::string> found;
    skip(" \t");
    const bool list = next_is_any_of("[");
    if (list) ++at_;
    for (;;) {
      skip(list ? " \t\r\n," : " \t\r,");
      if (at_end() || next_is_any_of(list ? "]" : "\n")) break;
      if (peek() == ';') {
        skip_line();
      } else {
        found.push_back(value(list));
      }
    }
    if (list) skip_line();
    return found.empty() ? std::vector<std::string>{""} : found;
  }

  std::string value(bool list) {
    if (next_is_any_of("\"'")) return quoted();
    return std::string(take_until(list ? " \t\r\n,;]" : " \t\r\n,;"));
  }

  std::string quoted() {
    const char mark = text_[at_++];
    std::string value;
    while (!at_end() && peek() != '\n') {
      const char c = text_[at_++];
      if (c == mark) return value;
      value += c == '\\' && mark == '"' ? escaped() : c;
    }
    throw CLI::ConfigError("the quotation mark is not closed");
  }

  // A backslash before any other character stands for itself.
  char escaped() {
    const std::size_t which = at_end() ? kEscapes.npos : kEscapes.find(peek());
    if (which == kEscapes.npos) return '\\';
    ++at_;
    return kEscaped[which];
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::string section_;
  std::vector<CLI::ConfigItem> items_;
};

// Returns numbers and truth values as they are, anything else in quotation marks.
std::string written(const std::string& value) {
  double number = 0;
  const bool has_blank = value.find_first_of(" \t\n\v\f\r") != value.npos;  // which the cast skips
  if (value == "true" || (!has_blank && CLI::detail::lexical_cast(value, number))) return value;
  std::string quoted = "\"";
  for (const char c : value) {
    const std::size_t which = kEscaped.find(c);
    if (which == kEscaped.npos) {
      quoted += c;
    } else {
      quoted += {'\\', kEscapes[which]};
    }
  }
  return quoted + "\"";
}

// Returns the option's value; nullopt if it has none, or is a flag that is off.
std::optional<std::string> value_of(const CLI::Option& option) {
  std::vector<std::string> values = option.reduced_results();
  if (values.empty() && !option.get_default_str().empty()) values = {option.get_default_str()};
  if (values.empty() || values.front().empty()) return std::nullopt;
  const bool is_flag = option.get_items_expected_max() == 0;
  if (is_flag && values.front() == "false") return std::nullopt;
  for (std::string& value : values) value = written(value);
  if (values.size() == 1) return values.front();
  return fmt::format("[{}]", fmt::join(values, ", "));
}

}  // namespace

std::vector<CLI::ConfigItem> config_items(std::string_view text) {
  return ConfigScanner(text).read();
}

std::string config_text(const CLI::App& app) {
  std::string text = "; " + app.get_description() + "\n";
  for (const std::string& group : app.get_groups()) {
    std::string paragraphs;
    for (const CLI::Option* option : app.get_options({})) {
      if (option->get_group() != group || !option->get_configurable()) continue;
      const std::optional<std::string> value = value_of(*option);
      if (!value) continue;
      paragraphs +=
          fmt::format("\n; {}\n{}={}\n", option->get_description(), option->get_single_name(), *value);
    }
    const bool has_heading = group != "Options" && !paragraphs.empty();
    if (has_heading) text += fmt::format("\n; {} Options\n", group);
    text += paragraphs;
  }
  return text;
}

}  // namespace pprt
