// The two bounds of the NFF reader: when a polygon has no area, and when a view has no usable up.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "parser/nff_parser.h"
#include "trace/compiled_scene.h"
#include "unit/trace/test_scenes.h"

namespace pprt::reader_bounds_test {
namespace {

// Coordinates are decimals with six digits after the point: exact as integers, rounded as doubles.
__extension__ using Exact = __int128;
using Micro = std::array<long long, 3>;
constexpr double kMicro = 1e-6;

// Returns vertices on a straight line; the last one may lie off it.
std::vector<Micro> nearly_collinear(std::mt19937& random) {
  const auto within = [&](double limit) {
    return std::llround(std::uniform_real_distribution<double>(-limit, limit)(random));
  };
  const double reach = std::pow(10, std::uniform_real_distribution<double>(6, 14)(random));
  const Micro first = {within(reach), within(reach), within(reach)};
  const Micro step = {within(1e6), within(1e6), within(1e6)};
  std::vector<Micro> corners;
  const std::size_t count = 3 + random() % 4;
  for (std::size_t i = 0; i < count; ++i) {
    const long long steps = within(100);
    corners.push_back({first[0] + steps * step[0], first[1] + steps * step[1], first[2] + steps * step[2]});
  }
  if (random() % 2 == 0) {
    const double off = std::pow(10, std::uniform_real_distribution<double>(0, 6)(random));
    for (long long& c : corners.back()) c += within(off);
  }
  return corners;
}

struct ExactShape {
  double twice_area = 0;  // largest component
  double largest = 0;     // coordinate
  double extent = 0;      // largest difference from the first corner
};

ExactShape exact_shape(const std::vector<Micro>& corners) {
  ExactShape shape;
  const Micro& o = corners[0];
  std::array<Exact, 3> normal{};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Micro &a = corners[i], &b = corners[(i + 1) % corners.size()];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t p = (k + 1) % 3, q = (k + 2) % 3;
      normal[k] +=
          static_cast<Exact>(a[p] - o[p]) * (b[q] - o[q]) - static_cast<Exact>(a[q] - o[q]) * (b[p] - o[p]);
      shape.largest = std::max(shape.largest, kMicro * std::abs(static_cast<double>(a[k])));
      shape.extent = std::max(shape.extent, kMicro * std::abs(static_cast<double>(a[k] - o[k])));
    }
  }
  for (const Exact component : normal) {
    shape.twice_area = std::max(shape.twice_area, kMicro * kMicro * std::abs(static_cast<double>(component)));
  }
  return shape;
}

std::string as_nff(const std::vector<Micro>& corners) {
  std::string text = fmt::format("p {}\n", corners.size());
  for (const Micro& corner : corners) {
    for (const long long c : corner) {
      text += fmt::format("{}{}.{:06} ", c < 0 ? "-" : "", std::abs(c) / 1'000'000, std::abs(c) % 1'000'000);
    }
    text += '\n';
  }
  return text;
}

std::string view_with_up(const char* up) {
  return fmt::format("v\nfrom 0 0 0\nat 0 0 2\nup {}\nangle 45\nhither 1\nresolution 8 8\ns 0 0 5 1\n", up);
}

}  // namespace

TEST_CASE("a polygon is left out when it has no area, and kept from twice the bound of rounding on") {
  constexpr double kUnit = 0x1p-53;
  std::mt19937 random(1);
  int flat = 0, kept = 0;
  for (int i = 0; i < 20'000; ++i) {
    const std::vector<Micro> corners = nearly_collinear(random);
    const ExactShape shape = exact_shape(corners);
    const double bound = 18 * kUnit * shape.largest * shape.extent * static_cast<double>(corners.size());
    const std::string text = as_nff(corners);
    const std::size_t read = parse_nff(text + "s 0 0 0 1\n", "test").scene.polygons.size();
    CAPTURE(text, shape.twice_area, bound);
    if (shape.twice_area == 0) {
      REQUIRE(read == 0);
      ++flat;
    } else if (shape.twice_area > 2 * bound) {
      REQUIRE(read == 1);
      ++kept;
    }
  }
  CHECK(flat > 5'000);
  CHECK(kept > 2'000);
}

TEST_CASE("a view's up may stand off the line of sight by little more than 1e-9") {
  CHECK_NOTHROW(parse_nff(view_with_up("1.1e-9 0 1"), "test"));
  CHECK_THROWS_AS(parse_nff(view_with_up("0.9e-9 0 1"), "test"), InputError);
}

// Unit vectors in double err by some 2^-52 per coordinate. That turns the image by sqrt(3) 2^-52 over the
// sine: 3.5e-7. Measured: 1.2e-7.
TEST_CASE("where up is that close to the line of sight the image is turned by less than 4e-7") {
  constexpr double kSine = 1.1e-9;
  SceneDescription scene = test::scene_with(Material());
  add_sphere(scene, {{0, 0, 0}, 1, 0, {}});
  const CompiledScene compiled = compile(scene);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto direction = [&] { return Vec3d(normal(random), normal(random), normal(random)).normalized(); };
  double worst = 0;
  for (int i = 0; i < 10'000; ++i) {
    const Vec3d forward = direction(), up = forward.cross(direction()).normalized();
    View view = test::view_from({0, 0, 0}, forward);
    view.up = forward + up * kSine;
    worst = std::max(worst, std::abs(compiled.camera(view).right.dot(up)));
  }
  CAPTURE(worst);
  CHECK(worst < 4e-7);
}

}  // namespace pprt::reader_bounds_test
