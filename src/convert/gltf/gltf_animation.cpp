#include "convert/gltf/gltf_animation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>

namespace pprt {
namespace {

using Quaternion = std::array<double, 4>;  // x, y, z, w

void set_value(VectorKey& key, const Quaternion& from) {
  key.value = Vec3d(from[0], from[1], from[2]);
}

void set_value(RotationKey& key, const Quaternion& from) {
  key.axis = Vec3d(from[0], from[1], from[2]);
  key.degrees = 2 * std::atan2(key.axis.length(), from[3]) * (180 / std::numbers::pi);
}

// Keys of a sampler; of curves with the tangents before and after them.
struct Curve {
  std::string interpolation;
  std::vector<double> times;
  GltfNumbers values;

  bool is_cubic() const { return interpolation == "CUBICSPLINE"; }
  Quaternion at(std::size_t element) const {
    Quaternion result{0, 0, 0, 0};
    for (std::size_t c = 0; c < std::min<std::size_t>(values.components, 4); ++c)
      result[c] = values.at(element, c);
    return result;
  }
  Quaternion key(std::size_t i) const { return at(is_cubic() ? 3 * i + 1 : i); }

  // Hermite's cubic, by the specification's appendix C.
  Quaternion between(double time) const {
    const auto after = std::upper_bound(times.begin(), times.end(), time);
    if (after == times.begin()) return key(0);
    if (after == times.end()) return key(times.size() - 1);
    const auto i = static_cast<std::size_t>(after - times.begin()) - 1;
    const double length = times[i + 1] - times[i], t = (time - times[i]) / length;
    const Quaternion from = key(i), leaving = at(3 * i + 2), reaching = at(3 * (i + 1)), to = key(i + 1);
    const double t2 = t * t, t3 = t2 * t;
    Quaternion result{};
    for (std::size_t c = 0; c < 4; ++c)
      result[c] = (2 * t3 - 3 * t2 + 1) * from[c] + length * (t3 - 2 * t2 + t) * leaving[c] +
                  (3 * t2 - 2 * t3) * to[c] + length * (t3 - t2) * reaching[c];
    return result;
  }
};

TrackValues values_of(const Quaternion& at, const VectorKey* /*kind*/) {
  TrackValues values;
  values.translation = Vec3d(at[0], at[1], at[2]);
  return values;
}

TrackValues values_of(const Quaternion& at, const RotationKey* /*kind*/) {
  RotationKey key;
  set_value(key, at);
  TrackValues values;
  values.rotation = rotation(key.axis, key.degrees);
  return values;
}

class GltfAnimationReader {
 public:
  GltfAnimationReader(const tinygltf::Model& model, const tinygltf::Animation& from,
                      const std::vector<std::string>& tracks, ModelLosses& losses)
      : model_(model), from_(from), names_(tracks), losses_(losses) {}

  ModelAnimation run(const std::vector<GltfFacts::Pointer>& pointers) {
    for (const tinygltf::AnimationChannel& channel : from_.channels) {
      if (channel.target_path == "weights") losses_.add(ModelLoss::kShapeMovement);
      if (channel.target_node >= 0) placement(channel);
    }
    for (const GltfFacts::Pointer& channel : pointers) pointer(channel);
    for (const int node : placed_) complete(node);
    for (auto& [name, track] : result_.tracks) note_order(track);
    result_.times = span_.frames(result_.notes);
    return std::move(result_);
  }

 private:
  Curve curve_of(int place, std::size_t components) const {
    const tinygltf::AnimationSampler& sampler = element(from_.samplers, place, "a sampler");
    Curve curve{sampler.interpolation, numbers(model_, sampler.input).values,
                numbers(model_, sampler.output)};
    const std::size_t wanted = curve.times.size() * (curve.is_cubic() ? 3 : 1);
    if (curve.times.empty() || curve.values.components != components || curve.values.size() < wanted)
      throw std::runtime_error("its animation has fewer values than times");
    for (const double time : curve.times) require_usable(VectorKey{.time = time});
    return curve;
  }

  MotionTrack& track_of(int node) { return result_.tracks[element(names_, node, "a node")]; }

  void placement(const tinygltf::AnimationChannel& channel) {
    element(model_.nodes, channel.target_node, "a node");
    const std::string& path = channel.target_path;
    if (path != "translation" && path != "rotation" && path != "scale") return;
    MotionTrack& track = track_of(channel.target_node);
    placed_.insert(channel.target_node);
    if (path == "rotation") {
      keys(curve_of(channel.sampler, 4), track.rotation);
    } else {
      keys(curve_of(channel.sampler, 3), path == "scale" ? track.scale : track.translation);
    }
  }

