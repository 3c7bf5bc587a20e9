// Settings of one run, equal on all ranks.
#pragma once

#include <array>
#include <cstdint>

#include "base/wire.h"
#include "parallel/settings/machine.h"
#include "parallel/settings/sampler_list.h"
#include "parallel/settings/work_units.h"
#include "pipeline/core/pixel_block.h"

namespace pprt {

enum class ClockKind : std::uint8_t {
  kWall,  // real time
  kWork   // counted work: the result depends on scene, script, ranks, budget and seed alone
};

// How the samples of one frame serve the next while the camera moves; while it rests they accumulate unless
// kOff.
enum class CastChoice : std::uint8_t { kOff, kPaper, kVerified, kAuto };

// What chooses a frame's samples and makes pixels of them: on a lattice kAuto and kGrid, on a triangulation
// kDelaunay, which is the paper's.
#define PPRT_CHOICE(choice, ...) choice,
enum class SamplerChoice : std::uint8_t { PPRT_SAMPLERS(PPRT_CHOICE, PPRT_CHOICE) };
#undef PPRT_CHOICE
#define PPRT_CHOICE(choice, ...) SamplerChoice::choice,
inline constexpr std::array kSamplerChoices = {PPRT_SAMPLERS(PPRT_CHOICE, PPRT_CHOICE)};
#undef PPRT_CHOICE

// A sampler that must be named: SessionSettings without one do not compile. The samplers keep different
// promises, so a default would hide which of them a run or a test is about.
class NamedSampler {
 public:
  constexpr NamedSampler(SamplerChoice choice) : choice_(choice) {}
  constexpr operator SamplerChoice() const { return choice_; }
  SamplerChoice& choice() { return choice_; }
  const SamplerChoice& choice() const { return choice_; }

 private:
  SamplerChoice choice_;
};

// How load is shared among ranks (paper s. 3.6, 4.4, 4.5).
enum class BalanceMode : std::uint8_t {
  kNone,
  kLocal,    // tiles move between neighbours during a frame
  kGlobal,   // the image is repartitioned after every frame, in force two frames later
  kCombined  // local, and global when the imbalance is great
};

// When a frame is good enough: at the first of these that is reached; 0 means no such limit. With a rate the
// deadline ends frames, and `rmse` may end them before.
struct StopRules {
  double seconds = 0;         // wall clock: elapsed; work clock: work units / kWorkUnitsPerSecond
  std::uint64_t samples = 0;  // in the whole image; each rank takes the share of its pixels
  double flip = 0;            // estimated mean FLIP of a rank's region
  double rmse = 0;            // measured, of the whole picture; with a rate: it ends frames early
  double weight = 0;          // mean weight of what a rank may still refine, smaller is better

  friend bool operator==(const StopRules&, const StopRules&) = default;
};

struct SessionSettings {
  std::int32_t width = 512;
  std::int32_t height = 512;
  ClockKind clock = ClockKind::kWall;
  double frames_per_second = 0;    // 0: no rate, the stop rules end a frame
  std::uint64_t budget_units = 0;  // work clock, with a rate: per rank and frame
  StopRules stop = {};
  BalanceMode balance = BalanceMode::kCombined;
  CastChoice cast = CastChoice::kAuto;
  bool keep_samples =
      true;  // on a repartition: hand samples over, instead of dropping them as the paper does
  PixelRule pixel_rule = PixelRule::kEdges;
  NamedSampler sampler;         // has no default
  bool learned_weights = true;  // refinement corrects the paper's weights by what it learns
  std::uint64_t seed = 1;
  bool is_still = false;          // there is one frame
  bool report_samples = false;    // every sample of a frame comes to the master with the pixels
  bool measures_error = false;    // probes measure how wrong each frame is; the picture is the same
  bool awaits_all = false;        // with a rate: frames are whole, be it late
  double probe_share = 0.01;      // of the eye rays, for the measurement
  bool report_transfers = false;  // tile transfers come to the master, before the pixels
  // A frame's camera is asked for when rank 0 has done its part of the frame before, not a frame ahead. Then
  // the picture follows the camera at once, and ranks may have to wait for rank 0.
  bool late_orders = false;
  Machine machine = {};  // of the work clock

  friend bool operator==(const SessionSettings&, const SessionSettings&) = default;
};

template <>
inline constexpr ClockKind kLast<ClockKind> = ClockKind::kWork;
template <>
inline constexpr CastChoice kLast<CastChoice> = CastChoice::kAuto;
template <>
inline constexpr SamplerChoice kLast<SamplerChoice> = kSamplerChoices.back();
template <>
inline constexpr BalanceMode kLast<BalanceMode> = BalanceMode::kCombined;
template <>
inline constexpr PixelRule kLast<PixelRule> = PixelRule::kEdges;

// For the master's broadcast.
Bytes encode(const SessionSettings& settings);
SessionSettings decode_settings(const Bytes& bytes);

}  // namespace pprt
