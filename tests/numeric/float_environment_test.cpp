// Tracing must leave the floating-point environment as CGAL's exact predicates need it, and the other way
// round.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cfenv>
#include <limits>
#include <utility>
#include <vector>

#include "numeric/pictures.h"
#include "numeric/report.h"
#include "pipeline/mesh/sample_mesh.h"
#include "spd/spd.h"

namespace pprt::float_environment_test {
namespace {

constexpr double kTiniest = std::numeric_limits<double>::denorm_min();
const TileGrid kGrid{128, 96, 16};

Sample sample_at(double x, double y) {
  Sample sample;
  sample.x = x, sample.y = y;
  return sample;
}

bool denormals_count() {
  const volatile double tiny = kTiniest, least = std::numeric_limits<double>::min();
  const volatile float tiny_float = std::numeric_limits<float>::denorm_min();
  return tiny > 0 && tiny + tiny > tiny && least / 2 > 0 && tiny_float > 0 &&
         tiny_float + tiny_float > tiny_float;
}

// Returns the sign of the orientation of points that are small multiples of kTiniest.
double orientation(const Sample& a, const Sample& b, const Sample& c) {
  const auto count = [](double from, double to) { return to / kTiniest - from / kTiniest; };
  return count(a.x, b.x) * count(a.y, c.y) - count(a.y, b.y) * count(a.x, c.x);
}

}  // namespace

TEST_CASE("samples a denormal apart are kept apart right after tracing") {
  const SceneDescription scene = make_spd("balls", 2);
  const std::vector<Rgb> before = test::traced_picture(scene, 32);
  REQUIRE(denormals_count());

  SampleMesh mesh(Region::whole(kGrid));
  for (const auto& [x, y] : {std::pair(0, 0), std::pair(128, 0), std::pair(128, 96), std::pair(0, 96)}) {
    REQUIRE(mesh.insert(sample_at(x, y)));
  }
  constexpr int kSide = 8;
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      if (i + j > 0) REQUIRE(mesh.insert(sample_at(i * kTiniest, j * kTiniest)));
      CHECK_FALSE(mesh.insert(sample_at(i * kTiniest, j * kTiniest)));
    }
  }
  CHECK(std::fegetround() == FE_TONEAREST);

  std::size_t tiny = 0;
  for (const auto& t : triangles(mesh)) {
    const Sample &a = mesh.samples()[t[0]], &b = mesh.samples()[t[1]], &c = mesh.samples()[t[2]];
    if (std::max({a.x, b.x, c.x, a.y, b.y, c.y}) > 1) continue;
    CHECK(orientation(a, b, c) > 0);
    ++tiny;
  }
  CHECK(tiny == 2u * (kSide - 1) * (kSide - 1));
  const std::size_t on_border = 4 + 2 * (kSide - 1);
  CHECK(triangles(mesh).size() == 2 * mesh.samples().size() - 2 - on_border);

  CHECK(test::traced_picture(scene, 32) == before);
  test::report("64 samples a denormal apart, inserted right after tracing",
               "all kept apart, rounding mode and pictures unchanged", "FTZ and DAZ are not set",
               tiny == 2u * (kSide - 1) * (kSide - 1) ? "exact" : "not");
}

}  // namespace pprt::float_environment_test
