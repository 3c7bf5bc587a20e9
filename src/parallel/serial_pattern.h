// How far a sample pattern is from the one that the serial sampler would have made (paper s. 6.2).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/probe.h"
#include "parallel/master.h"
#include "parallel/session_settings.h"
#include "pipeline/sample.h"
#include "pipeline/tile_grid.h"

namespace pprt {

// Side of the squares in which samples are counted, pixels.
inline constexpr int kBucketPixels = 10;

// The sum over buckets of the difference of the two patterns' counts, as a share of all samples of both: 0
// where every bucket holds as many of one as of the other, 1 where none holds samples of both. 0 for two
// patterns without samples.
double bucket_distance(std::span<const Sample> a, std::span<const Sample> b);

// How many of the samples lie at most `reach` pixels to the side of, above or below a border between regions;
// `owners` are the frame's, per tile.
std::size_t samples_near_borders(std::span<const Sample> samples, const TileGrid& grid,
                                 std::span<const std::int32_t> owners, double reach);

// The pattern of one rank that samples the camera's image afresh until it holds `count` samples, its seeds
// included. Of the settings only size, seed, weights and the pixels' rule, which what is learned
// depends on, count. The probe is left looking from `camera`.
std::vector<Sample> serial_samples(const SessionSettings& settings, const Camera& camera, std::uint64_t count,
                                   const Probe& probe);

// bucket_distance() of a frame's samples, which the settings must have asked for, to as many of the serial
// sampler's.
double distance_to_serial(const FinishedFrame& frame, const SessionSettings& settings, const Probe& probe);

}  // namespace pprt
