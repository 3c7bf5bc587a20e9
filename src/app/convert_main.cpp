#include <limits>
#include <map>

#include "app/command_line.h"
#include "app/convert.h"
#include "app/exit.h"
#include "convert/tessellate.h"

namespace {

void add_options(CLI::App& app, pprt::ConvertOptions& options) {
  app.add_option("IN", options.input,
                 "FILE.nff, - (NFF on standard input), spd:NAME[:SIZE], or a mesh (.obj .ply .stl .gltf ...)")
      ->required()
      ->option_text(" ");
  app.add_option("OUT", options.output,
                 "FILE.nff, - (NFF on standard output), FILE.pov, or a mesh (.obj .ply .stl .glb .gltf .dae)")
      ->required()
      ->option_text(" ");
  auto* divisions = app.add_option("--tessellate", options.tessellate,
                                   "Cut spheres into 12 N x N triangles, cones into 8 N (meshes: 6)");
  divisions->option_text("N")->check(CLI::Range(1, pprt::kMaxDivisions));
  app.add_option("--chord-error", options.chord_error,
                 "Cut spheres and cones no farther than E inside their surface, each as finely as it needs")
      ->option_text("E")
      ->check(CLI::Range(std::numeric_limits<double>::min(), std::numeric_limits<double>::max(), "POSITIVE"))
      ->excludes(divisions);
  const std::map<std::string, pprt::UpAxis> axes = {{"y", pprt::UpAxis::kY}, {"z", pprt::UpAxis::kZ}};
  app.add_option("--up", options.up, "The axis that is up for a camera that has to be added (y)")
      ->option_text("y|z")
      ->transform(CLI::CheckedTransformer(axes));
  app.add_flag("--strict", options.strict, "Reject what the NFF specification does not allow");
}

}  // namespace

int main(int argc, char** argv) {
  return pprt::run_guarded("pprt-convert", [&]() -> int {
    CLI::App app("Converts a scene from one format into another.", "pprt-convert");
    pprt::ConvertOptions options;
    add_options(app, options);
    pprt::add_common_flags(app);
    if (pprt::parse_command_line(app, argc, argv)) pprt::convert(options);
    return pprt::kExitDone;
  });
}
