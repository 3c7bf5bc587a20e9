#include <string>

#include "cli/options/command_line.h"
#include "cli/options/number_checks.h"
#include "cli/options/option_words.h"
#include "cli/options/typed_options.h"
#include "cli/process/exit.h"
#include "cli/scenes/scene_source.h"
#include "convert/convert.h"
#include "convert/surfaces/tessellate.h"

namespace {

void add_options(CLI::App& app, pprt::ConvertOptions& options) {
  auto* input = app.add_option(
      "IN", options.input,
      "FILE.nff, FILE.aff, - (NFF on standard input), spd:NAME[:SIZE], or a mesh (.obj .ply .stl .gltf ...)");
  input->required()->type_name("");
  pprt::take_path_or(*input, pprt::generated_scenes());
  app.add_option("OUT", options.output,
                 "FILE.nff, - (NFF on standard output), FILE.aff, FILE.pov, or a mesh (.obj .ply .stl .glb "
                 ".gltf .dae)")
      ->required()
      ->type_name("FILE");
  app.add_option("--at", options.at,
                 "Time at which a scene that moves is taken (default: its movement, or the start)")
      ->type_name("SECONDS")
      ->check(pprt::number_between(-1e9, 1e9));
  auto* divisions =
      app.add_option("--tessellate", options.tessellate,
                     "Divide spheres into 12 N x N triangles, cones into 8 N (default for meshes: 6)");
  divisions->type_name("N")->check(pprt::count_from(1, pprt::kMaxDivisions));
  app.add_option("--chord-error", options.chord_error,
                 "Divide spheres and cones so that triangles lie at most E inside the surface")
      ->type_name("E")
      ->check(pprt::number_above_zero())
      ->excludes(divisions);
  app.add_option("--animation", options.animation,
                 "Which animation of a mesh is taken (default: the first of glTF, all of other formats)")
      ->type_name("NAME");
  app.add_option("--mesh-seconds", options.mesh_seconds,
                 "Processor time that reading a mesh may take (default: 120)")
      ->type_name("SECONDS")
      ->check(pprt::number_between(1, 1e6));
  pprt::add_choice(app, "--up", options.up, "Up axis of an added camera");
  app.add_flag("--strict", options.strict, "Reject what the format's specification does not allow");
  app.add_option("--memory", options.memory,
                 "Most memory that reading may take, as 500M or 4G (default: an eighth of what is there)")
      ->transform(pprt::memory_size())
      ->type_name("SIZE");
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
