#include "scene/animation/object_motion.h"

#include <algorithm>
#include <cmath>

namespace pprt {
namespace {

double time_of(double frame, const FrameTimes& times) {
  if (times.frames <= 1) return times.start;
  return times.start + (frame - 1) * (times.end - times.start) / (times.frames - 1);
}

// Adds a key before the first and one behind the last that only shape the curve: as if it went on evenly.
void complete(std::vector<VectorKey>& keys) {
  if (keys.size() == 1) keys.push_back({keys[0].time + 1, keys[0].value, {}});
  const VectorKey &first = keys[0], &second = keys[1];
  const VectorKey &last = keys[keys.size() - 1], &before = keys[keys.size() - 2];
  const VectorKey ahead{2 * first.time - second.time, first.value * 2 - second.value, {}};
  const VectorKey behind{2 * last.time - before.time, last.value * 2 - before.value, {}};
  keys.insert(keys.begin(), ahead);
  keys.push_back(behind);
}

std::vector<VectorKey> curve(const ObjectMotion& object, const FrameTimes& times, Vec3d ObjectKey::*value) {
  std::vector<VectorKey> keys;
  for (const ObjectKey& key : object.keys) keys.push_back({time_of(key.frame, times), key.*value, key.shape});
  complete(keys);
  return keys;
}

// A turn about three axes as one: about x first.
RotationKey rotation_key(const Vec3d& degrees, double time) {
  const Affine map =
      rotation({0, 0, 1}, degrees.z) * rotation({0, 1, 0}, degrees.y) * rotation({1, 0, 0}, degrees.x);
  return rotation_key(time, map);
}

// A key at each frame, for turns between keys may be greater than a quaternion's.
std::vector<RotationKey> turns(const ObjectMotion& object, const FrameTimes& times) {
  const auto is_turned = [](const ObjectKey& key) { return key.rotate != Vec3d(0, 0, 0); };
  if (std::none_of(object.keys.begin(), object.keys.end(), is_turned)) return {};
  MotionTrack angles;
  angles.translation = curve(object, times, &ObjectKey::rotate);
  note_order(angles);
  std::vector<RotationKey> keys;
  const double step = times.frames > 1 ? (times.end - times.start) / (times.frames - 1) : 1;
  for (int frame = 0; frame < times.frames + 2; ++frame) {
    const double time = times.start + (frame - 1) * step;
    const int counted = std::clamp(frame - 1, 0, times.frames - 1);
    const double exact = counted == frame - 1 ? time_of_frame(times, counted) : time;
    keys.push_back(rotation_key(placement_at(angles, time_of_frame(times, counted)).to_parent.origin, exact));
  }
  if (keys.size() < kLeastCurveKeys)
    keys.push_back({keys.back().time + step, keys.back().axis, keys.back().degrees, {}});
  return keys;
}

}  // namespace

MotionTrack track_of(const ObjectMotion& object, const FrameTimes& times) {
  MotionTrack track;
  if (object.keys.empty()) return track;
  track.translation = curve(object, times, &ObjectKey::translate);
  track.scale = curve(object, times, &ObjectKey::scale);
  track.rotation = turns(object, times);
  for (const ObjectKey& key : object.keys)
    track.visibility.push_back({time_of(key.frame, times), key.visible});
  note_order(track);
  return track;
}

void add_moving(SceneDescription& scene, const SceneDescription& other, const std::string& name) {
  scene.nodes.resize(scene.order.size());
  const auto first_node = static_cast<NodeIndex>(scene.movement.nodes.size());
  scene.movement.nodes.push_back({.parent = 0, .to_parent = {}, .track = name, .location = {}});
  for (std::size_t i = 1; i < other.movement.nodes.size(); ++i) {
    SceneNode node = other.movement.nodes[i];
    node.parent += first_node;
    if (!node.track.empty()) node.track = name + "/" + node.track;
    scene.movement.nodes.push_back(std::move(node));
  }
  for (const auto& [own, track] : other.movement.tracks) scene.movement.tracks[name + "/" + own] = track;

  const auto first_texture = static_cast<TextureIndex>(scene.textures.size());
  scene.textures.insert(scene.textures.end(), other.textures.begin(), other.textures.end());
  const auto first_material = static_cast<MaterialIndex>(scene.materials.size());
  scene.materials.insert(scene.materials.end(), other.materials.begin(), other.materials.end());
  for (std::size_t i = first_material; i < scene.materials.size(); ++i) {
    for (auto* texture : {&scene.materials[i].texture, &scene.materials[i].emission_texture}) {
      if (*texture) **texture += first_texture;
    }
  }
  const auto first_mesh = static_cast<std::uint32_t>(scene.meshes.size());
  for (TriangleMesh mesh : other.meshes) {
    mesh.material += first_material, mesh.location = {};
    scene.meshes.push_back(std::move(mesh));
  }
  for (std::size_t place = 0; place < other.order.size(); ++place) {
    const PrimitiveRef ref = other.order[place];
    scene.nodes.push_back(first_node + node_of(other, place));
    switch (ref.kind) {
      case PrimitiveKind::kSphere: {
        Sphere s = other.spheres[ref.index];
        s.material += first_material, s.location = {};
        add_sphere(scene, s);
        break;
      }
      case PrimitiveKind::kCone: {
        Cone c = other.cones[ref.index];
        c.material += first_material, c.location = {};
        add_cone(scene, c);
        break;
      }
      case PrimitiveKind::kPolygon: {
        const Polygon& p = other.polygons[ref.index];
        add_polygon(scene, other.vertices(p), p.material + first_material);
        break;
      }
      case PrimitiveKind::kPatch: {
        const Patch& p = other.patches[ref.index];
        add_patch(scene, other.vertices(p), p.material + first_material);
        break;
      }
      case PrimitiveKind::kTriangle: {
        Triangle t = other.triangles[ref.index];
        t.mesh += first_mesh;
        scene.order.push_back({ref.kind, static_cast<std::uint32_t>(scene.triangles.size())});
        scene.triangles.push_back(t);
        break;
      }
      case PrimitiveKind::kMovingTriangle: {
        MovingTriangle t = other.moving_triangles[ref.index];
        t.material += first_material, t.location = {};
        add_moving_triangle(scene, std::move(t));
        break;
      }
    }
  }
}

}  // namespace pprt
