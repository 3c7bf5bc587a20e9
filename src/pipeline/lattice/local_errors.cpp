#include "pipeline/lattice/local_errors.h"

namespace pprt {

LocalErrors::LocalErrors(int right, int bottom) : columns_(right / (4 * kPixelSide) + 3) {
  const int rows = bottom / (4 * kPixelSide) + 3;
  sums_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows));
  means_.resize(sums_.size());
}

void LocalErrors::clear() {
  std::fill(sums_.begin(), sums_.end(), Sums());
  std::fill(means_.begin(), means_.end(), Mean());
  round_ = 1;
}

void LocalErrors::start_round() {
  if (++round_ != 0) return;
  std::fill(means_.begin(), means_.end(), Mean());
  round_ = 1;
}

void LocalErrors::note(const LatticeNode& node, float squared_error, float rays, float weight) {
  const std::size_t cell = cell_of(node);
  Sums& sums = sums_[cell];
  sums.error += weight * squared_error, sums.rays += weight * rays, sums.samples += weight;
  if (error_level(squared_error) <= means_[cell].level) return;
  const auto columns = static_cast<std::size_t>(columns_);
  for (const std::size_t row : {cell - columns, cell, cell + columns})
    for (const std::size_t i : {row - 1, row, row + 1}) means_[i].round = 0;
}

// The cell itself counts twice, those at its corners half.
void LocalErrors::compute(std::size_t cell, Mean& mean) const {
  constexpr float kUnknownError = 1.0F / 32, kUnknownRays = 3;
  const auto columns = static_cast<std::size_t>(columns_);
  const auto at = [&](std::size_t i) { return load<float4>(&sums_[i]); };
  const float4 all =
      at(cell) * 2 + at(cell - 1) + at(cell + 1) + at(cell - columns) + at(cell + columns) +
      (at(cell - columns - 1) + at(cell - columns + 1) + at(cell + columns - 1) + at(cell + columns + 1)) *
          0.5F;
  const bool is_known = all[2] > 0;
  mean.rays = is_known ? all[1] / all[2] : kUnknownRays;
  mean.level = static_cast<std::uint8_t>(error_level(is_known ? all[0] / all[2] : kUnknownError));
  mean.round = round_;
}

}  // namespace pprt
