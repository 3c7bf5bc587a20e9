#include "scene/movement/motion_track.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

namespace pprt::motion_track_test {

namespace {

// The camera of the kitchen, a scene of BART (Lext, Assarsson and Moller 2000; public domain).
MotionTrack kitchen_camera() {
  MotionTrack track;
  for (const auto& [t, x, y, z] :
       std::initializer_list<std::array<double, 4>>{{-1.0, 3.75, 2.3, 3.6},
                                                    {0.0, 3.75, 2.3, 3.6},
                                                    {5.0, 3.50, 0.2, 0.1},
                                                    {6.7, 3.50, 0.2, 0.70},
                                                    {7.2, 3.83, 0.2, 1.0},
                                                    {7.8, 3.83, 0.2, 1.05},
                                                    {9.50, 3.17, 0.47, 1.05},
                                                    {10.50, 3.07, 0.47, 1.05},
                                                    {11.00, 2.78, 0.40, 1.05},
                                                    {12.00, 1.76, 0.21, 1.30},
                                                    {13.00, 0.75, 0.299122, 1.61954},
                                                    {15.50, 0.75, 0.199122, 0.91954},
                                                    {17.00, 0.75, 0.199122, 1.31954},
                                                    {17.64, 1.20894, 0.399122, 1.71954},
                                                    {17.9, 2.23, 0.87, 1.88},
                                                    {18.1, 2.71424, 1.02862, 2.10206},
                                                    {18.4, 2.72827, 1.32948, 2.3054},
                                                    {18.8, 2.72827, 1.22948, 2.4054},
                                                    {19.2, 3.07488, 0.654545, 2.55028},
                                                    {19.7, 3.27488, 0.334545, 2.98028},
                                                    {21.0, 3.27488, 0.334545, 2.98028}})
    track.translation.push_back({t, {x, y, z}});
  for (const auto& [t, x, y, z, degrees] :
       std::initializer_list<std::array<double, 5>>{{-1.0, 0.77895, -0.61838, -0.10410, -31.77348},
                                                    {0.0, 0.77895, -0.61838, -0.10410, -31.77348},
                                                    {5.0, 0, -1, 0, -180},
                                                    {6.7, 0, -1, 0, -170},
                                                    {7.2, 0, -1, 0, -95},
                                                    {7.8, 0, -1, 0, -95},
                                                    {9.0, 0.56574, -0.79573, -0.21621, -53.47574},
                                                    {10.50, 0.42595, -0.87229, -0.24016, -67.73105},
                                                    {11.00, 0.06826, -0.99551, -0.06562, -88.91139},
                                                    {12.00, 0.04859, -0.99528, -0.08399, -93.11012},
                                                    {13.00, 0.16387, 0.98046, 0.10887, -52.03110},
                                                    {15.50, 0.03809, 0.99499, 0.09240, -119.39587},
                                                    {17.00, 0.06721, 0.99308, 0.09634, -94.54191},
                                                    {17.64, 0.33592, 0.88288, 0.32814, -101.62479},
                                                    {17.9, 1, 0, 0, -1.44130},
                                                    {18.1, 0.26964, -0.95494, -0.12400, -63.19122},
                                                    {18.4, 0.35993, -0.79977, -0.48043, -93.99377},
                                                    {18.8, 0.38824, -0.79400, -0.46779, -112.16563},
                                                    {19.2, 0.31312, -0.85762, -0.40797, -106.90137},
                                                    {19.7, 0.10848, -0.96418, -0.24205, -128},
                                                    {21.0, 0.10848, -0.96418, -0.24205, -128}})
    track.rotation.push_back({t, {x, y, z}, degrees});
  return track;
}

void check_near(const Vec3d& a, const Vec3d& b, double margin) {
  for (int i = 0; i < 3; ++i) CHECK(a[i] == Approx(b[i]).margin(margin));
}

MotionTrack turns(std::initializer_list<std::pair<double, double>> keys) {
  MotionTrack track;
  for (const auto& [time, degrees] : keys) track.rotation.push_back({time, {0, 0, 2}, degrees});
  return track;
}

MotionTrack moves(std::initializer_list<std::pair<double, double>> keys) {
  MotionTrack track;
  for (const auto& [time, x] : keys) track.translation.push_back({time, {x, 0, 0}});
  return track;
}

double x_at(const MotionTrack& track, double time) {
  return placement_at(track, time).to_parent.origin.x;
}

bool is_finite(const Affine& map) {
  double sum = 0;
  for (const Vec3d& v : {map.x, map.y, map.z, map.origin}) sum += v.x + v.y + v.z;
  return std::isfinite(sum);
}

}  // namespace

// Frame f of 800 is at 20 f / 799 seconds. Values of an independent program, in doubles, rounded to six
// digits.
TEST_CASE("motion track: the kitchen's camera is where it must be") {
  struct Known {
    int frame;
    Vec3d eye, at;
  };
  const MotionTrack camera = kitchen_camera();
  for (const Known& known :
       std::initializer_list<Known>{{0, {3.750000, 2.300000, 3.600000}, {3.436536, 1.880186, 2.748239}},
                                    {89, {3.637336, 1.353621, 1.973416}, {2.669414, 1.119783, 2.065327}},
                                    {178, {3.522177, 0.386287, 0.371763}, {3.293357, 0.372904, 1.345140}},
                                    {267, {3.497546, 0.199949, 0.693082}, {3.334857, 0.199953, 1.679759}},
                                    {356, {3.385264, 0.385749, 1.052898}, {2.767887, -0.120365, 0.450657}},
                                    {445, {2.653322, 0.373002, 1.075569}, {1.659567, 0.267846, 1.112884}},
                                    {534, {0.672946, 0.293616, 1.553192}, {1.601984, 0.117260, 1.227942}},
                                    {623, {0.748804, 0.196527, 0.915795}, {1.605021, 0.027730, 1.404057}},
                                    {712, {1.912604, 0.728789, 1.823934}, {2.395672, 0.527063, 0.971906}},
                                    {799, {3.274880, 0.334545, 2.980280}, {2.557519, -0.128001, 3.501283}}}) {
    INFO("frame " << known.frame);
    const Affine map = placement_at(camera, 20.0 * known.frame / 799).to_parent;
    check_near(map.origin, known.eye, 1e-6);
    check_near(map.origin - map.z, known.at, 1e-6);
  }
  check_near(placement_at(camera, 0).to_parent.y, {-0.127003, 0.907444, -0.400520}, 1e-6);
  check_near(placement_at(camera, 20).to_parent.y, {-0.359727, 0.886328, 0.291580}, 1e-6);
}

TEST_CASE("motion track: the curve runs from the second key to the last but one") {
  const MotionTrack track = moves({{-1, 7}, {0, 1}, {1, 2}, {2, 3}, {9, 8}});
  CHECK(x_at(track, -5) == 1);
  CHECK(x_at(track, 0) == 1);
  CHECK(x_at(track, 1) == 2);
  CHECK(x_at(track, 2) == 3);
  CHECK(x_at(track, 100) == 3);
}

TEST_CASE("motion track: even keys make an even movement, whatever their distance in time") {
  const MotionTrack even = moves({{0, 0}, {1, 1}, {3, 3}, {4, 4}, {9, 9}});
  for (double t = 1; t <= 4; t += 0.125) CHECK(x_at(even, t) == Approx(t));
  const MotionTrack turned = turns({{0, 0}, {1, 30}, {3, 90}, {4, 120}, {9, 270}});
  for (double t = 1; t <= 4; t += 0.125) {
    const double angle = t * M_PI / 6;
    check_near(placement_at(turned, t).to_parent.x, {std::cos(angle), std::sin(angle), 0}, 1e-12);
  }
}

TEST_CASE("motion track: tension, continuity and bias shape the tangents as Kochanek and Bartels say") {
  MotionTrack track = moves({{0, 0}, {1, 1}, {2, 4}, {3, 9}});
  const double plain = x_at(track, 1.5);
  CHECK(plain == Approx(0.5 * 1 + 0.5 * 4 + 0.125 * (0.5 * 1 + 0.5 * 3) - 0.125 * (0.5 * 3 + 0.5 * 5)));
  track.translation[1].shape = {.tension = 1};
  CHECK(x_at(track, 1.5) == Approx(0.5 * 1 + 0.5 * 4 - 0.125 * (0.5 * 3 + 0.5 * 5)));
  track.translation[1].shape = {.continuity = -1};  // out: the change after alone
  CHECK(x_at(track, 1.5) == Approx(0.5 * 1 + 0.5 * 4 + 0.125 * 3 - 0.125 * (0.5 * 3 + 0.5 * 5)));
  track.translation[1].shape = {.bias = 1};  // the change before alone
  CHECK(x_at(track, 1.5) == Approx(0.5 * 1 + 0.5 * 4 + 0.125 * 1 - 0.125 * (0.5 * 3 + 0.5 * 5)));
}

TEST_CASE("motion track: the short way round, and full turns count for nothing") {
  const MotionTrack track = turns({{0, 7650}, {1, 7650}, {2, 7650 + 350}, {3, 7650 + 350}});
  const Affine middle = placement_at(track, 1.5).to_parent;
  const double angle = (7650 - 5) * M_PI / 180;
  check_near(middle.x, {std::cos(angle), std::sin(angle), 0}, 1e-9);
  const MotionTrack none = turns({{0, 0}, {1, 0}, {2, 360}, {3, 360}});
  check_near(placement_at(none, 1.5).to_parent.x, {1, 0, 0}, 1e-12);
}

TEST_CASE("motion track: a part comes before the one that moves it") {
  MotionTrack track = moves({{0, 5}, {1, 5}, {2, 5}, {3, 5}});
  track.rotation = turns({{0, 90}, {1, 90}, {2, 90}, {3, 90}}).rotation;
  for (double t = 0; t <= 3; ++t) track.scale.push_back({t, {2, 1, 1}});
  const Affine map = placement_at(track, 1.5).to_parent;
  check_near(map.point({1, 0, 0}), {5, 2, 0}, 1e-12);
  check_near(map.point({0, 1, 0}), {4, 0, 0}, 1e-12);
}

TEST_CASE("motion track: keys at equal times jump, and the later one holds") {
  const MotionTrack track = moves({{0, 0}, {1, 1}, {2, 2}, {2, 8}, {3, 9}, {4, 9}});
  CHECK(x_at(track, 2) == 8);
  CHECK(x_at(track, std::nextafter(2.0, 0.0)) == Approx(2));
  const MotionTrack turned = turns({{0, 0}, {1, 0}, {2, 10}, {2, 100}, {3, 110}, {4, 110}});
  check_near(placement_at(turned, 2).to_parent.x, {std::cos(100 * M_PI / 180), std::sin(100 * M_PI / 180), 0},
             1e-12);
  for (const auto& keys : {moves({{0, 0}, {1, 1}, {1, 2}, {2, 3}}), moves({{1, 0}, {1, 1}, {1, 2}, {1, 3}}),
                           moves({{0, 0}, {1, 1}, {2, 2}, {2, 5}})}) {
    for (double t = -1; t <= 3; t += 0.25) CHECK(is_finite(placement_at(keys, t).to_parent));
  }
}

TEST_CASE("motion track: at decreasing times the first segment that ends later counts") {
  const MotionTrack track = moves({{0, 0}, {1, 1}, {5, 5}, {3, 3}, {6, 6}, {7, 7}});
  CHECK(x_at(track, 5) == Approx(x_at(moves({{5, 5}, {3, 3}, {6, 6}, {7, 7}}), 5)));
  for (double t = 0; t <= 8; t += 0.125) {
    CHECK(is_finite(placement_at(track, t).to_parent));
    if (t < 5) CHECK(x_at(track, t) < 6);
  }
}

TEST_CASE("motion track: visible until a key says otherwise") {
  MotionTrack track;
  CHECK(placement_at(track, 3).visible);
  track.visibility = {{1, false}, {2, true}, {2, false}, {5, true}};
  for (const auto& [time, visible] : std::initializer_list<std::pair<double, bool>>{
           {0.9, true}, {1, false}, {2, false}, {4.9, false}, {5, true}, {99, true}})
    CHECK(placement_at(track, time).visible == visible);
  CHECK(placement_at(track, 3).to_parent == Affine());
}

TEST_CASE("motion track: far keys, tiny scales and zero axes stay finite") {
  MotionTrack track = moves({{0, 1e100}, {1, -1e100}, {2, 1e100}, {3, 0}});
  for (double t = 0; t <= 3; ++t) {
    track.scale.push_back({t, {t * 1e-9, 0, -1}});
    track.rotation.push_back({t, {0, 0, 0}, 90 * t});
  }
  for (double t = 0; t <= 3; t += 0.125) CHECK(is_finite(placement_at(track, t).to_parent));
  check_near(placement_at(track, 1.5).to_parent.z, {0, 0, -1}, 1e-12);
}

TEST_CASE("affine: normals stay normal to their surface, also where it is mirrored") {
  const Affine map = translation({1, 2, 3}) * rotation({1, 1, 0}, 33) * scaling({2, -1, 0.5});
  const Vec3d a{1, 2, 0}, b{0, 1, 1};
  const Vec3d normal = map.normal(a.cross(b));
  CHECK(normal.dot(map.vector(a)) == Approx(0).margin(1e-12));
  CHECK(normal.dot(map.vector(b)) == Approx(0).margin(1e-12));
  check_near(normal, map.vector(a).cross(map.vector(b)), 1e-12);
  CHECK(map.determinant() == Approx(-1));
  check_near((map * map).point(a), map.point(map.point(a)), 1e-12);
}

TEST_CASE("a track's reach contains it at all times, and is not much larger") {
  MotionTrack track = kitchen_camera();
  for (std::size_t i = 0; i < track.translation.size(); ++i) {
    track.translation[i].shape = {0.5 - 0.3 * static_cast<double>(i % 5), 0.2, i % 2 ? -0.8 : 0.7};
    track.scale.push_back(track.translation[i]);
    track.scale.back().value *= -1;
  }
  const TrackReach reach = reach_of(track);
  Box3d found;
  for (double time = -2; time < 22; time += 1e-3) {
    const TrackValues values = values_at(track, time);
    found.extendBy(values.translation);
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(values.translation[axis] >= reach.translation.min[axis] - 1e-12);
      CHECK(values.translation[axis] <= reach.translation.max[axis] + 1e-12);
      CHECK(std::abs(values.scale[axis]) <= reach.scale + 1e-12);
    }
  }
  CHECK(reach.translation.size().length() < 1.2 * found.size().length());
  CHECK(reach_of(MotionTrack()).scale == 1);
  CHECK(reach_of(MotionTrack()).translation == Box3d(Vec3d(0, 0, 0)));
}

TEST_CASE("visibility is found by halving as by looking at each key") {
  MotionTrack track;
  for (int i = 0; i < 9; ++i)
    track.visibility.push_back({0.5 * (i / 2), i % 3 != 0});  // pairs at equal times
  MotionTrack sorted = track;
  note_order(sorted);
  REQUIRE((sorted.is_in_order && !track.is_in_order));
  for (double time = -0.25; time < 3; time += 0.25)
    CHECK(values_at(sorted, time).visible == values_at(track, time).visible);
  std::swap(track.visibility[0], track.visibility[8]);
  note_order(track);
  CHECK_FALSE(track.is_in_order);
}

}  // namespace pprt::motion_track_test
