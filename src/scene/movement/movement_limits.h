// How much movement a scene may have: what files may hold when they are read, and what is written.
#pragma once

namespace pprt {

inline constexpr int kMostFrames = 1'000'000;
inline constexpr int kMostTransforms = 4096;  // in each other

}  // namespace pprt
