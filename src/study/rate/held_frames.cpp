#include "study/rate/held_frames.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "study/reference.h"

namespace pprt {

TrueFilm true_film(double rate, double begin_s, std::vector<Image> pictures) {
  TrueFilm film{.rate = rate, .begin_s = begin_s, .pictures = std::move(pictures)};
  const auto step = static_cast<std::size_t>(film.flip_every);
  for (std::size_t i = 0; i < film.pictures.size(); i += step) film.flip.emplace_back(film.pictures[i]);
  return film;
}

// A frame that is delivered at this very moment is seen, whatever rounding says.
int frame_seen_at(double moment_s, double rate, double lag_s) {
  constexpr double kRounding = 1e-6;  // of a period
  return static_cast<int>(std::floor((moment_s - lag_s) * rate + kRounding));
}

HeldErrors errors_of(const HeldFrames& frames, const TrueFilm& film) {
  HeldErrors errors;
  double squared = 0;
  const auto step = static_cast<std::size_t>(film.flip_every);
  for (std::size_t i = 0; i < film.pictures.size(); ++i) {
    const int seen = frame_seen_at(film.moment(i), frames.rate, frames.lag_s);
    if (seen < 0 || static_cast<std::size_t>(seen) >= frames.pictures.size())
      throw std::invalid_argument("at some moment no frame is seen");
    const Image& picture = frames.pictures[static_cast<std::size_t>(seen)];
    squared += std::pow(rmse_of(picture, film.pictures[i]), 2);
    if (i % step == 0) errors.flip += film.flip[i / step].mean(picture);
  }
  errors.rmse = std::sqrt(squared / static_cast<double>(film.pictures.size()));
  errors.flip /= static_cast<double>(film.flip.size());
  return errors;
}

}  // namespace pprt
