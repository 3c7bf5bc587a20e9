#include "cli/command_line.h"
#include "cli/exit.h"
#include "cli/option_words.h"
#include "cli/scene_source.h"
#include "study/accuracy/accuracy_study.h"
#include "study/counts.h"
#include "study/paper/paper_study.h"

namespace {

CLI::App* add_counts(CLI::App& app, pprt::CountsOptions& options) {
  CLI::App* command = app.add_subcommand("counts", "Compares rays by kind with Haines' published table");
  auto* scenes = command->add_option(
      "SCENE", options.scenes,
      "FILE.nff, - (NFF on standard input) or spd:NAME[:SIZE] (default: the seven published)");
  scenes->type_name("");
  pprt::take_path_or(*scenes, pprt::generated_scenes());
  command->add_option("--tolerance", options.tolerance_percent, "Greatest allowed difference, in percent")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->type_name("PERCENT");
  command->add_option("--corners", options.corners, "Number of eye rays in each direction")
      ->check(CLI::Range(2, 16385))
      ->capture_default_str()
      ->type_name("N");
  command->add_flag("--two-sided", options.two_sided, "Show opaque surfaces from both sides in every scene");
  command->add_flag("--json", options.json, "Print a JSON object a line for each scene");
  return command;
}

CLI::App* add_paper(CLI::App& app, pprt::PaperOptions& options) {
  CLI::App* command = app.add_subcommand("paper", "Repeats the paper's experiments, figures 5 to 9");
  command->add_option("-o,--output", options.directory, "Directory for tables, plots and index.html")
      ->required()
      ->type_name("DIR");
  command->add_flag("--quick", options.quick, "A trial: small pictures of a small tree on few ranks");
  command
      ->add_option("--ranks", options.ranks,
                   "Numbers of ranks for figures 5 to 7 (default: 32,62; quick: 4,6)")
      ->delimiter(',')
      ->check(CLI::Range(1, 512))
      ->type_name("N,...");
  command
      ->add_option("--frames", options.frames,
                   "Render the first N frames of each sequence (default: 40; quick: 6)")
      ->check(CLI::Range(5, 40))
      ->type_name("N");
  auto* machine = command->add_option("--machine", options.machine, "Simulated processors and network");
  machine->capture_default_str();
  pprt::take_one_of(*machine, {"cluster", "sp2"});
  command
      ->add_option("--latency", options.latency_us, "Network latency, microseconds (default: the machine's)")
      ->check(CLI::NonNegativeNumber)
      ->type_name("US");
  command
      ->add_option("--bandwidth", options.bandwidth_mb_s,
                   "Bandwidth of a rank's link, MB/s (default: the machine's)")
      ->check(CLI::PositiveNumber)
      ->type_name("MB/S");
  command->add_option("--seed", options.seed, "Seed of the seed samples' positions")
      ->capture_default_str()
      ->type_name("N");
  return command;
}

CLI::App* add_accuracy(CLI::App& app, pprt::AccuracyOptions& options) {
  CLI::App* command = app.add_subcommand("accuracy", "Measures what a better picture costs in time");
  auto* scenes = command->add_option(
      "SCENE", options.inputs,
      "FILE.nff or spd:NAME[:SIZE] (default: tree, gears, balls and tetra), and FILE.anim for the sequence "
      "at fixed rates");
  scenes->type_name("");
  pprt::take_path_or(*scenes, pprt::generated_scenes());
  command->add_option("-o,--output", options.directory, "Directory for tables, plots and index.html")
      ->type_name("DIR");
  command->add_flag("--quick", options.quick, "A trial: small pictures");
  command->add_option("--size", options.size, "Pictures of N x N pixels (default: 512; quick: 96)")
      ->check(CLI::Range(16, 4096))
      ->type_name("N");
  command->add_option("--repeats", options.repeats, "Repeats of each measurement")
      ->check(CLI::Range(1, 100))
      ->capture_default_str()
      ->type_name("N");
  command
      ->add_option("--reference", options.reference_cells,
                   "Converged frames have 2 N x N samples a pixel (default: 8; quick: 4)")
      ->check(CLI::Range(2, 64))
      ->type_name("N");
  command
      ->add_option("--cache", options.cache,
                   "Directory that keeps converged frames (default: pprt in the user's cache directory)")
      ->type_name("DIR");
  command->add_flag("--no-cache", options.no_cache, "Neither keep converged frames nor use kept ones");
  command->add_option("--ranks", options.ranks, "Number of ranks for the sequences at fixed rates")
      ->check(CLI::Range(1, 512))
      ->capture_default_str()
      ->type_name("N");
  command
      ->add_option("--want-rmse", options.want_rmse,
                   "Print the frame rate that gives this error; without -o measure nothing else")
      ->check(CLI::PositiveNumber)
      ->type_name("E");
  command
      ->add_option("--want-fps", options.want_fps,
                   "Print the error at this frame rate, under the work clock and in real time")
      ->check(CLI::PositiveNumber)
      ->type_name("F");
  command->add_option("--seed", options.seed, "Seed of the seed samples' positions in the first repeat")
      ->capture_default_str()
      ->type_name("N");
  return command;
}

std::string words(int argc, char** argv) {
  std::string text;
  for (int i = 0; i < argc; ++i) text += (i == 0 ? "" : " ") + std::string(argv[i]);
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  return pprt::run_guarded("pprt-study", [&]() -> int {
    CLI::App app("Measures this renderer against published results.", "pprt-study");
    app.require_subcommand(1);
    pprt::CountsOptions counts;
    pprt::PaperOptions paper;
    pprt::AccuracyOptions accuracy;
    add_counts(app, counts);
    const CLI::App* paper_command = add_paper(app, paper);
    const CLI::App* accuracy_command = add_accuracy(app, accuracy);
    pprt::add_common_flags(app);
    if (!pprt::parse_command_line(app, argc, argv)) return pprt::kExitDone;
    if (paper_command->parsed()) {
      pprt::study_paper(paper, words(argc, argv));
    } else if (accuracy_command->parsed()) {
      pprt::study_accuracy(accuracy, words(argc, argv));
    } else {
      return pprt::study_counts(counts) ? pprt::kExitDone : pprt::kExitFailure;
    }
    return pprt::kExitDone;
  });
}
