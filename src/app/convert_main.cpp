#include "app/command_line.h"
#include "app/convert.h"
#include "app/exit.h"

int main(int argc, char** argv) {
  return pprt::run_guarded("pprt-convert", [&]() -> int {
    CLI::App app("Converts a scene from one format into another.", "pprt-convert");
    pprt::ConvertOptions options;
    app.add_option("IN", options.input, "FILE.nff, - (NFF on standard input) or spd:NAME[:SIZE]")
        ->required()
        ->option_text(" ");
    app.add_option("OUT", options.output, "FILE.nff, FILE.pov or - (NFF on standard output)")
        ->required()
        ->option_text(" ");
    app.add_flag("--strict", options.strict, "Reject what the NFF specification does not allow");
    pprt::add_common_flags(app);
    if (pprt::parse_command_line(app, argc, argv)) pprt::convert(options);
    return pprt::kExitDone;
  });
}
