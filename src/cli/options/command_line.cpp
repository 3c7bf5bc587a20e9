#include "cli/options/command_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "base/diagnostics.h"
#include "base/nearest_word.h"
#include "cli/options/completion.h"
#include "cli/options/config_file.h"
#include "cli/options/help.h"
#include "cli/options/option_table.h"
#include "cli/options/typed_options.h"
#include "cli/options/version.h"
#include "cli/process/exit.h"
#include "cli/process/launched.h"
#include "parser/text/text_input.h"

namespace pprt {
namespace {

void use_help(CLI::App& app, std::vector<std::string> usual = {}) {
  const auto text = [usual = std::move(usual)](const CLI::App* of, const std::string& name,
                                               CLI::AppFormatMode) {
    // CLI11 passes a pointer to const, but its getters are not const; the table only reads.
    return help_text(option_table(*const_cast<CLI::App*>(of)), name.empty() ? of->get_name() : name, usual);
  };
  app.formatter_fn(text);
}

// Removes the word of "--help all". Returns whether there was one.
bool take_help_all(std::vector<std::string>& words) {
  for (auto word = words.begin(); word != words.end(); ++word) {
    if (*word == "--help=all") {
      *word = "--help";
      return true;
    }
    const bool is_help = *word == "--help" || *word == "-h";
    if (is_help && word + 1 != words.end() && *(word + 1) == "all") {
      words.erase(word + 1);
      return true;
    }
  }
  return false;
}

// Adds --completion. Like --version it prints and ends the parsing, whatever else the command line lacks.
void add_completion(CLI::App& app) {
  const auto print = [&app](const std::string& shell) {
    std::string script = completion_script(option_table(app), find_word<Shell>(shell).value());
    script.pop_back();  // the line's end, which is printed behind it
    throw CLI::CallForVersion(script, 0);
  };
  auto* option = app.add_option_function<std::string>("--completion", print,
                                                      "Print a completion script for this shell and exit");
  take_one_of(*option, option_words<Shell>());
  option->configurable(false);
}

// Returns the subcommand that was given, or the program.
CLI::App& innermost(CLI::App& app) {
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  return parsed.empty() ? app : innermost(*parsed.back());
}

// Returns the names that a word which nothing takes may have meant: options, or subcommands.
std::vector<std::string> candidates(CLI::App& app, bool option) {
  std::vector<std::string> names;
  if (!option) {
    for (const CLI::App* subcommand : app.get_subcommands({})) names.push_back(subcommand->get_name());
    return names;
  }
  for (const OptionRow& row : option_table(app).rows) {
    if (row.positional) continue;
    std::copy_if(row.names.begin(), row.names.end(), std::back_inserter(names),
                 [](const std::string& name) { return name.starts_with("--"); });
  }
  return names;
}

// Explains the first word that nothing takes; nullopt when there is none and something else is wrong.
std::optional<std::string> unexpected_word(CLI::App& app) {
  const std::vector<std::string> left = app.remaining(true);
  if (left.empty()) return std::nullopt;
  const std::string word = left.front().substr(0, left.front().find('='));
  const bool option = word.starts_with('-');
  const std::vector<std::string> names = candidates(innermost(app), option);
  const std::string hint = did_you_mean(word, std::vector<std::string_view>(names.begin(), names.end()));
  if (option) return fmt::format("there is no option {}{}", word, hint);
  if (!names.empty()) return fmt::format("there is no subcommand '{}'{}", word, hint);
  return fmt::format("'{}' is one argument too many", word);
}

// Explains a name in an option file that is no option's.
std::string unknown_in_config(CLI::App& app, const CLI::ConfigError& error) {
  constexpr std::string_view kExtra = "INI was not able to parse ";
  std::string what = error.what();
  if (!what.starts_with(kExtra)) return what;
  const std::string name = what.substr(kExtra.size());
  const std::vector<std::string> names = candidates(app, true);
  return fmt::format("there is no option {}{}", pprt::quoted(name),
                     did_you_mean("--" + name, std::vector<std::string_view>(names.begin(), names.end())));
}

// Parses the words, in CLI11's order. Returns what is wrong; nothing if they make sense. CLI::Success passes.
std::optional<std::string> parse_problem(CLI::App& app, std::vector<std::string> words) {
  try {
    app.parse(words);
    return std::nullopt;
  } catch (const CLI::Success&) {
    throw;
  } catch (const CLI::ExtrasError& e) {
    return unexpected_word(app).value_or(e.what());
  } catch (const CLI::RequiredError& e) {
    return unexpected_word(app).value_or(e.what());  // which may be why something is missing
  } catch (const CLI::ConfigError& e) {
    return unknown_in_config(app, e);
  } catch (const CLI::ParseError& e) {
    return e.what();
  } catch (const UsageError& e) {
    return e.what();
  }
}

}  // namespace

void add_common_flags(CLI::App& app, std::vector<std::string> usual) {
  app.set_help_flag("-h,--help", usual.empty() ? "Print this help and exit"
                                               : "Print this help and exit; --help all: with all options");
  app.set_version_flag("--version", app.get_name() + " " + kVersion, "Print the version and exit");
  add_completion(app);
  use_help(app, std::move(usual));
  for (CLI::App* subcommand : app.get_subcommands({})) use_help(*subcommand);
}

bool parse_command_line(CLI::App& app, int argc, const char* const* argv) {
  return parse_command_line(app, std::vector<std::string>(argv + 1, argv + argc));
}

bool parse_command_line(CLI::App& app, std::vector<std::string> words) {
  if (take_help_all(words)) use_help(app);
  std::reverse(words.begin(), words.end());  // the order that CLI11 wants
  try {
    const std::optional<std::string> problem = parse_problem(app, words);
    if (!problem) return true;
    const auto parse_again = [&]() -> std::optional<std::string> {
      try {
        return parse_problem(app, words);
      } catch (const CLI::Success&) {
        return std::nullopt;
      }
    };
    throw UsageError(place_in_config(app, *problem, parse_again) + *problem);
  } catch (const CLI::Success& request) {
    std::ostringstream text;
    app.exit(request, text, text);
    if (launcher_rank() == 0) print_output(text.str());
    return false;
  }
}

}  // namespace pprt
