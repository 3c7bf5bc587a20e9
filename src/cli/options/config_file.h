// Option files (--config): read within a limit, and with the line of each problem. Private to the programs:
// shows CLI11.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace pprt {

// Reads such a file for CLI11. CLI11 does not keep the line of an option, so a problem's line is found
// by reading fewer and fewer lines.
class ConfigFile : public CLI::Config {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{1} << 20;

  // Throws UsageError for more than kMostBytes. Reads the stream once, later calls its text.
  std::vector<CLI::ConfigItem> from_config(std::istream& input) const override;

  std::string to_config(const CLI::App* app, bool, bool, std::string) const override;

  // Returns the first line, from 1, without which `problem` does not arise. `parse` parses everything and
  // returns the problem that it meets. Returns nothing when no line makes a difference.
  std::optional<std::size_t> line_of(const std::string& problem,
                                     const std::function<std::optional<std::string>()>& parse);

 private:
  mutable std::optional<std::string> text_;
  std::optional<std::size_t> lines_;  // only so many are read; absent: all
};

// Adds --config, whose file may hold all other options of `app`.
CLI::Option& add_config_file(CLI::App& app);

// Returns "FILE:LINE: " when a line of the option file causes the problem, else nothing. `parse` is as above.
std::string place_in_config(const CLI::App& app, const std::string& problem,
                            const std::function<std::optional<std::string>()>& parse);

}  // namespace pprt
