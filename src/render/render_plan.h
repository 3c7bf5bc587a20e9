// What a run will do, settled before anything is rendered. After planning only the plan travels.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "image/frame_pattern.h"
#include "layers/layer.h"
#include "live/address.h"
#include "parallel/session_settings.h"
#include "render/existing_files.h"
#include "render/named_file.h"
#include "render/render_options.h"
#include "scene/animation.h"
#include "scene/scene_description.h"
#include "trace/compiled_scene.h"

namespace pprt {

// One frame of the script or of the scene's own animation: its view, in scene space and of the image's size.
struct PlannedFrame {
  int number = 1;  // from 1
  View view;
  double time = 0;   // of what moves in the scene, seconds
  bool cut = false;  // the camera jumps to it
};

// Files that the run writes.
struct OutputPlan {
  std::vector<FramePattern> pictures;  // of each frame; empty: nothing is written
  std::vector<Layer> layers;
  ExistingFiles existing = ExistingFiles::kRefuse;
  std::filesystem::path contact_sheet;  // empty: none
  std::filesystem::path film;           // empty: none
  double film_rate = 25;                // frames/s
};

// What the run reports about its frames.
struct ReportPlan {
  std::string ledger;                     // file; "-": standard output; empty: none
  std::filesystem::path trace;            // of balancing; empty: none
  std::optional<FramePattern> reference;  // pictures to measure errors against
  bool compare_serial = false;            // measure the distance to the serial sample pattern
  bool census = false;                    // print the scene's effects, and with frames the rays
};

struct RenderPlan {
  SceneDescription scene;
  std::optional<std::string> scene_name;    // as a script in any directory names it; empty: none can
  std::vector<ObjectMotion> objects;        // that the script moves, named so that any script can
  std::string script_name;                  // empty: none
  std::vector<PlannedFrame> script_frames;  // all, rendered or not
  std::vector<PlannedFrame> frames;         // those to render
  bool renders = true;                      // false: a census alone
  std::vector<NamedFile> inputs;            // files that are read, without --reference's
  OutputPlan output;
  ReportPlan report;
  SessionSettings settings{.sampler = SamplerChoice::kAuto};
  std::optional<LiveAddress> live;
  CompileOptions compile;
  std::string warnings;  // about scene and script, for people
};

// Mean triangle weight at which a still looks converged: the structural similarity to a converged picture is
// at least 0.99 on every SPD scene tried (docs/decisions/0007-still-quality.md).
inline constexpr double kStillWeight = 0.005;

// The same for the lattice: the mean worth of what is still to be sampled (docs/decisions/0021-lattice.md).
inline constexpr double kLatticeStillWeight = 2.8e-5;

// Returns the settings of a picture at full quality, taken while frames are made with `live`.
SessionSettings photo_settings(const SessionSettings& live);

// Returns every file of a frame: its pictures and, beside those that cannot hold layers, the layers' own.
std::vector<FramePattern> files_of_a_frame(const OutputPlan& output);

// Checks what can be judged from the options alone. Throws UsageError.
void check_usage(const RenderOptions& options);

// Reads scene and script, once. The options must have passed check_usage(). Throws UsageError, or InputError
// with every problem of the file and its warnings.
RenderPlan plan_render(const RenderOptions& options);

}  // namespace pprt
