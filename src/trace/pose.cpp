#include "trace/pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "trace/geometry/embree_reach.h"
#include "trace/geometry/numerics.h"

namespace pprt {

// A body that changes its shape: parts and hierarchy of its own, which Embree refits.
struct Pose::Deforming {
  std::uint32_t body = 0;
  std::vector<std::pair<std::uint32_t, ScenePart>> parts;  // with their numbers
  std::vector<EmbreeGeometry> geometries;
  EmbreeScene embree;
};

namespace {

Vec3d in_float(const Vec3d& v) {
  return Vec3d(Vec3f(v));
}

double norm(const Affine& map) {
  return std::sqrt(map.x.length2() + map.y.length2() + map.z.length2());
}

// Returns the map of a body's compiled space to the world's, rounded as Embree has it. A body out of reach is
// not shown.
BodyPlace place_body(const CompiledBody& body, const CompiledScene::Impl& scene, const Placement& node) {
  const Normalisation& world = scene.normalisation;
  const double scale = world.scale / body.normalisation.scale;
  const Affine& map = node.to_parent;
  BodyPlace place;
  place.to_world = {in_float(map.x * scale), in_float(map.y * scale), in_float(map.z * scale),
                    in_float(world.point(map.point(body.normalisation.center)))};
  const double volume = place.to_world.determinant();
  const double size = norm(place.to_world);
  // A body that is flattened shows nothing: its faces have no inside, and rays cannot be mapped into it.
  constexpr double kFlat = 1e-12;
  if (node.visible && std::abs(volume) > kFlat * size * size * size) {
    place.from_world = inverse(place.to_world);
    place.is_shown =
        is_in_reach(place.to_world, place.from_world, mapped(place.to_world, body.box), scene.radius);
  } else {
    place.is_shown = false;
  }
  if (!place.is_shown) {
    place.to_world = place.from_world = Affine();
    return place;
  }
  place.rounding = instance_rounding(size * norm(place.from_world) / 3);
  place.distance = sum_of_coordinates(place.to_world.origin);
  return place;
}

void place_instance(RTCGeometry instance, const BodyPlace& place) {
  std::array<float, 12> columns;
  std::size_t next = 0;
  const Affine& map = place.to_world;
  for (const Vec3d& column : {map.x, map.y, map.z, map.origin}) {
    for (int k = 0; k < 3; ++k) columns[next++] = static_cast<float>(column[k]);
  }
  rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
  if (place.is_shown) {
    rtcEnableGeometry(instance);
  } else {
    rtcDisableGeometry(instance);
  }
  rtcCommitGeometry(instance);
}

bool crosses(const Box3d& box, const Vec3d& from, const Vec3d& step) {
  double near = 0, far = 1;
  for (int i = 0; i < 3; ++i) {
    const double a = (box.min[i] - from[i]) / step[i], b = (box.max[i] - from[i]) / step[i];
    if (std::isnan(a) || std::isnan(b)) continue;  // along the box's face: the other axes decide
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  return near <= far;
}

}  // namespace

Pose::Pose(const CompiledScene::Impl& scene) : scene_(scene), lights_(scene.lights) {
  embree_ = scene.bodies[0].embree.get();
  if (!scene.moves) return;
  own_lights_ = scene.lights;
  lights_ = own_lights_;
  for (std::uint32_t body = 0; body < scene.bodies.size(); ++body) {
    if (!scene.bodies[body].deforms) continue;
    auto& own = *deforming_.emplace_back(std::make_unique<Deforming>());
    own.body = body;
    own.embree.reset(rtcNewScene(scene.device.get()));
    rtcSetSceneFlags(own.embree.get(), RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC);
    deformed_.resize(scene.parts.size());
    for (std::uint32_t i = 0; i < scene.parts.size(); ++i) {
      if (scene.parts[i].body == body) own.parts.emplace_back(i, scene.parts[i]);
    }
    for (auto& [number, part] : own.parts) deformed_[number] = &part;
  }
  // Low build quality would be no faster, and its builder ends the process where all bodies are one point.
  if (scene.bodies.size() > 1) {
    own_embree_.reset(rtcNewScene(scene.device.get()));
    rtcSetSceneFlags(own_embree_.get(), RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC);
    embree_ = own_embree_.get();
  }
  set_time(start_time(scene.movement));
}

Pose::~Pose() = default;

bool Pose::set_time(double time) {
  if (!scene_.moves) return false;
  const std::vector<BodyPlace> before = places_;
  const std::vector<ShadingLight> lights_before = own_lights_;
  place_bodies(time);
  place_lights(time);
  note_changes(has_time_ ? before : places_, has_time_ ? lights_before : own_lights_);
  has_time_ = true;
  return any_light_moved_ || std::find(has_moved_.begin(), has_moved_.end(), true) != has_moved_.end();
}

void Pose::place_bodies(double time) {
  for (const auto& own : deforming_) deform(*own, time);
  if (!own_embree_) return;
  if (instances_.empty()) add_instances();
  const std::vector<Placement> nodes = placements_at(scene_.movement, time);
  rounding_ = 0;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const CompiledBody& body = scene_.bodies[i];
    if (i > 0) places_[i] = place_body(body, scene_, nodes[body.node]);
    rounding_ = std::max(rounding_, places_[i].rounding);
    place_instance(instances_[i].get(), places_[i]);
  }
  rtcCommitScene(own_embree_.get());
  check_embree(scene_.device, "moving the scene's objects");
}

// Gives triangles their shapes at a time. Embree refits what it has built.
void Pose::deform(Deforming& own, double time) const {
  for (auto& [number, part] : own.parts) {
    Mesh& mesh = std::get<Mesh>(part.shape);
    for (std::size_t i = 0; i < part.shapes.size(); ++i) {
      const MovingTriangle::Key shape = shape_at(part.shapes[i], time);
      mesh.set_shape(i, shape.positions,
                     {Vec3f(shape.normals[0]), Vec3f(shape.normals[1]), Vec3f(shape.normals[2])});
    }
  }
  const bool is_new = own.geometries.empty();
  for (std::size_t i = 0; i < own.parts.size(); ++i) {
    auto& [number, part] = own.parts[i];
    if (is_new) {
      EmbreeGeometry& geometry = own.geometries.emplace_back(
          new_mesh_geometry(scene_.device, std::get<Mesh>(part.shape), part.faces));
      rtcSetGeometryBuildQuality(geometry.get(), RTC_BUILD_QUALITY_REFIT);
      rtcAttachGeometryByID(own.embree.get(), geometry.get(), number);
    } else {
      rtcUpdateGeometryBuffer(own.geometries[i].get(), RTC_BUFFER_TYPE_VERTEX, 0);
    }
    rtcCommitGeometry(own.geometries[i].get());
  }
  rtcCommitScene(own.embree.get());
}

// One for each body, what rests among them. A body's number is that of its instance.
void Pose::add_instances() {
  places_.resize(scene_.bodies.size());
  std::vector<RTCScene> shapes;
  for (const CompiledBody& body : scene_.bodies) shapes.push_back(body.embree.get());
  for (const auto& own : deforming_) shapes[own->body] = own->embree.get();
  for (std::uint32_t i = 0; i < shapes.size(); ++i) {
    EmbreeGeometry& instance =
        instances_.emplace_back(rtcNewGeometry(scene_.device.get(), RTC_GEOMETRY_TYPE_INSTANCE));
    rtcSetGeometryInstancedScene(instance.get(), shapes[i]);
    rtcSetGeometryTimeStepCount(instance.get(), 1);
    rtcAttachGeometryByID(own_embree_.get(), instance.get(), i);
  }
}

void Pose::place_lights(double time) {
  if (scene_.light_nodes.empty()) return;
  const std::vector<Placement> nodes = placements_at(scene_.movement, time);
  for (std::size_t i = 0; i < own_lights_.size(); ++i) {
    const LightNode& at = scene_.light_nodes[i];
    if (at.node == 0 && at.track.empty()) continue;
    const auto moved = track_at(scene_.movement, at.track, time);
    Light light = scene_.lights_in_nodes[i];
    if (moved) light.position = moved->to_parent.origin;
    own_lights_[i].position = compiled_place(light, nodes[at.node].to_parent, scene_.normalisation);
  }
}

void Pose::note_changes(const std::vector<BodyPlace>& before,
                        const std::vector<ShadingLight>& lights_before) {
  swept_.clear();
  all_swept_.makeEmpty();
  moved_by_.assign(places_.size(), {});
  has_moved_.assign(places_.size(), false);
  for (std::size_t i = 1; i < places_.size(); ++i) {
    const BodyPlace &then = before[i], &now = places_[i];
    const bool deforms = scene_.bodies[i].deforms;
    if (then.is_shown == now.is_shown && then.to_world == now.to_world && !deforms) continue;
    has_moved_[i] = true;
    moved_by_[i] = now.to_world * then.from_world;
    for (const BodyPlace* at : {&then, &now}) {
      if (!at->is_shown) continue;
      swept_.push_back(mapped(at->to_world, scene_.bodies[i].box));
      all_swept_.extendBy(swept_.back());
    }
  }
  lights_moved_ = 0, any_light_moved_ = false;
  for (std::size_t i = 0; i < own_lights_.size(); ++i) {
    if (own_lights_[i].position == lights_before[i].position) continue;
    any_light_moved_ = true;
    if (i < std::size_t{kNotedLights}) lights_moved_ = static_cast<std::uint8_t>(lights_moved_ | 1U << i);
  }
}

bool Pose::may_be_crossed(const Vec3d& from, const Vec3d& to) const {
  const Vec3d step = to - from;
  return crosses(all_swept_, from, step) && std::any_of(swept_.begin(), swept_.end(), [&](const Box3d& box) {
           return crosses(box, from, step);
         });
}

Carried Pose::carry(RaySample& sample) const {
  if (!scene_.moves || sample.at_infinity || sample.primitive == 0) return Carried::kKept;
  const std::uint32_t number = sample.primitive - 1 < scene_.part_of_primitive.size()
                                   ? scene_.part_of_primitive[sample.primitive - 1]
                                   : kNoPart;
  if (number == kNoPart) return Carried::kNothing;
  const std::uint32_t body = scene_.parts[number].body;
  if (body != 0 && has_moved_[body]) {
    if (scene_.bodies[body].deforms || !places_[body].is_shown) return Carried::kNothing;
    sample.hit = Vec3f(moved_by_[body].point(Vec3d(sample.hit)));
    sample.eye_dependent = true;
    sample.lights = {};
    return any_light_moved_ ? Carried::kRelit : Carried::kKept;
  }
  const std::uint8_t changed = lights_changed_at(sample) & sample.lights.asked;
  const bool is_relit = changed != 0 || any_light_moved_ || is_unnoted_light_changed_at(sample);
  sample.lights.asked = static_cast<std::uint8_t>(sample.lights.asked & ~changed);
  sample.lights.seen = static_cast<std::uint8_t>(sample.lights.seen & ~changed);
  return is_relit ? Carried::kRelit : Carried::kKept;
}

// Samples do not note these lights. Any of them may shine on the surface.
bool Pose::is_unnoted_light_changed_at(const RaySample& sample) const {
  if (swept_.empty()) return false;
  const Vec3d hit(sample.hit);
  for (std::size_t i = kNotedLights; i < lights_.size(); ++i) {
    if (may_be_crossed(hit, lights_[i].position)) return true;
  }
  return false;
}

// Returns the lights, of the first eight, that may be seen at a sample now and were not then, or the reverse.
std::uint8_t Pose::lights_changed_at(const RaySample& sample) const {
  std::uint8_t changed = lights_moved_;
  if (swept_.empty()) return changed;
  const Vec3d hit(sample.hit);
  for (std::size_t i = 0; i < std::min(lights_.size(), std::size_t{kNotedLights}); ++i) {
    const auto bit = static_cast<std::uint8_t>(1U << i);
    if ((sample.lights.asked & bit) != 0 && may_be_crossed(hit, lights_[i].position))
      changed = static_cast<std::uint8_t>(changed | bit);
  }
  return changed;
}

}  // namespace pprt
