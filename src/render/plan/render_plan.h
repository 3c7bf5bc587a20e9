// What a run will do, settled before anything is rendered. After planning only the plan travels.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/file_table.h"
#include "live/address.h"
#include "parallel/settings/session_settings.h"
#include "render/options/outputs.h"
#include "scene/animation/animation.h"
#include "scene/description/scene_description.h"
#include "trace/compiled_scene.h"

namespace pprt {

struct RenderOptions;

// One frame of the script or of the scene's own animation: its view, in scene space and of the image's size.
struct PlannedFrame {
  int number = 1;  // from 1
  View view;
  double time = 0;   // of what moves in the scene, seconds
  bool cut = false;  // the camera jumps to it
};

struct RenderPlan {
  std::optional<std::string> scene_name;    // as a script in any directory names it; empty: none can
  std::vector<ObjectMotion> objects;        // that the script moves, named so that any script can
  Daylight daylight;                        // of the script
  std::string script_name;                  // empty: none
  int script_length = 1;                    // frames of the script or of the scene's own animation
  std::vector<PlannedFrame> script_frames;  // by which it is judged: all, or kMostJudged at equal distances
  std::string script_keys;                  // that decide the frames; empty: all are among script_frames
  std::vector<PlannedFrame> frames;         // those to render
  bool renders = true;                      // false: a census alone
  std::vector<NamedFile> inputs;            // files that are read, without --reference's
  OutputFiles output;
  Reports report;
  SessionSettings settings{.sampler = SamplerChoice::kAuto};
  std::optional<double> film_time;  // seconds of all frames together; empty: they are not divided
  bool goes_on = false;             // without ranks that do not answer
  std::optional<LiveAddress> live;
  CompileOptions compile;
  std::string warnings;  // about scene and script, for people
  SceneDescription scene;
};

// Most frames that a long script is judged by. Besides these, only the frames to render are planned.
inline constexpr int kMostJudged = 1000;

// Returns every file of a frame: its pictures and, beside those that cannot hold layers, the layers' own.
std::vector<FramePattern> files_of_a_frame(const OutputFiles& output);

// Reads scene and script, once. The options must have passed check_usage(). Throws UsageError, or InputError
// with every problem of the file and its warnings.
RenderPlan plan_render(const RenderOptions& options);

}  // namespace pprt
