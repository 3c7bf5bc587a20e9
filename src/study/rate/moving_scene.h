// A film that can be shown at any frame rate: its view and what moves in it, at any moment.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "parallel/master/master.h"
#include "scene/animation/animation.h"
#include "scene/description/scene_description.h"
#include "study/reference.h"
#include "trace/compiled_scene.h"

namespace pprt {

// Moments are seconds since the film began. After its end the film rests.
struct MovingScene {
  struct Moment {
    View view;
    double time = 0;  // of what moves in the scene
  };

  std::string name;
  CompiledScene scene;
  std::function<Moment(double moment_s)> at;
  double rate = 24;  // frames a second of its own
  double length_s = std::numeric_limits<double>::infinity();
  std::function<bool(double from_s, double to_s)> cuts_between = [](double, double) { return false; };
};

// Reads the scene of a script, with the daylight that the script tells and the objects that it moves.
// `scene`: empty where the script names it. Throws InputError for what cannot be read.
SceneDescription read_scripted_scene(const std::string& scene, const Animation& script,
                                     const std::string& script_path);

// Reads a film: a script, with a scene where it names none, or a scene that moves by itself. Throws
// UsageError for other inputs, InputError for what cannot be read.
MovingScene read_moving_scene(const std::vector<std::string>& inputs);

// Returns the film of a script, 24 frames/s where it tells no rate. Throws InputError where there is no view.
MovingScene moved_by_script(const std::string& name, const SceneDescription& description,
                            const Animation& script);

// Returns the film of a scene whose frames have times. Throws InputError where there is no view.
MovingScene moved_by_itself(const std::string& name, const SceneDescription& description);

// Returns an endless film of a scene with a view: the eye goes round the target.
MovingScene moved_round(const std::string& name, const SceneDescription& description,
                        double degrees_per_second);

// Returns what is pictured at a moment, in size x size pixels.
Subject subject_at(const MovingScene& moving, double moment_s, int size);

// Returns the film's first `count` frames at a rate, in size x size pixels.
std::vector<FrameRequest> frames_at(const MovingScene& moving, double fps, int count, int size);

}  // namespace pprt
