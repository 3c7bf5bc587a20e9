#include "convert/mesh/mesh_animation.h"

#include <assimp/anim.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "convert/mesh/assimp_values.h"
#include "scene/movement/movement_limits.h"
#include "scene/movement/straight_track.h"

namespace pprt {
namespace {

constexpr double kFramesPerSecond = 24;
constexpr double kRounding = 1e-3;      // of a frame: times are floats
constexpr double kTicksPerSecond = 25;  // where a file does not tell

void set_value(VectorKey& key, const aiVectorKey& from) {
  key.value = to_vector(from.mValue);
}

void set_value(RotationKey& key, const aiQuatKey& from) {
  const aiQuaternion& q = from.mValue;
  key.axis = Vec3d(q.x, q.y, q.z);
  key.degrees = 2 * std::atan2(key.axis.length(), q.w) * (180 / std::numbers::pi);
}

bool is_usable(const VectorKey& key) {
  return is_in_range(key.time) && is_in_range(key.value);
}

bool is_usable(const RotationKey& key) {
  return is_in_range(key.time) && is_in_range(key.degrees) && is_in_range(key.axis);
}

class AnimationReader {
 public:
  explicit AnimationReader(const aiScene& from) : from_(from) {}

  MeshAnimation run() {
    std::size_t repeated = 0, others = 0;
    for (unsigned i = 0; i < from_.mNumAnimations; ++i) {
      const aiAnimation& animation = *from_.mAnimations[i];
      seconds_ = 1 / (animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : kTicksPerSecond);
      for (unsigned c = 0; c < animation.mNumChannels; ++c) repeated += !channel(*animation.mChannels[c]);
      others += animation.mNumMeshChannels + animation.mNumMorphMeshChannels;
    }
    if (repeated > 0) {
      result_.notes.push_back(std::to_string(repeated) +
                              " movements of nodes that another animation moves: left out");
    }
    if (others > 0)
      result_.notes.push_back(std::to_string(others) + " movements that change a mesh's shape: left out");
    if (last_ > first_) set_times();
    return std::move(result_);
  }

 private:
  void set_times() {
    const double wanted = std::ceil((last_ - first_) * kFramesPerSecond - kRounding) + 1;
    const double frames = std::min(wanted, double{kMostFrames});
    result_.times = {.start = first_, .end = last_, .frames = static_cast<int>(frames)};
    if (frames < wanted)
      result_.notes.push_back("it would have more than " + std::to_string(kMostFrames) +
                              " frames at 24 a second: these are further apart");
  }

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
      if (!is_usable(key)) throw std::runtime_error("a key of its animation is not finite, or beyond 1e100");
    }
    if (to.empty()) return;
    std::stable_sort(to.begin(), to.end(), [](const Key& a, const Key& b) { return a.time < b.time; });
    first_ = std::min(first_, to.front().time), last_ = std::max(last_, to.back().time);
    make_straight(to);
  }

  const aiScene& from_;
  MeshAnimation result_;
  double seconds_ = 1;  // a tick
  double first_ = std::numeric_limits<double>::infinity(), last_ = -first_;
};

aiQuaternion to_quaternion(const Affine& turn) {
  const RotationKey key = rotation_key(0, turn);
  const double half = key.degrees * (std::numbers::pi / 360);
  const Vec3d axis = key.axis.normalized() * std::sin(half);
  return {static_cast<float>(std::cos(half)), static_cast<float>(axis.x), static_cast<float>(axis.y),
          static_cast<float>(axis.z)};
}

}  // namespace

MeshAnimation read_animation(const aiScene& from) {
  return AnimationReader(from).run();
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
