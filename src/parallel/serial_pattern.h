// How far a sample pattern is from the one that the serial sampler would have made (paper s. 6.2).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/probe.h"
#include "parallel/master/master.h"
#include "parallel/settings/session_settings.h"
#include "pipeline/core/sample.h"
#include "pipeline/core/tile_grid.h"

namespace pprt {

// Side of the squares in which samples are counted, pixels.
inline constexpr int kBucketPixels = 10;

// Returns the sum over buckets of the difference of the two patterns' counts, as a share of all samples of
// both. 0: every bucket holds as many of one as of the other, or there are no samples. 1: no bucket holds
// samples of both.
double bucket_distance(std::span<const Sample> a, std::span<const Sample> b);

// Returns the number of samples that lie at most `reach` pixels to the side of, above or below a border
// between regions. `owners`: the frame's, per tile.
std::size_t samples_near_borders(std::span<const Sample> samples, const TileGrid& grid,
                                 std::span<const std::int32_t> owners, double reach);

// Returns the frame of one rank that samples the camera's image afresh until it holds `count` samples, its
// seeds included; its samples alone. Uses the settings' size, seed, weights and pixel rule only. `time`: of
// what moves in the scene, seconds. The probe is left looking from `camera` at that time.
FinishedFrame serial_frame(const SessionSettings& settings, const Camera& camera, double time,
                           std::uint64_t count, const Probe& probe);
std::vector<Sample> serial_samples(const SessionSettings& settings, const Camera& camera, double time,
                                   std::uint64_t count, const Probe& probe);

// Returns bucket_distance() of a frame's samples to as many of the serial sampler's. The settings must have
// asked for the samples.
double distance_to_serial(const FinishedFrame& frame, const SessionSettings& settings, const Probe& probe);

}  // namespace pprt
