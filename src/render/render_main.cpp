#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "cli/options/command_line.h"
#include "cli/options/config_text.h"
#include "cli/process/exit.h"
#include "cli/process/launch.h"
#include "cli/process/launched.h"
#include "cli/process/rank_guard.h"
#include "render/options/examples.h"
#include "render/render.h"

namespace {

// Returns false when nothing is left to do. A usage error is reported by --progress json too.
bool read_options(CLI::App& app, pprt::RenderOptions& options, const std::vector<std::string>& words) {
  try {
    if (!pprt::parse_command_line(app, pprt::with_long_np(words))) return false;
    if (app["--config"]->count() > 0) options.config = app["--config"]->results().front();
    pprt::put_in_order(options.source);
    pprt::check_usage(options);
  } catch (const pprt::UsageError& e) {
    pprt::ProgressReporter(options.progress).fail(e.what());
    throw;
  }
  if (!options.write_config) return true;
  if (pprt::launcher_rank() == 0) pprt::print_output(pprt::config_text(app));
  return false;
}

// Like --version it prints and ends the parsing, whatever else the command line lacks.
void add_examples(CLI::App& app) {
  app.add_flag_callback(
         "--examples", [] { throw CLI::CallForVersion(pprt::examples(), 0); },
         "Print commands to begin with and exit")
      ->configurable(false);
}

int say_first_steps() {
  if (pprt::launcher_rank() != 0) return pprt::kExitDone;
  pprt::print_message(pprt::first_steps());
  return pprt::kExitUsage;
}

}  // namespace

int main(int argc, char** argv) {
  return pprt::run_guarded("pprt-render", [&]() -> int {
    if (pprt::started_by_pprt()) pprt::guard_this_rank();
    CLI::App app(
        "Renders a scene, or an animation at a fixed frame rate, by parallel progressive ray tracing.",
        "pprt-render");
    pprt::RenderOptions options;
    pprt::add_render_options(app, options);
    add_examples(app);
    pprt::add_common_flags(app, pprt::usual_options());
    if (argc == 1) return say_first_steps();
    const std::vector<std::string> words = pprt::user_words(argc, argv);
    if (!read_options(app, options, words)) return pprt::kExitDone;
    return pprt::render(options, words);
  });
}
