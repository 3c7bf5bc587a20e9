#include "app/command_line.h"

#include <algorithm>
#include <iostream>

#include "app/launch.h"
#include "app/version.h"
#include "base/diagnostics.h"

namespace pprt {

void add_common_flags(CLI::App& app) {
  app.set_help_flag("-h,--help", "Print this help and exit");
  app.set_version_flag("--version", app.get_name() + " " + kVersion, "Print the version and exit");
}

bool parse_command_line(CLI::App& app, int argc, const char* const* argv) {
  return parse_command_line(app, std::vector<std::string>(argv + 1, argv + argc));
}

bool parse_command_line(CLI::App& app, std::vector<std::string> words) {
  std::reverse(words.begin(), words.end());  // the order that CLI11 wants
  try {
    app.parse(words);
    return true;
  } catch (const CLI::Success& request) {
    if (launcher_rank() == 0) app.exit(request, std::cout, std::cout);
    return false;
  } catch (const CLI::ParseError& e) {
    throw UsageError(e.what());
  }
}

}  // namespace pprt
