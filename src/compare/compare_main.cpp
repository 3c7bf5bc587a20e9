#include "compare/compare.h"

#include <iostream>

#include "cli/options/command_line.h"
#include "cli/options/number_checks.h"
#include "cli/options/typed_options.h"
#include "cli/process/exit.h"

namespace {

// Adds the limit of a figure.
void add_limit(CLI::App& app, const char* name, std::optional<double>& limit, const char* what) {
  app.add_option(name, limit, what)
      ->type_name("X")
      ->check(pprt::any_number())
      ->group("Limits; exit code 1 if one is exceeded");
}

void add_options(CLI::App& app, pprt::CompareOptions& options) {
  app.add_option("A", options.image, "Picture, EXR or PNG, or a sequence such as out/%04d.png")
      ->required()
      ->type_name("FILE");
  app.add_option("B", options.reference, "Reference picture or sequence")->required()->type_name("FILE");
  pprt::add_parsed(app, "--frames", pprt::parse_frame_range, options.frames,
                   "Compare only frames A to B of the sequences")
      .type_name("A-B");
  app.add_flag("--clamp", options.clamp, "Clamp values to 0..1 first, as a display does");
  app.add_option("--threshold", options.threshold, "Error above which a pixel counts for the share")
      ->check(pprt::number_from(0))
      ->capture_default_str()
      ->type_name("T");
  app.add_option("--pixels-per-degree", options.pixels_per_degree,
                 "Pixels in a degree of the view of FLIP's viewer")
      ->check(pprt::number_between(1, 1000))
      ->capture_default_str()
      ->type_name("P");
  app.add_option("--diff", options.difference_picture, "Write a picture of the differences, the largest as 1")
      ->type_name("OUT");
  add_limit(app, "--max-rmse", options.max_rmse, "Largest root mean square error allowed");
  add_limit(app, "--min-psnr", options.min_psnr, "Smallest peak signal to noise ratio allowed, dB");
  add_limit(app, "--max-relative-mse", options.max_relative_mse,
            "Largest relative mean square error allowed");
  add_limit(app, "--min-ssim", options.min_ssim, "Smallest structural similarity allowed");
  add_limit(app, "--max-flip", options.max_flip, "Largest mean FLIP allowed");
  add_limit(app, "--max-error", options.max_error, "Largest error of any pixel allowed");
  add_limit(app, "--max-p999", options.max_p999, "Largest 99.9th percentile of error allowed");
  add_limit(app, "--max-share", options.max_share,
            "Largest share of pixels over the threshold allowed, 0 to 1");
  add_limit(app, "--max-flicker", options.max_flicker, "Largest flicker of a sequence allowed");
  app.add_flag("--json", options.json,
               "Print one JSON object; for a sequence one a line for each frame, and a last one for all");
}

}  // namespace

int main(int argc, char** argv) {
  bool within = true;
  const int code = pprt::run_guarded("pprt-compare", [&]() -> int {
    CLI::App app("Measures the difference of two pictures or sequences.", "pprt-compare");
    pprt::CompareOptions options;
    add_options(app, options);
    pprt::add_common_flags(app);
    if (pprt::parse_command_line(app, argc, argv)) within = pprt::compare(options, std::cout, std::cerr);
    return pprt::kExitDone;
  });
  // Exit code 1 means an exceeded limit alone, so that a check cannot take a missing file for a difference.
  if (code != pprt::kExitDone) return pprt::kExitUsage;
  return within ? pprt::kExitDone : pprt::kExitFailure;
}
