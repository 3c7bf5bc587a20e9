#include "convert/mesh/mesh_animation.h"

#include <assimp/anim.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "convert/mesh/assimp_values.h"
#include "convert/model/model_losses.h"
#include "scene/movement/straight_track.h"

namespace pprt {
namespace {

constexpr double kTicksPerSecond = 25;  // where a file does not tell

void set_value(VectorKey& key, const aiVectorKey& from) {
  key.value = to_vector(from.mValue);
}

void set_value(RotationKey& key, const aiQuatKey& from) {
  const aiQuaternion& q = from.mValue;
  key.axis = Vec3d(q.x, q.y, q.z);
  key.degrees = 2 * std::atan2(key.axis.length(), q.w) * (180 / std::numbers::pi);
}

class AnimationReader {
 public:
  explicit AnimationReader(const aiScene& from) : from_(from) {}

  ModelAnimation run(const std::string& name) {
    std::vector<std::string> names;
    for (unsigned i = 0; i < from_.mNumAnimations; ++i)
      names.emplace_back(from_.mAnimations[i]->mName.C_Str());
    const std::size_t taken = animation_called(names, name);
    std::size_t repeated = 0, others = 0;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!name.empty() && i != taken) continue;
      const aiAnimation& animation = *from_.mAnimations[i];
      seconds_ = 1 / (animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : kTicksPerSecond);
      for (unsigned c = 0; c < animation.mNumChannels; ++c) repeated += !channel(*animation.mChannels[c]);
      others += animation.mNumMeshChannels + animation.mNumMorphMeshChannels;
    }
    ModelLosses losses;
    losses.add(ModelLoss::kRepeatedMovement, repeated);
    losses.add(ModelLoss::kShapeMovement, others);
    losses.tell(result_.notes);
    result_.times = span_.frames(result_.notes);
    return std::move(result_);
  }

 private:
  // Returns false for a node that has a track.
  bool channel(const aiNodeAnim& from) {
    const auto [found, is_new] = result_.tracks.try_emplace(from.mNodeName.C_Str());
    if (!is_new) return false;
    MotionTrack& track = found->second;
    keys(from.mPositionKeys, from.mNumPositionKeys, track.translation);
    keys(from.mRotationKeys, from.mNumRotationKeys, track.rotation);
    keys(from.mScalingKeys, from.mNumScalingKeys, track.scale);
    note_order(track);
    return true;
  }

  template <typename From, typename Key>
  void keys(const From* from, unsigned count, std::vector<Key>& to) {
    for (unsigned i = 0; i < count; ++i) {
      Key& key = to.emplace_back();
      key.time = from[i].mTime * seconds_;
      set_value(key, from[i]);
      require_usable(key);
    }
    if (!to.empty()) join(to, span_);
  }

  const aiScene& from_;
  ModelAnimation result_;
  double seconds_ = 1;  // a tick
  KeySpan span_;
};

aiQuaternion to_quaternion(const Affine& turn) {
  const RotationKey key = rotation_key(0, turn);
  const double half = key.degrees * (std::numbers::pi / 360);
  const Vec3d axis = key.axis.normalized() * std::sin(half);
  return {static_cast<float>(std::cos(half)), static_cast<float>(axis.x), static_cast<float>(axis.y),
          static_cast<float>(axis.z)};
}

}  // namespace

ModelAnimation read_animation(const aiScene& from, const std::string& name) {
  return AnimationReader(from).run(name);
}

std::unique_ptr<aiNodeAnim> node_animation(std::vector<double> times,
                                           const std::function<TrackValues(double)>& values_at,
                                           const std::string& node, double start) {
  const auto shown_at = [&](double time) {
    TrackValues values = values_at(time);
    if (!values.visible) values.scale = Vec3d(0, 0, 0);
    return values;
  };
  times = straight_times(std::move(times), shown_at);
  auto result = std::make_unique<aiNodeAnim>();
  result->mNodeName = node;
  const auto count = static_cast<unsigned>(times.size());
  result->mNumPositionKeys = result->mNumRotationKeys = result->mNumScalingKeys = count;
  result->mPositionKeys = new aiVectorKey[count];
  result->mRotationKeys = new aiQuatKey[count];
  result->mScalingKeys = new aiVectorKey[count];
  for (unsigned i = 0; i < count; ++i) {
    const TrackValues values = shown_at(times[i]);
    // The files' times are floats, and no two keys have the same.
    const auto next = static_cast<float>(i + 1 < count ? times[i + 1] - start : times[i] - start + 1);
    const double time = std::min<double>(times[i] - start, std::nextafter(next, -1.F));
    result->mPositionKeys[i] = {time, to_assimp(values.translation)};
    result->mRotationKeys[i] = {time, to_quaternion(values.rotation)};
    result->mScalingKeys[i] = {time, to_assimp(values.scale)};
  }
  return result;
}

}  // namespace pprt
