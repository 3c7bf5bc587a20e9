#include "convert/model_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "cli/scenes/scene_source.h"
#include "convert/mesh/mesh_reader.h"
#include "convert/model/camera_track.h"
#include "convert/model/model_animation.h"
#include "convert/names/extension.h"
#include "scene/animation/resting_nodes.h"
#include "scene/movement/straight_track.h"
#include "spd/spd.h"

namespace pprt {
namespace {

constexpr double kSecondsOfTurn = 4;
constexpr const char* kTurn = "turn";

// Empty where the scene has lights. The view must be there.
std::optional<std::string> complete_lights(SceneDescription& scene) {
  if (!scene.lights.empty()) return std::nullopt;
  scene.lights = default_lights(scene, *scene.view);
  return "no lights: a key light and a fill light are added";
}

// Turns about an axis through a place.
Affine turn_about(const Vec3d& center, const Vec3d& axis, double degrees) {
  return translation(center) * rotation(axis, degrees) * translation(-center);
}

}  // namespace

bool is_model_name(const std::string& name) {
  return name != "-" && !is_spd_name(name) && extension_of(name) != ".aff" &&
         is_mesh_extension(extension_of(name));
}

bool moves(const SceneDescription& scene) {
  const auto has_track = [&](const auto& moved) { return scene.movement.tracks.contains(moved.track); };
  const std::vector<SceneNode>& nodes = scene.movement.nodes;
  return (scene.view && scene.movement.tracks.contains(kCameraTrack)) || !scene.moving_triangles.empty() ||
         std::any_of(nodes.begin(), nodes.end(), has_track) ||
         std::any_of(scene.light_nodes.begin(), scene.light_nodes.end(), has_track);
}

std::optional<std::string> complete_view(SceneDescription& scene, UpAxis up) {
  if (scene.view || scene.primitive_count() == 0) return std::nullopt;
  const SceneDescription still =
      moves(scene) ? still_at(scene, start_time(scene.movement)) : SceneDescription();
  scene.view = fitted_view(still.primitive_count() > 0 ? still : scene, up);
  const bool y = up == UpAxis::kY;
  return fmt::format("no camera: one that shows everything is added, with {} up (--up {} for the other)",
                     y ? 'y' : 'z', y ? 'z' : 'y');
}

std::optional<std::string> complete_background(SceneDescription& scene) {
  if (scene.background || scene.sky) return std::nullopt;
  scene.background = Rgb(0.18, 0.2, 0.23);
  return "no background: a grey one is added";
}

ParsedScene load_object(const std::string& path, const MeshLimits& limits) {
  require_file(path);
  ReadMesh mesh = read_mesh_isolated(path, limits);
  ParsedScene parsed{.scene = std::move(mesh.scene), .files = std::move(mesh.files)};
  for (const std::string& note : mesh.notes) parsed.warnings += parsed.scene.name + ": " + note + "\n";
  return parsed;
}

Model load_model(const std::string& path, const ModelOptions& options) {
  Model model{.parsed = load_object(path, options.limits)};
  SceneDescription& scene = model.parsed.scene;
  const std::optional<std::string> view = complete_view(scene, options.up);
  const std::optional<std::string> lights = options.adds_lights ? complete_lights(scene) : std::nullopt;
  model.is_lit_anew = lights.has_value();
  for (const auto& added : {view, lights}) {
    if (added) model.parsed.warnings += scene.name + ": " + *added + "\n";
  }
  return model;
}

void set_rate(SceneDescription& scene, double frames_per_second) {
  std::optional<FrameTimes>& times = scene.movement.times;
  if (times) times = frames_between(times->start, times->end, frames_per_second);
}

void add_turn(SceneDescription& scene, UpAxis up, double frames_per_second, bool is_lit_anew) {
  const Vec3d center = bounds(scene).center(), axis = up == UpAxis::kY ? Vec3d(0, 1, 0) : Vec3d(0, 0, 1);
  const int frames = std::max(2, static_cast<int>(std::lround(kSecondsOfTurn * frames_per_second)));
  const double rate = frames / kSecondsOfTurn, end = (frames - 1) / rate;
  Movement& movement = scene.movement;
  movement.times = FrameTimes{.start = 0, .end = end, .frames = frames};
  const auto degrees_at = [&](double time) { return 360 * time / kSecondsOfTurn; };
  const View first = *scene.view;
  const auto view_at = [&](double time) {
    const Affine turn = turn_about(center, axis, degrees_at(time));
    View view = first;
    view.from = turn.point(first.from), view.at = turn.point(first.at), view.up = turn.vector(first.up);
    return view;
  };
  movement.tracks[kCameraTrack] = camera_track({0, end / 3, 2 * end / 3, end}, view_at);
  if (!is_lit_anew) return;
  MotionTrack& turn = movement.tracks[kTurn];
  for (const double time : {0.0, end / 3, 2 * end / 3, end})
    turn.rotation.push_back({time, axis, degrees_at(time)});
  make_straight(turn.rotation);
  note_order(turn);
  const auto around = static_cast<NodeIndex>(movement.nodes.size());
  movement.nodes.push_back({.parent = 0, .to_parent = translation(center)});
  movement.nodes.push_back({.parent = around, .track = kTurn});
  for (Light& light : scene.lights) light.position -= center;
  scene.light_nodes.assign(scene.lights.size(), {.node = around + 1});
}

}  // namespace pprt