  template <typename Key>
  void keys(const Curve& curve, std::vector<Key>& to) {
    if (!to.empty()) return;  // moved twice
    const auto add = [&](double time, const Quaternion& value) {
      Key& key = to.emplace_back();
      key.time = time;
      set_value(key, value);
      require_usable(key);
    };
    if (curve.is_cubic()) {
      const auto values_at = [&](double time) { return values_of(curve.between(time), to.data()); };
      for (std::size_t i = 0; i < curve.times.size(); ++i) add(curve.times[i], curve.key(i));
      to.clear();
      for (const double time : straight_times(curve.times, values_at)) add(time, curve.between(time));
    } else {
      for (std::size_t i = 0; i < curve.times.size(); ++i) {
        if (i > 0 && curve.interpolation == "STEP") add(curve.times[i], curve.key(i - 1));  // until then
        add(curve.times[i], curve.key(i));
      }
    }
    join(to, span_);
  }

  // What a track does not move stays as the node has it.
  void complete(int node) {
    const TrackValues rest = gltf_placement(model_.nodes[static_cast<std::size_t>(node)]);
    MotionTrack& track = track_of(node);
    KeySpan none;
    if (track.translation.empty()) track.translation = {{0, rest.translation}}, join(track.translation, none);
    if (track.scale.empty()) track.scale = {{0, rest.scale}}, join(track.scale, none);
    if (track.rotation.empty()) track.rotation = {rotation_key(0, rest.rotation)}, join(track.rotation, none);
  }

  // Of what a pointer can move, whether a node is shown.
  void pointer(const GltfFacts::Pointer& channel) {
    const std::string begin = "/nodes/", end = "/extensions/KHR_node_visibility/visible";
    const std::string& path = channel.target;
    const std::string number = path.starts_with(begin) && path.ends_with(end)
                                   ? path.substr(begin.size(), path.size() - begin.size() - end.size())
                                   : "";
    if (number.empty() || number.size() > 9 || number.find_first_not_of("0123456789") != std::string::npos)
      return losses_.add(ModelLoss::kOtherMovement);
    const int node = std::stoi(number);
    element(model_.nodes, node, "a node");
    const Curve curve = curve_of(channel.sampler, 1);
    MotionTrack& track = track_of(node);
    placed_.insert(node);
    track.visibility.clear();
    for (std::size_t i = 0; i < curve.times.size(); ++i) {
      track.visibility.push_back({curve.times[i], curve.values.at(i, 0) != 0});
      span_.add(curve.times[i]);
    }
  }

  const tinygltf::Model& model_;
  const tinygltf::Animation& from_;
  const std::vector<std::string>& names_;
  ModelLosses& losses_;
  ModelAnimation result_;
  std::set<int> placed_;  // nodes that have a track
  KeySpan span_;
};

}  // namespace

ModelAnimation gltf_animation(const tinygltf::Model& model, const GltfFacts& facts, const std::string& name,
                              const std::vector<std::string>& tracks, ModelLosses& losses) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < model.animations.size(); ++i) {
    const std::string& own = model.animations[i].name;
    names.push_back(own.empty() ? "animation" + std::to_string(i + 1) : own);
  }
  const std::size_t taken = animation_called(names, name);
  if (names.empty()) return {};
  std::vector<GltfFacts::Pointer> pointers = facts.pointers;
  std::erase_if(pointers, [&](const GltfFacts::Pointer& channel) { return channel.animation != taken; });
  ModelAnimation result = GltfAnimationReader(model, model.animations[taken], tracks, losses).run(pointers);
  if (names.size() > 1) result.notes.insert(result.notes.begin(), animation_taken(names, taken));
  return result;
}

TrackValues gltf_placement(const tinygltf::Node& node) {
  TrackValues values;
  const auto vector = [](const std::vector<double>& from, const Vec3d& otherwise) {
    return from.size() == 3 ? Vec3d(from[0], from[1], from[2]) : otherwise;
  };
  values.translation = vector(node.translation, values.translation);
  values.scale = vector(node.scale, values.scale);
  if (node.rotation.size() == 4) {
    RotationKey key;
    set_value(key, {node.rotation[0], node.rotation[1], node.rotation[2], node.rotation[3]});
    values.rotation = rotation(key.axis, key.degrees);
  }
  return values;
}

}  // namespace pprt
