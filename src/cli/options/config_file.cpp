#include "cli/options/config_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <istream>
#include <memory>
#include <string_view>

#include "base/diagnostics.h"
#include "cli/options/config_text.h"

namespace pprt {
namespace {

constexpr const char* kOption = "--config";

std::string read_within_limit(std::istream& input) {
  std::string text(ConfigFile::kMostBytes + 1, '\0');
  input.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(input.gcount()));
  if (text.size() > ConfigFile::kMostBytes) {
    throw UsageError(fmt::format("{}: the file is larger than {} bytes, the most for options", kOption,
                                 ConfigFile::kMostBytes));
  }
  return text;
}

std::string_view first_lines(std::string_view text, std::size_t count) {
  std::size_t end = 0;
  for (; count > 0 && end < text.size(); --count) end = std::min(text.find('\n', end), text.size() - 1) + 1;
  return text.substr(0, end);
}

}  // namespace

std::vector<CLI::ConfigItem> ConfigFile::from_config(std::istream& input) const {
  if (!text_) text_ = read_within_limit(input);
  return config_items(lines_ ? first_lines(*text_, *lines_) : *text_);
}

std::string ConfigFile::to_config(const CLI::App* app, bool, bool, std::string) const {
  return config_text(*app);
}

std::optional<std::size_t> ConfigFile::line_of(const std::string& problem,
                                               const std::function<std::optional<std::string>()>& parse) {
  if (!text_) return std::nullopt;
  const auto arises_within = [&](std::size_t lines) {
    lines_ = lines;
    return parse() == problem;
  };
  // Within `without` lines it does not arise, within `with` it does.
  std::size_t without = 0,
              with = static_cast<std::size_t>(std::count(text_->begin(), text_->end(), '\n')) + 1;
  const bool by_a_line = !arises_within(0);
  while (by_a_line && with - without > 1) {
    const std::size_t middle = without + (with - without) / 2;
    (arises_within(middle) ? with : without) = middle;
  }
  lines_.reset();
  parse();  // leaves everything as the problem did
  return by_a_line ? std::optional(with) : std::nullopt;
}

CLI::Option& add_config_file(CLI::App& app) {
  const auto reader = std::make_shared<ConfigFile>();
  app.config_formatter(reader);
  app.allow_config_extras(CLI::config_extras_mode::error);
  return *app.set_config(kOption, "", "Read options from a file")->type_name("FILE");
}

std::string place_in_config(const CLI::App& app, const std::string& problem,
                            const std::function<std::optional<std::string>()>& parse) {
  const auto reader = std::dynamic_pointer_cast<ConfigFile>(app.get_config_formatter());
  if (!reader) return {};
  const std::optional<std::size_t> line = reader->line_of(problem, parse);
  return line ? fmt::format("{}:{}: ", app.get_option(kOption)->as<std::string>(), *line) : "";
}

}  // namespace pprt
