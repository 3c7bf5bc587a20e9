#include "parser/aff_actions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "scene/animation/animation.h"
#include "scene/description/shading_rules.h"
#include "scene/movement/movement_limits.h"
#include "scene/polygons/triangulate.h"

namespace pprt::aff {
namespace {

constexpr int kLargestResolution = 65536;                                 // pixels
constexpr std::size_t kPlace = sizeof(PrimitiveRef) + sizeof(NodeIndex);  // bytes, of an object in its lists

}  // namespace

SceneBuilder::SceneBuilder(const AffOptions& options, ReadIncluded read_included)
    : options_(options), read_included_(std::move(read_included)) {}

// --- Files and problems

void SceneBuilder::enter(SourceFile& file) {
  open_.push_back({&file, LineCursor(file.text), nodes_.size()});
}

// Braces that a file opens it closes, too.
void SceneBuilder::leave() {
  while (nodes_.size() > open_.back().nodes) {
    open_.back().file->diagnostics.error(nodes_.back().location, "'{' is not closed in this file");
    nodes_.pop_back();
  }
  open_.pop_back();
}

// A file that is read again has told its problems.
void SceneBuilder::error(const char* place, std::string message) {
  Diagnostics& diagnostics = open_.back().file->diagnostics;
  const SourceLocation at = locate(place);
  const auto is_same = [&](const Diagnostic& told) {
    return told.severity == Severity::kError && told.location.line == at.line &&
           told.location.column == at.column;
  };
  if (std::any_of(diagnostics.kept().begin(), diagnostics.kept().end(), is_same)) return;
  diagnostics.error(at, std::move(message));
  if (++errors_ >= options_.max_errors) throw TooManyErrors{};
}

void SceneBuilder::deviation(Deviation kind) {
  if (options_.strict) return error(keyword_.data(), text_of(kind).problem);
  Occurrence& occurrence = deviations_[static_cast<std::size_t>(kind)];
  if (occurrence.count++ > 0) return;
  occurrence.file = open_.back().file;
  occurrence.first = locate(keyword_.data());
}

void SceneBuilder::finish() {
  for (std::size_t i = 0; i < deviations_.size(); ++i) {
    const Occurrence& found = deviations_[i];
    if (found.count == 0) continue;
    const DeviationText text = text_of(static_cast<Deviation>(i));
    const std::string times = found.count > 1 ? fmt::format(" ({} times, first here)", found.count) : "";
    found.file->diagnostics.warning(found.first, fmt::format("{}: {}{}", text.problem, text.reading, times));
  }
  scene_.movement.tracks = std::move(tracks_);
  if (!scene_.ambient) scene_.ambient = Rgb(1, 1, 1);
}

void SceneBuilder::begin(std::string_view keyword) {
  keyword_ = keyword;
  numbers_.clear();
  rows_ = 0;
  mesh_ = {};
  triangles_of_mesh_.clear();
  moving_ = {};
  track_ = {};
}

// Checks a count before anything is read for it: a row takes two bytes at least.
void SceneBuilder::count(std::string_view matched) {
  const double value = numbers_.back();
  numbers_.pop_back();
  const std::string& text = open_.back().file->text;
  const auto left = static_cast<double>(text.data() + text.size() - (matched.data() + matched.size()));
  const char* const place = matched.data() + matched.find_last_of(" \t\f\v\n\r") + 1;
  if (value < 0 || value != std::floor(value)) {
    throw ParseFailure{place, fmt::format("a number of '{}' must be whole, and not negative", keyword_)};
  }
  if (value > static_cast<double>(options_.max_rows) || value > left) {
    throw ParseFailure{place,
                       fmt::format("{:.0f} rows in '{}' are more than this file can hold", value, keyword_)};
  }
  rows_ = static_cast<std::size_t>(value);
}

int SceneBuilder::whole(double value, const char* what, int least, int most) {
  if (value >= least && value <= most && value == std::floor(value)) return static_cast<int>(value);
  error(keyword_.data(),
        fmt::format("{} of '{}' must be a whole number from {} to {}", what, keyword_, least, most));
  return least;
}

// --- View and lights

void SceneBuilder::add_view() {
  constexpr double kLeastHither = 0.0001;
  View view;
  view.location = locate(keyword_.data());
  view.from = vector_at(0), view.at = vector_at(3), view.up = vector_at(6);
  view.angle_degrees = numbers_[9];
  view.hither = numbers_[10] < kLeastHither ? 1 : numbers_[10];
  view.width = whole(numbers_[11], "the width", 1, kLargestResolution);
  view.height = whole(numbers_[12], "the height", 1, kLargestResolution);
  if (!(view.angle_degrees > 0 && view.angle_degrees < 180))
    error(keyword_.data(), "the view's angle must lie between 0 and 180 degrees");
  const std::string_view defect = camera_defect(view.from, view.at, view.up);
  if (!defect.empty()) error(keyword_.data(), std::string(defect));
  if (scene_.view) deviation(Deviation::kViewRepeated);
  scene_.view = view;
}

void SceneBuilder::add_light() {
  Light light;
  light.position = vector_at(0);
  if (numbers_.size() > 3) light.color = color_at(3);
  light.location = location_in_scene();
  count_kept(1, sizeof(Light) + sizeof(LightNode));
  scene_.lights.push_back(light);
  scene_.light_nodes.push_back({.node = nodes_.back().node});
}

void SceneBuilder::add_named_light() {
  add_light();
  scene_.light_nodes.back().track = name_;
}

void SceneBuilder::add_sun() {
  if (vector_at(0) == Vec3d(0, 0, 0)) return error(keyword_.data(), "the direction to the sun is zero");
  add_light();
  scene_.lights.back().is_sun = true;
}

void SceneBuilder::set_sky() {
  const Sky sky{.up = vector_at(0), .horizon = color_at(3), .zenith = color_at(6)};
  if (sky.up == Vec3d(0, 0, 0)) return error(keyword_.data(), "the direction to the zenith is zero");
  scene_.sky = sky;
}

// --- Materials

// NFF's materials reflect a fixed share of the ambient light.
void SceneBuilder::set_fill() {
  const Rgb color = color_at(0);
  Material m;
  m.terms = {.ambient = color * kAmbientReflectance,
             .diffuse = color * numbers_[3],
             .specular = Rgb(numbers_[4], numbers_[4], numbers_[4])};
  m.shine = numbers_[5], m.transmittance = numbers_[6], m.refractive_index = numbers_[7];
  use(m);
}

void SceneBuilder::set_material() {
  Material m;
  m.terms = {.ambient = color_at(0), .diffuse = color_at(3), .specular = color_at(6)};
  m.shine = numbers_[9], m.transmittance = numbers_[10], m.refractive_index = numbers_[11];
  use(m);
}

// Opaque things often have the index 0, which means nothing.
void SceneBuilder::use(const Material& material) {
  material_ = material;
  const Rgb& specular = material.terms->specular;
  material_.specular = std::max({specular.x, specular.y, specular.z});
  if (material_.refractive_index <= 0) {
    if (material_.transmittance > 0) deviation(Deviation::kGlassIndex);
    material_.refractive_index = 1;
  }
  has_material_ = true;
}

void SceneBuilder::require_material() {
  if (has_material_) return;
  deviation(Deviation::kNoMaterial);
  Material white;
  white.terms.emplace();
  use(white);
}

// What the current material gives off, until the next one.
void SceneBuilder::set_emission() {
  require_material();
  material_.emission = color_at(0);
  material_.emission_texture.reset();
}

void SceneBuilder::set_textured_emission() {
  set_emission();
  material_.emission_texture = texture();
}

// Returns the current material, with the directive's texture if it has one.
MaterialIndex SceneBuilder::material() {
  require_material();
  Material m = material_;
  if (mesh_.texture_points.empty()) {
    m.emission_texture.reset();
  } else if (name_ != kNoTexture) {
    m.texture = texture();
  }
  return materials_.intern(scene_.materials, m);
}

// Returns where the directive at hand stands in the scene's own file. One of an included file has no place.
SourceLocation SceneBuilder::location_in_scene() {
  return depth() == 1 ? locate(keyword_.data()) : SourceLocation();
}

// The primitives that were added last stand in the innermost transform.
void SceneBuilder::stand_in_node(std::size_t primitives) {
  scene_.nodes.insert(scene_.nodes.end(), primitives, nodes_.back().node);
}

// `name_` is the texture's.
TextureIndex SceneBuilder::texture() {
  const auto found = textures_.find(name_);
  if (found != textures_.end()) return found->second;
  const auto index = static_cast<TextureIndex>(scene_.textures.size());
  scene_.textures.emplace_back().name = name_;
  const SourceLocation at = locate(keyword_.data());
  texture_places_.push_back(fmt::format("{}:{}:{}", open_.back().file->name, at.line, at.column));
  textures_.emplace(name_, index);
  return index;
}

// --- Objects

// Files that are short may be read many times: all that is kept counts, twice, for lists grow by doubling.
void SceneBuilder::count_kept(std::size_t items, std::size_t bytes) {
  kept_ += items;
  kept_bytes_ += 2 * bytes;
  if (kept_ > options_.max_items)
    throw ParseFailure{keyword_.data(),
                       fmt::format("more than {} objects, vertices, keys and transforms", options_.max_items),
                       true};
  if (kept_bytes_ > options_.max_memory)
    throw ParseFailure{keyword_.data(), too_much_memory(options_.max_memory), true};
}

void SceneBuilder::add_sphere() {
  const MaterialIndex of = material();
  if (numbers_[3] == 0) return deviation(Deviation::kNoExtent);
  count_kept(1, sizeof(Sphere) + kPlace);
  pprt::add_sphere(scene_, {vector_at(0), numbers_[3], of, location_in_scene()});
  stand_in_node(1);
}

void SceneBuilder::add_cone() {
  const MaterialIndex of = material();
  const double base = numbers_[3], apex = numbers_[7];
  if (vector_at(0) == vector_at(4) || (base == 0 && apex == 0) || base * apex < 0)
    return deviation(Deviation::kNoExtent);
  count_kept(1, sizeof(Cone) + kPlace);
  pprt::add_cone(scene_, {vector_at(0), base, vector_at(4), apex, of, location_in_scene()});
  stand_in_node(1);
}

void SceneBuilder::corner() {
  mesh_.positions.push_back(vector_at(0));
  numbers_.clear();
}

void SceneBuilder::smooth_corner() {
  mesh_.positions.push_back(vector_at(0));
  mesh_.normals.push_back(vector_at(3));
  numbers_.clear();
}

// Corners are used once each: every list has its index.
void SceneBuilder::add_polygon() {
  for (const TriangleIndices& corners : triangulate(mesh_.positions)) {
    TriangleCorners& t = triangles_of_mesh_.emplace_back();
    t.position = corners;
    if (!mesh_.normals.empty()) t.normal = corners;
  }
  if (triangles_of_mesh_.empty()) return deviation(Deviation::kNoExtent);
  add_mesh();
}

void SceneBuilder::add_textured() {
  for (std::size_t i = 0; i < 15; i += 5) {
    mesh_.positions.push_back(vector_at(i));
    mesh_.texture_points.emplace_back(numbers_[i + 3], numbers_[i + 4]);
  }
  add_corners();
}

void SceneBuilder::add_smooth_textured() {
  for (std::size_t i = 0; i < 24; i += 8) {
    mesh_.positions.push_back(vector_at(i));
    mesh_.normals.push_back(vector_at(i + 3));
    mesh_.texture_points.emplace_back(numbers_[i + 6], numbers_[i + 7]);
  }
  add_corners();
}

// A triangle with a texture.
void SceneBuilder::add_corners() {
  triangles_of_mesh_ = {{.position = {0, 1, 2}, .normal = {0, 1, 2}, .texture_point = {0, 1, 2}}};
  add_mesh();
}

void SceneBuilder::moving_key() {
  MovingTriangle::Key key;
  key.time = numbers_[0];
  for (std::size_t i = 0; i < 3; ++i) {
    key.positions[i] = vector_at(1 + 6 * i);
    key.normals[i] = vector_at(4 + 6 * i);
  }
  moving_.keys.push_back(key);
  numbers_.clear();
}

void SceneBuilder::add_moving() {
  if (moving_.keys.empty()) return error(keyword_.data(), "'tpa' needs a key");
  check_times(moving_.keys);
  moving_.material = material();
  moving_.location = location_in_scene();
  count_kept(1 + moving_.keys.size(),
             sizeof(MovingTriangle) + kPlace + moving_.keys.size() * sizeof(MovingTriangle::Key));
  add_moving_triangle(scene_, std::move(moving_));
  stand_in_node(1);
}

void SceneBuilder::mesh_position() {
  mesh_.positions.push_back(vector_at(0));
  numbers_.clear();
}

void SceneBuilder::mesh_normal() {
  mesh_.normals.push_back(vector_at(0));
  numbers_.clear();
}

void SceneBuilder::mesh_texture_point() {
  mesh_.texture_points.emplace_back(numbers_[0], numbers_[1]);
  numbers_.clear();
}

std::size_t SceneBuilder::indices_of_a_row() const {
  return 3 * (1 + (mesh_.normals.empty() ? 0 : 1) + (mesh_.texture_points.empty() ? 0 : 1));
}

// Three vertices, then three normals, then three texture points, as far as there are such lists. Vertices
// must be there: what reads the scene looks them up unasked.
void SceneBuilder::triangle() {
  TriangleCorners triangle;
  std::size_t next = 0;
  const auto take = [&](std::array<std::uint32_t, 3>& indices, std::size_t size, const char* what) {
    for (std::uint32_t& index : indices) {
      const double value = numbers_[next];
      const char* const place = places_[next++];
      if (!(value >= 0 && value < static_cast<double>(size) && value == std::floor(value))) {
        const std::string has = size > 0 ? fmt::format("{}, from 0 on", size) : "none";
        throw ParseFailure{place, fmt::format("{:g} is no index of a {}: 'm' has {}", value, what, has)};
      }
      index = static_cast<std::uint32_t>(value);
    }
  };
  take(triangle.position, mesh_.positions.size(), "vertex");
  if (!mesh_.normals.empty()) take(triangle.normal, mesh_.normals.size(), "normal");
  if (!mesh_.texture_points.empty())
    take(triangle.texture_point, mesh_.texture_points.size(), "texture coordinate");
  triangles_of_mesh_.push_back(triangle);
  numbers_.clear();
}

void SceneBuilder::add_mesh() {
  mesh_.material = material();
  mesh_.location = location_in_scene();
  const std::size_t vectors = mesh_.positions.size() + mesh_.normals.size();
  count_kept(triangles_of_mesh_.size() + vectors + mesh_.texture_points.size(),
             sizeof(TriangleMesh) + triangles_of_mesh_.size() * (sizeof(Triangle) + kPlace) +
                 vectors * sizeof(Vec3d) + mesh_.texture_points.size() * sizeof(Vec2d));
  if (triangles_of_mesh_.empty()) return;
  pprt::add_mesh(scene_, std::move(mesh_), triangles_of_mesh_);
  stand_in_node(triangles_of_mesh_.size());
}

// --- Files, detail, transforms

void SceneBuilder::include() {
  const int level = whole(numbers_[0], "the level", -kMostFrames, kMostFrames);
  if (level <= detail_) read_included_(name_);
}

void SceneBuilder::set_detail() {
  detail_ = whole(numbers_[0], "the level", -kMostFrames, kMostFrames);
}

void SceneBuilder::begin_static() {
  begin_node(translation(vector_at(7)) * rotation(vector_at(3), numbers_[6]) * scaling(vector_at(0)), {});
}

void SceneBuilder::begin_animated() {
  begin_node({}, std::string(name_));
}

void SceneBuilder::begin_node(const Affine& to_parent, std::string track) {
  if (nodes_.size() > static_cast<std::size_t>(options_.max_transforms))
    throw ParseFailure{keyword_.data(),
                       fmt::format("more than {} transforms in each other", options_.max_transforms), true};
  const SourceLocation at = locate(keyword_.data());
  count_kept(1, sizeof(SceneNode) + track.size());
  const auto node = static_cast<NodeIndex>(scene_.movement.nodes.size());
  scene_.movement.nodes.push_back(
      {.parent = nodes_.back().node, .to_parent = to_parent, .track = std::move(track), .location = at});
  nodes_.push_back({node, at});
}

void SceneBuilder::close(std::string_view brace) {
  if (nodes_.size() > open_.back().nodes) {
    nodes_.pop_back();
  } else {
    error(brace.data(), "'}' closes nothing that this file has opened");
  }
}

// --- Tracks

void SceneBuilder::translation_key() {
  track_.translation.push_back({numbers_[0], vector_at(1), shape_at(4)});
  numbers_.clear();
}

void SceneBuilder::scale_key() {
  track_.scale.push_back({numbers_[0], vector_at(1), shape_at(4)});
  numbers_.clear();
}

void SceneBuilder::rotation_key() {
  track_.rotation.push_back({numbers_[0], vector_at(1), numbers_[4], shape_at(5)});
  numbers_.clear();
}

void SceneBuilder::visibility_key() {
  track_.visibility.push_back({numbers_[0], numbers_[1] != 0});
  numbers_.clear();
}

void SceneBuilder::end_curve() {
  if (rows_ < kLeastCurveKeys)
    error(keyword_.data(), fmt::format("a curve of 'k' needs at least {} keys", kLeastCurveKeys));
}

template <typename Key>
void SceneBuilder::check_times(const std::vector<Key>& keys) {
  const auto later = [](const Key& a, const Key& b) { return a.time > b.time; };
  if (std::adjacent_find(keys.begin(), keys.end(), later) != keys.end())
    deviation(Deviation::kDecreasingTimes);
}

void SceneBuilder::end_visibility() {
  if (rows_ < 1) error(keyword_.data(), "'visibility' of 'k' needs a key");
  check_times(track_.visibility);
}

// Files that are read twice give their tracks twice: the last one counts.
void SceneBuilder::add_track() {
  check_times(track_.translation);
  check_times(track_.scale);
  check_times(track_.rotation);
  note_order(track_);
  tracks_.insert_or_assign(std::string(name_), std::move(track_));
}

void SceneBuilder::set_times() {
  if (scene_.movement.times) deviation(Deviation::kTimesRepeated);
  scene_.movement.times = FrameTimes{.start = numbers_[0],
                                     .end = numbers_[1],
                                     .frames = whole(numbers_[2], "the number of frames", 1, kMostFrames)};
}

}  // namespace pprt::aff
