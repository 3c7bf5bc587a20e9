#include "app/command_line.h"
#include "app/exit.h"
#include "app/study_counts.h"

int main(int argc, char** argv) {
  return pprt::run_guarded("pprt-study", [&]() -> int {
    CLI::App app("Measures this renderer against published results.", "pprt-study");
    app.require_subcommand(1);
    pprt::CountsOptions counts;
    CLI::App* command = app.add_subcommand("counts", "Rays by kind against Haines' published table");
    command
        ->add_option("SCENE", counts.scenes,
                     "FILE.nff, - (standard input) or spd:NAME[:SIZE]; default: the "
                     "seven published")
        ->type_name("");
    command
        ->add_option("--tolerance", counts.tolerance_percent, "Greatest difference that passes, in percent")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str()
        ->type_name("PERCENT");
    command->add_option("--corners", counts.corners, "Eye rays in each direction")
        ->check(CLI::Range(2, 16385))
        ->capture_default_str()
        ->type_name("N");
    command->add_flag("--two-sided", counts.two_sided, "Opaque surfaces have two sides in every scene");
    command->add_flag("--json", counts.json, "Print a JSON object for each scene, one a line");
    pprt::add_common_flags(app);
    if (!pprt::parse_command_line(app, argc, argv)) return pprt::kExitDone;
    return pprt::study_counts(counts) ? pprt::kExitDone : pprt::kExitFailure;
  });
}
