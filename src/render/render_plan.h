// What a command line asks for, checked and settled before anything is rendered.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "image/frame_pattern.h"
#include "layers/layer.h"
#include "parallel/session_settings.h"
#include "render/render_options.h"
#include "scene/animation.h"
#include "scene/scene_description.h"
#include "trace/compiled_scene.h"

namespace pprt {

// One frame to render: its view, in scene space and of the image's size.
struct PlannedFrame {
  int number = 1;
  View view;
  bool cut = false;
};

struct RenderPlan {
  SceneDescription scene;
  std::string script_name;                  // empty: none
  std::vector<PlannedFrame> script_frames;  // all, rendered or not
  std::vector<PlannedFrame> frames;         // those to render
  std::vector<FramePattern> outputs;
  std::vector<Layer> layers;
  std::optional<FramePattern> reference;
  double film_rate = 25;  // frames/s
  SessionSettings settings;
  CompileOptions compile;
  std::string warnings;  // of scene and script, for people
};

// A still looks converged at this mean triangle weight: the structural similarity to a converged picture is
// at least 0.99 on every SPD scene tried (docs/decisions/0007-still-quality.md).
inline constexpr double kStillQuality = 0.005;

// Every file of a frame: the outputs and, beside those that cannot hold them, the layers' pictures.
std::vector<FramePattern> files_of_a_frame(const RenderPlan& plan);

// What can be judged from the command line alone. Throws UsageError.
void check_usage(const RenderOptions& options);

// Reads scene and script, once. Throws UsageError, or InputError with every problem of the file that has any.
RenderPlan plan_render(const RenderOptions& options);

}  // namespace pprt
