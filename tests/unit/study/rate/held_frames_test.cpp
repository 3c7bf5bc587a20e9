#include "study/rate/held_frames.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

namespace pprt::held_frames_test {
namespace {

Image grey(double value) {
  Image image(8, 8);
  for (Color& c : image.pixels) c = Color(static_cast<float>(value));
  return image;
}

// What brightens by 0.1 a second, and frames of it without any error but their age.
Image at(double moment_s) {
  return grey(0.1 * moment_s);
}

}  // namespace

TEST_CASE("held frames: a frame is seen from its delivery to the next one's") {
  CHECK(frame_seen_at(0.24, 4, 0.25) == -1);
  CHECK(frame_seen_at(0.25, 4, 0.25) == 0);
  CHECK(frame_seen_at(0.49, 4, 0.25) == 0);
  CHECK(frame_seen_at(0.5, 4, 0.25) == 1);
  CHECK(frame_seen_at(1 / 3.0 + 1 / 30.0, 30, 1 / 30.0) == 10);
}

TEST_CASE("held frames: perfect ones are wrong by their age, one to two periods") {
  std::vector<Image> pictures;
  for (int i = 0; i < 240; ++i) pictures.push_back(at(0.25 + i / 240.0));
  const TrueFilm film = true_film(240, 0.25, std::move(pictures));
  CHECK(film.flip.size() == 60);
  double before = 1;
  for (const double rate : {4.0, 24.0, 60.0}) {
    std::vector<Image> frames;
    for (int k = 0; k < 1.25 * rate; ++k) frames.push_back(at(k / rate));
    const HeldErrors errors = errors_of({rate, 1 / rate, frames}, film);
    // Ages of 1 to 2 periods in steps of 1/240 s.
    double squared = 0;
    const int steps = static_cast<int>(240 / rate);
    for (int i = 0; i < steps; ++i) squared += std::pow(0.1 * (1 / rate + i / 240.0), 2) / steps;
    CHECK(errors.rmse == Approx(std::sqrt(squared)).epsilon(1e-3));
    CHECK(errors.flip < before);
    before = errors.flip;
  }
}

TEST_CASE("held frames: a moment without a frame is refused") {
  const TrueFilm film = true_film(240, 0.1, {at(0.1)});
  const std::vector<Image> frames = {at(0)};
  CHECK_THROWS_AS(errors_of({4, 0.25, frames}, film), std::invalid_argument);
  CHECK_THROWS_AS(errors_of({60, 1 / 60.0, frames}, film), std::invalid_argument);
}

}  // namespace pprt::held_frames_test
