#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/options/command_line.h"
#include "cli/options/number_checks.h"
#include "cli/options/option_words.h"
#include "cli/options/typed_options.h"
#include "cli/process/exit.h"
#include "cli/scenes/scene_source.h"
#include "study/accuracy/accuracy_study.h"
#include "study/accuracy/methods.h"
#include "study/balance/balance_study.h"
#include "study/counts.h"
#include "study/paper/paper_study.h"
#include "study/rate/rate_study.h"

namespace {

// Adds an option. `label` stands for its value in the help.
template <typename T>
CLI::Option* add(CLI::App& app, const char* names, const char* label, T& value, const char* help) {
  return app.add_option(names, value, help)->type_name(label);
}

CLI::Option* add_output(CLI::App& command, std::string& directory) {
  return add(command, "-o,--output", "DIR", directory, "Directory for tables, plots and index.html");
}

CLI::Option* add_ranks(CLI::App& command, int& ranks) {
  return add(command, "--ranks", "N", ranks, "Number of ranks")
      ->check(CLI::Range(1, 512))
      ->capture_default_str();
}

template <typename Seed>
void add_seed(CLI::App& command, Seed& seed, const char* help) {
  add(command, "--seed", "N", seed, help)->capture_default_str();
}

// `cells`: of converged_reference().
void add_reference(CLI::App& command, int& cells, const char* help) {
  add(command, "--reference", "N", cells, help)->check(CLI::Range(2, 64));
}

void add_size(CLI::App& command, int& size, int most, const char* help) {
  add(command, "--size", "N", size, help)->check(CLI::Range(16, most));
}

CLI::App& add_counts(CLI::App& app, pprt::CountsOptions& options) {
  CLI::App& command = *app.add_subcommand("counts", "Compares rays by kind with Haines' published table");
  pprt::take_path_or(
      *add(command, "SCENE", "", options.scenes,
           "FILE.nff, - (NFF on standard input) or spd:NAME[:SIZE] (default: the seven published)"),
      pprt::generated_scenes());
  add(command, "--tolerance", "PERCENT", options.tolerance_percent, "Greatest allowed difference, in percent")
      ->check(pprt::number_from(0))
      ->capture_default_str();
  add(command, "--corners", "N", options.corners, "Number of eye rays in each direction")
      ->check(CLI::Range(2, 16385))
      ->capture_default_str();
  command.add_flag("--two-sided", options.two_sided, "Show opaque surfaces from both sides in every scene");
  command.add_flag("--json", options.json, "Print a JSON object a line for each scene");
  return command;
}

CLI::App& add_paper(CLI::App& app, pprt::PaperOptions& options) {
  CLI::App& command = *app.add_subcommand("paper", "Repeats the paper's experiments, figures 5 to 9");
  add_output(command, options.directory)->required();
  command.add_flag("--quick", options.quick, "A trial: small pictures of a small tree on few ranks");
  add(command, "--ranks", "N,...", options.ranks,
      "Numbers of ranks for figures 5 to 7 (default: 32,62; quick: 4,6)")
      ->delimiter(',')
      ->check(CLI::Range(1, 512));
  add(command, "--most-ranks", "N", options.most_ranks,
      "Ranks of the largest picture, where their number varies; 1024 take 14 GB")
      ->capture_default_str()
      ->check(CLI::Range(64, 1024));
  add(command, "--frames", "N", options.frames,
      "Render the first N frames of each sequence (default: 40; quick: 6)")
      ->check(CLI::Range(5, 40));
  pprt::add_choice(command, "--weights", options.weights, "Rule that chooses the next triangle to refine");
  pprt::add_choice(command, "--machine", options.machine, "Simulated processors and network");
  add(command, "--latency", "US", options.latency_us,
      "Network latency, microseconds (default: the machine's)")
      ->check(pprt::number_from(0));
  add(command, "--bandwidth", "MB/S", options.bandwidth_mb_s,
      "Bandwidth of a rank's link, MB/s (default: the machine's)")
      ->check(pprt::number_above_zero());
  add_seed(command, options.seed, "Seed of the seed samples' positions");
  return command;
}

// What is compared, and beside what.
void add_methods(CLI::App& command, pprt::AccuracyOptions& options) {
  constexpr const char* kGroup = "Methods";
  CLI::Option& methods = *add(command, "--methods", "LIST", options.methods,
                              "Compare only these, with commas; uniform and control always (default: all)");
  pprt::take_some_of(methods, pprt::method_words());
  methods.group(kGroup);
  command
      .add_flag("--only-curves", options.only_curves,
                "Leave out other renderers, effects, figure 1, frame rates and deadlines")
      ->group(kGroup);
  add(command, "--busy", "N", options.busy_threads,
      "Let N threads render the scene beside each measured picture")
      ->check(CLI::Range(0, 256))
      ->capture_default_str()
      ->group(kGroup);
}

void add_sequences(CLI::App& command, pprt::AccuracyOptions& options) {
  constexpr const char* kGroup = "Sequences at fixed rates";
  add_ranks(command, options.ranks)->group(kGroup);
  pprt::add_choice(command, "--sampler", options.sampler, "What chooses a frame's samples").group(kGroup);
  add(command, "--want-rmse", "E", options.want_rmse,
      "Print the frame rate that gives this error; without -o measure nothing else")
      ->check(pprt::number_above_zero())
      ->group(kGroup);
  add(command, "--want-fps", "F", options.want_fps,
      "Print the errors at this frame rate: of frames, of what a viewer sees, in real time")
      ->check(pprt::number_above_zero())
      ->group(kGroup);
}

CLI::App& add_accuracy(CLI::App& app, pprt::AccuracyOptions& options) {
  CLI::App& command = *app.add_subcommand("accuracy", "Measures what a better picture costs in time");
  pprt::take_path_or(*add(command, "SCENE", "", options.inputs,
                          "FILE.nff or spd:NAME[:SIZE] (default: tree, gears, balls and tetra), and "
                          "FILE.anim for the sequence at fixed rates"),
                     pprt::generated_scenes());
  add_output(command, options.directory);
  command.add_flag("--quick", options.quick, "A trial: small pictures");
  add_size(command, options.size, 4096, "Pictures of N x N pixels (default: 512; quick: 96)");
  add(command, "--repeats", "N", options.repeats, "Make each measurement N times (default: 3; quick: 1)")
      ->check(CLI::Range(1, 100));
  add_reference(command, options.reference_cells,
                "Converged frames have 2 N x N samples a pixel (default: 8; quick: 4)");
  add(command, "--cache", "DIR", options.cache,
      "Directory that keeps converged frames (default: pprt in the user's cache directory)");
  command.add_flag("--no-cache", options.no_cache, "Neither keep converged frames nor use kept ones");
  add_seed(command, options.seed, "Seed of the seed samples' positions in the first repeat");
  add_methods(command, options);
  add_sequences(command, options);
  return command;
}

CLI::App& add_balance(CLI::App& app, pprt::BalanceOptions& options) {
  CLI::App& command = *app.add_subcommand("balance", "Shows how recorded runs were balanced");
  add(command, "FILE", "", options.files, "Balancing traces, as pprt-render --balance-trace writes them")
      ->required();
  add_output(command, options.directory);
  add(command, "--frames", "N,...", options.frames,
      "Draw the regions of these frames (default: the first, the middle and the last)")
      ->delimiter(',')
      ->check(CLI::Range(1, 1'000'000'000));
  command.add_flag("--json", options.json, "Print a JSON object a line for each row");
  return command;
}

CLI::App& add_rate(CLI::App& app, pprt::RateOptions& options) {
  CLI::App& command = *app.add_subcommand("rate", "Finds the frame rate that shows a movement best");
  pprt::take_path_or(*add(command, "FILM", "", options.inputs,
                          "FILE.anim, with a scene where it names none, or a scene that moves by itself")
                          ->required(),
                     pprt::generated_scenes());
  add_output(command, options.directory);
  command.add_flag("--quick", options.quick, "A trial: small pictures of a short time");
  add_size(command, options.size, 1024, "Pictures of N x N pixels (default: 192; quick: 64)");
  add_ranks(command, options.ranks);
  add(command, "--seconds", "S", options.seconds,
      "Length of the film that is judged (default: 1; quick: 0.25)")
      ->check(pprt::number_between(0.05, 60));
  add_reference(command, options.reference_cells,
                "True pictures have 2 N x N samples a pixel (default: 3; quick: 2)");
  return command;
}

}  // namespace

int main(int argc, char** argv) {
  return pprt::run_guarded("pprt-study", [&]() -> int {
    CLI::App app("Measures this renderer against published results.", "pprt-study");
    app.require_subcommand(1);
    pprt::CountsOptions counts;
    pprt::PaperOptions paper;
    pprt::AccuracyOptions accuracy;
    pprt::BalanceOptions balance;
    pprt::RateOptions rate;
    add_counts(app, counts);
    const CLI::App& paper_command = add_paper(app, paper);
    const CLI::App& accuracy_command = add_accuracy(app, accuracy);
    const CLI::App& balance_command = add_balance(app, balance);
    const CLI::App& rate_command = add_rate(app, rate);
    pprt::add_common_flags(app);
    if (!pprt::parse_command_line(app, argc, argv)) return pprt::kExitDone;
    const std::string command_line = fmt::format("{}", fmt::join(argv, argv + argc, " "));
    if (paper_command.parsed()) {
      pprt::study_paper(paper, command_line);
    } else if (accuracy_command.parsed()) {
      pprt::study_accuracy(accuracy, command_line);
    } else if (balance_command.parsed()) {
      pprt::study_balance(balance, command_line);
    } else if (rate_command.parsed()) {
      pprt::study_rate(rate, command_line);
    } else {
      return pprt::study_counts(counts) ? pprt::kExitDone : pprt::kExitFailure;
    }
    return pprt::kExitDone;
  });
}
