// Keys of a recorded film, and undo.
#include "live/film_keys.h"

#include <catch2/catch.hpp>

namespace pprt::film_keys_test {
namespace {

View view_from(double x) {
  View view;
  view.from = {x, 0, 0};
  return view;
}

std::vector<double> frames_of(const FilmKeys& film) {
  std::vector<double> frames;
  for (const CameraKey& key : film.keys()) frames.push_back(key.frame);
  return frames;
}

TEST_CASE("film keys: they stay in order, and a frame has one") {
  FilmKeys film;
  CHECK(film.frames() == 0);
  for (const int frame : {9, 1, 5, 9}) CHECK(film.set(frame, view_from(frame)));
  CHECK(frames_of(film) == std::vector<double>{1, 5, 9});
  CHECK(film.frames() == 9);
  CHECK(film.set(5, view_from(50)));
  CHECK(film.keys()[1].from.x == 50);
  CHECK_FALSE(film.drop(6));
  CHECK(film.drop(1));
  CHECK(frames_of(film) == std::vector<double>{5, 9});
}

TEST_CASE("film keys: each change can be undone, the last first") {
  FilmKeys film;
  CHECK_FALSE(film.undo());
  film.set(1, view_from(1));
  film.set(1, view_from(2));
  film.drop(1);
  CHECK(film.undo());
  CHECK(film.keys()[0].from.x == 2);
  CHECK(film.undo());
  CHECK(film.keys()[0].from.x == 1);
  CHECK(film.undo());
  CHECK(film.keys().empty());
  CHECK_FALSE(film.can_undo());
}

TEST_CASE("film keys: what was undone comes again, until something else is changed") {
  FilmKeys film;
  film.set(1, view_from(1));
  film.set(5, view_from(5));
  film.undo();
  CHECK(film.redo());
  CHECK(frames_of(film) == std::vector<double>{1, 5});
  CHECK_FALSE(film.redo());
  film.undo();
  film.set(9, view_from(9));
  CHECK_FALSE(film.can_redo());
}

TEST_CASE("film keys: a key that is moved replaces the one that is there") {
  FilmKeys film;
  for (const int frame : {1, 5, 9}) film.set(frame, view_from(frame));
  CHECK(film.move(1, 7));
  CHECK(frames_of(film) == std::vector<double>{5, 7, 9});
  CHECK(film.move(7, 9));
  CHECK(frames_of(film) == std::vector<double>{5, 9});
  CHECK(film.keys()[1].from.x == 1);
  CHECK_FALSE(film.move(7, 8));
  CHECK(film.move(5, 5));
  CHECK(film.undo());
  CHECK(frames_of(film) == std::vector<double>{5, 7, 9});
}

TEST_CASE("film keys: there are so many and no more, in the list and to undo") {
  FilmKeys film;
  for (int n = 1; n <= static_cast<int>(FilmKeys::kMost); ++n) REQUIRE(film.set(n, view_from(n)));
  CHECK_FALSE(film.set(5000, view_from(0)));
  CHECK(film.set(7, view_from(0)));
  int undone = 0;
  while (film.undo()) ++undone;
  CHECK(undone == 100);
  CHECK(film.keys().size() == FilmKeys::kMost - 99);  // the last changes, one of which added none
}

TEST_CASE("film keys: a key keeps the whole camera, also where it moves") {
  View view;
  view.from = {1, 2, 3}, view.at = {4, 5, 6}, view.up = {0, 0, 1}, view.angle_degrees = 77;
  FilmKeys film;
  film.set(3, view);
  film.move(3, 8);
  const CameraKey& key = film.keys().at(0);
  CHECK((key.frame == 8 && key.from == view.from && key.at == view.at && key.up == view.up));
  CHECK(key.angle_degrees == 77);
  CHECK(film.frames() == 8);
}

TEST_CASE("film keys: what is refused or changes nothing can not be undone, and leaves what can come again") {
  FilmKeys film;
  film.set(1, view_from(1));
  film.set(5, view_from(5));
  film.undo();
  CHECK_FALSE(film.drop(9));
  CHECK_FALSE(film.move(9, 2));
  CHECK(film.move(1, 1));
  CHECK(film.can_redo());
  CHECK(film.drop(1));
  CHECK_FALSE(film.can_redo());
  CHECK(film.undo());
  CHECK(film.undo());
  CHECK_FALSE(film.undo());
  while (film.redo()) continue;
  CHECK(film.keys().empty());
  for (int n = 1; n <= static_cast<int>(FilmKeys::kMost); ++n) film.set(n, view_from(n));
  film.undo(), film.redo();
  CHECK(film.set(4, view_from(9)));  // in the place of one that is there
  film.undo();
  CHECK_FALSE(film.set(100'000, view_from(0)));
  CHECK(film.can_redo());
}

}  // namespace
}  // namespace pprt::film_keys_test
