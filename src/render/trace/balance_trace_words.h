// Words of the balancing trace, for its writer and its reader.
#pragma once

#include "base/words.h"
#include "parallel/protocol/messages.h"

namespace pprt {

template <>
inline constexpr std::array<Word<Carry>, 5> kWords<Carry>{{
    {Carry::kNothing, "nothing", "a new picture"},
    {Carry::kAccumulate, "accumulate", "the camera rests"},
    {Carry::kCastPaper, "cast-paper", "samples that pass the test of the paper"},
    {Carry::kCastVerified, "cast-verified", "samples that a ray finds visible"},
    {Carry::kCastWherePaying, "cast-auto", "those of them that pay off"},
}};

}  // namespace pprt
