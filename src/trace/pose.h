// Where a scene's bodies stand at one time, for one tracer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/affine.h"
#include "base/vector.h"
#include "trace/scene_impl.h"

namespace pprt {

// A body in its place: the map from its compiled space to the world's, as Embree has it, in float.
struct BodyPlace {
  Affine to_world, from_world;
  // How far rays may miss it in the world, relative to sums of coordinates. See numerics.h.
  double rounding = 0;
  // Sum of the coordinates of its origin in the world.
  double distance = 0;
  bool is_shown = true;

  // Takes a gradient, or a normal, to the world's space: by the inverse transpose.
  Vec3d gradient(const Vec3d& v) const {
    return {from_world.x.dot(v), from_world.y.dot(v), from_world.z.dot(v)};
  }
};

// A scene at rest is one pose, which reads the compiled scene. Where bodies move, Embree's instances of them
// and the triangles that change their shape belong to the pose.
class Pose {
 public:
  // `scene` must outlive it. The time is the movement's first.
  explicit Pose(const CompiledScene::Impl& scene);
  ~Pose();
  Pose(const Pose&) = delete;
  Pose& operator=(const Pose&) = delete;

  // Moves all bodies and lights to their places at a time, seconds. Returns whether any of them has moved or
  // changed its shape.
  bool set_time(double time);

  const CompiledScene::Impl& scene() const { return scene_; }
  RTCScene embree() const { return embree_; }
  std::span<const ShadingLight> lights() const { return lights_; }

  // A part as it is now.
  const ScenePart& part(std::uint32_t number) const {
    return deformed_.empty() || !deformed_[number] ? scene_.parts[number] : *deformed_[number];
  }
  // Where a part's body stands; null: in the world.
  const BodyPlace* place_of(const ScenePart& part) const {
    return part.body == 0 ? nullptr : &places_[part.body];
  }
  // Largest relative rounding of all bodies' places.
  double rounding() const { return rounding_; }

  // Carries a sample from the pose before into this one; see Tracer::carry.
  Carried carry(RaySample& sample) const;

 private:
  struct Deforming;  // triangles that change their shape

  void place_bodies(double time);
  void deform(Deforming& own, double time) const;
  void add_instances();
  void place_lights(double time);
  void note_changes(const std::vector<BodyPlace>& before, const std::vector<ShadingLight>& lights_before);
  std::uint8_t lights_changed_at(const RaySample& sample) const;
  bool is_unnoted_light_changed_at(const RaySample& sample) const;
  bool may_be_crossed(const Vec3d& from, const Vec3d& to) const;

  const CompiledScene::Impl& scene_;
  RTCScene embree_ = nullptr;
  std::span<const ShadingLight> lights_;

  std::vector<ShadingLight> own_lights_;  // if lights move
  std::vector<BodyPlace> places_;         // by body
  std::vector<EmbreeGeometry> instances_;
  std::vector<std::unique_ptr<Deforming>> deforming_;
  std::vector<const ScenePart*> deformed_;  // by part, if some deform
  EmbreeScene own_embree_;                  // destroyed first
  double rounding_ = 0;
  bool has_time_ = false;

  // Since the pose before.
  std::vector<Affine> moved_by_;  // by body, in the world
  std::vector<bool> has_moved_;   // by body
  std::vector<Box3d> swept_;      // by bodies that have moved or changed their shape, then and now
  Box3d all_swept_;
  std::uint8_t lights_moved_ = 0;  // bits as in SeenLights
  bool any_light_moved_ = false;
};

}  // namespace pprt
