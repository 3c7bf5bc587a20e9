// What methods make of one place of a picture in the same time, beside where a viewer sees them err.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "study/accuracy/methods.h"
#include "study/report/page.h"

namespace pprt {

// Budgets of the crops: shares of the time of one sample per pixel.
inline constexpr std::array kCropBudgets = {0.25, 1.0};

// Returns a row of crops for each budget: the converged picture, then for each method its picture and the map
// of its FLIP. They show where the last method errs most by FLIP at the first budget. A method without a
// picture in that time is left out.
std::vector<Picture> crops_at_equal_time(const std::string& scene, const Subject& subject,
                                         const Image& reference, std::span<const Method> methods,
                                         double one_sample_s, std::uint64_t seed);

}  // namespace pprt
