// The words for the choices in SessionSettings, as options, ledger and pages of studies spell them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/words.h"
#include "parallel/settings/session_settings.h"

namespace pprt {

template <>
inline constexpr std::array<Word<ClockKind>, 2> kWords<ClockKind>{{
    {ClockKind::kWall, "wall", "real time"},
    {ClockKind::kWork, "work", "counted work, the same result under any load"},
}};

template <>
inline constexpr std::array<Word<BalanceMode>, 4> kWords<BalanceMode>{{
    {BalanceMode::kNone, "none", "equal areas for the whole run"},
    {BalanceMode::kLocal, "local", "tiles move between neighbours during a frame"},
    {BalanceMode::kGlobal, "global", "a repartition after every frame"},
    {BalanceMode::kCombined, "combined", "local, and global when ranks differ much"},
}};

template <>
inline constexpr std::array<Word<CastChoice>, 4> kWords<CastChoice>{{
    {CastChoice::kOff, "off", "every frame starts anew"},
    {CastChoice::kPaper, "paper", "samples that pass the test of the paper"},
    {CastChoice::kVerified, "verified", "samples that a ray finds visible"},
    {CastChoice::kAuto, "auto", "whichever pays off"},
}};

template <>
inline constexpr std::array<Word<SamplerChoice>, kSamplerChoices.size()> kWords<SamplerChoice>{{
#define PPRT_WORD(choice, word, help, ...) {SamplerChoice::choice, word, help},
    PPRT_SAMPLERS(PPRT_WORD, PPRT_WORD)
#undef PPRT_WORD
}};

template <>
inline constexpr std::array<Word<PixelRule>, 4> kWords<PixelRule>{{
    {PixelRule::kEdges, "edges", "mean over the area, with edges of objects"},
    {PixelRule::kArea, "area", "mean over the area"},
    {PixelRule::kMean, "mean", "mean of the samples, as in the paper"},
    {PixelRule::kCenter, "center", "the value at the centre"},
}};

// A value that has no word, or that is not read back, is one that was forgotten here or in kLast.
template <typename E>
inline constexpr bool kHasAllWords = kWords<E>.size() == static_cast<std::size_t>(kLast<E>) + 1;
static_assert(kHasAllWords<ClockKind> && kHasAllWords<BalanceMode> && kHasAllWords<CastChoice> &&
              kHasAllWords<PixelRule>);

// SessionSettings::learned_weights, spelt out.
enum class WeightRule : std::uint8_t { kLearned, kPaper };

template <>
inline constexpr std::array<Word<WeightRule>, 2> kWords<WeightRule>{{
    {WeightRule::kLearned, "learned", "weights corrected by the errors found"},
    {WeightRule::kPaper, "paper", "weights of the paper"},
}};

inline WeightRule weight_rule(const SessionSettings& settings) {
  return settings.learned_weights ? WeightRule::kLearned : WeightRule::kPaper;
}

}  // namespace pprt
