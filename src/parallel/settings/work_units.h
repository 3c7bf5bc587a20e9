// The work clock's prices (docs/decisions/0006-work-clock.md). The paper has no such clock.
#pragma once

#include <cstdint>

#include "pipeline/casting/cast_choice.h"
#include "pipeline/sampling/sampler_traits.h"

namespace pprt {

// One unit is a nanosecond of one core of the machine that the prices were measured on.
using WorkUnits = std::uint64_t;

enum class Work : std::uint8_t {
  kRay,             // a ray of any kind, its share of shading included
  kOwnSample,       // choosing a point, inserting a sample traced here, queueing and painting its triangles
  kUpdateRule,      // finding the ranks that a new triangle at the border concerns
  kReceivedSample,  // decoding and inserting another rank's sample, painting its triangles
  kSentSample,      // encoding, per sample and receiver
  kOwnNode,         // as kOwnSample, on a lattice
  kReceivedNode,    // as kReceivedSample, on a lattice
  kPixel,           // of reconstruction: what a pixel costs beside the triangles
  kComparedPixel,   // comparing a pixel with itself earlier, by FLIP
  kCastSample,      // projecting and testing one sample of the frame before
  kKeptNode,        // keeping one of them for the nodes near it
  kKeptSample       // reinserting one of them, queueing and painting its triangles
};

constexpr WorkUnits price(Work work) {
  switch (work) {
    case Work::kRay:
      return 110;
    case Work::kOwnSample:
      return 705;
    case Work::kUpdateRule:
      return 110;
    case Work::kReceivedSample:
      return 580;
    case Work::kSentSample:
      return 20;
    case Work::kOwnNode:
      return 370;
    case Work::kReceivedNode:
      return 200;
    case Work::kPixel:
      return 5;
    case Work::kComparedPixel:
      return 200;
    case Work::kCastSample:
      return 20;
    case Work::kKeptNode:
      return 40;
    case Work::kKeptSample:
      return 805;
  }
  return 0;
}

// What a sampler does with a sample: one that is traced here, another rank's, and one that was cast.
struct SampleWork {
  Work own, received, kept;
};

constexpr SampleWork work_of(const SamplerTraits& traits) {
  switch (traits.store) {
    case SampleStore::kTriangulation:
      return {Work::kOwnSample, Work::kReceivedSample, Work::kKeptSample};
    case SampleStore::kLattice:
      break;
  }
  return {Work::kOwnNode, Work::kReceivedNode, Work::kKeptNode};
}

// What the choice of casting compares on this clock.
constexpr CastPrices cast_prices() {
  return {
      .cast = static_cast<double>(price(Work::kCastSample) + price(Work::kRay) + price(Work::kKeptSample)),
      .fresh = static_cast<double>(price(Work::kOwnSample)),
      .ray = static_cast<double>(price(Work::kRay))};
}

// Speed of the virtual processor, work units a second: a twentieth of the machine measured, so that 32 of
// them fit on two cores. --budget overrides the frame budget that follows from it.
inline constexpr double kWorkUnitsPerSecond = 5e7;

// Rounds in the sampling time of a frame with a rate; messages are delivered between them.
inline constexpr int kRoundsPerFrame = 24;

// Work units of a round in frames without a rate.
inline constexpr WorkUnits kUnitsPerFreeRound = 250'000;

}  // namespace pprt
