#include <algorithm>

#include "cli/command_line.h"
#include "cli/exit.h"
#include "render/render.h"

int main(int argc, char** argv) {
  return pprt::run_guarded("pprt-render", [&]() -> int {
    CLI::App app(
        "Renders a scene, or an animation at a fixed frame rate, by parallel progressive ray tracing.",
        "pprt-render");
    pprt::RenderOptions options;
    pprt::add_render_options(app, options);
    pprt::add_common_flags(app);
    std::vector<std::string> words = pprt::with_long_np(argc, argv);
    if (!pprt::parse_command_line(app, words)) return pprt::kExitDone;
    return pprt::render(options, pprt::options_in_force(app), argc, argv);
  });
}
