#include "app/compare.h"

#include <iostream>

#include "app/command_line.h"
#include "app/exit.h"

namespace {

void add_options(CLI::App& app, pprt::CompareOptions& options) {
  app.add_option("A", options.image, "The picture, EXR or PNG")->required()->type_name("");
  app.add_option("B", options.reference, "The reference to compare it with")->required()->type_name("");
  app.add_option("--threshold", options.threshold, "Error above which a pixel counts for the share")
      ->capture_default_str()
      ->type_name("T");
  app.add_option("--diff", options.difference_picture, "Write the differences, the largest as 1")
      ->type_name("OUT");
  app.add_option("--max-rmse", options.max_rmse, "Largest root mean square error allowed")->type_name("X");
  app.add_option("--min-psnr", options.min_psnr, "Smallest peak signal to noise ratio allowed, dB")
      ->type_name("X");
  app.add_option("--min-ssim", options.min_ssim, "Smallest structural similarity allowed")->type_name("X");
  app.add_option("--max-error", options.max_error, "Largest error of any pixel allowed")->type_name("X");
  app.add_option("--max-share", options.max_share,
                 "Largest share of pixels over the threshold allowed, 0 to 1")
      ->type_name("X");
  app.add_flag("--json", options.json, "Print one JSON object");
}

}  // namespace

int main(int argc, char** argv) {
  bool within = true;
  const int code = pprt::run_guarded("pprt-compare", [&]() -> int {
    CLI::App app("Tells how far one picture is from another.", "pprt-compare");
    pprt::CompareOptions options;
    add_options(app, options);
    pprt::add_common_flags(app);
    if (pprt::parse_command_line(app, argc, argv)) within = pprt::compare(options, std::cout, std::cerr);
    return pprt::kExitDone;
  });
  // Exit code 1 is kept for a verdict, so that a check cannot take a missing file for a difference.
  if (code != pprt::kExitDone) return pprt::kExitUsage;
  return within ? pprt::kExitDone : pprt::kExitFailure;
}
