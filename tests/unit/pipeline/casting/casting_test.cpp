#include "pipeline/casting/casting.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "pipeline/casting/projected_samples.h"
#include "pipeline/mesh/mesh_casting.h"
#include "pipeline/mesh/seeds.h"

namespace pprt::casting_test {
namespace {

constexpr int kSize = 64;
const TileGrid kGrid{kSize, kSize, 16};

// Looks along +z from the origin; 45 degrees over the height.
Camera straight() {
  Camera camera;
  camera.slope_per_pixel = 2 * std::tan(22.5 * 3.14159265358979 / 180) / kSize;
  camera.width = camera.height = kSize;
  return camera;
}

// A wall at z = 4 and, in the middle of the view, a square in front of it at z = 2; at infinity beyond the
// wall's half-width of 10.
Sample look(const Camera& camera, double x, double y, int frame) {
  Sample sample;
  sample.x = x;
  sample.y = y;
  sample.frame = frame;
  const Vec3d direction = ray_direction(camera, x, y);
  const auto at_depth = [&](double z) { return camera.eye + direction * ((z - camera.eye.z) / direction.z); };
  const Vec3d square = at_depth(2), wall = at_depth(4);
  const bool on_square = std::abs(square.x) < 0.3 && std::abs(square.y) < 0.3;
  sample.ray.hit = Vec3f(on_square ? square : wall);
  sample.ray.color = on_square ? Color(1, 0, 0) : Color(0, 0, 1);
  return sample;
}

SampleMesh seen_by(const Camera& camera, int frame) {
  SampleMesh mesh(Region::whole(kGrid));
  for (const Vec2d& p : seed_points(kSize, kSize, 1)) mesh.insert(look(camera, p.x, p.y, frame));
  for (int i = 0; i < 600; ++i) {
    const auto next = mesh.next_point();
    if (!next) break;
    mesh.insert(look(camera, next->point.x, next->point.y, frame));
  }
  return mesh;
}

}  // namespace

TEST_CASE("casting: under a camera at rest every sample stays where it was") {
  const SampleMesh mesh = seen_by(straight(), 1);
  const CastResult cast = cast_samples(mesh, straight(), 2, {});
  // Samples on the border itself may leave it by the rounding of their hit points.
  CHECK(cast.samples.size() + cast.out_of_view == mesh.samples().size());
  CHECK(cast.out_of_view < 60);
  CHECK(cast.hidden == 0);
  double worst = 0;
  for (const Sample& s : cast.samples) {
    const Sample again = look(straight(), s.x, s.y, 1);
    worst = std::max<double>(worst, (again.ray.hit - s.ray.hit).length());
  }
  CHECK(worst < 1e-5);
}

TEST_CASE("casting: the orientation test finds most samples that a sideways step of the eye hides") {
  const Camera before = straight();
  Camera after = before;
  after.eye.x = 0.15;
  const SampleMesh mesh = seen_by(before, 1);
  const auto wrong = [&](const CastResult& cast) {
    int count = 0;
    for (const Sample& s : cast.samples) {
      count += look(after, s.x, s.y, 2).ray.color != s.ray.color;
    }
    return count;
  };
  CastSettings blind;
  blind.method = CastMethod::kVerified;
  const CastResult unchecked = cast_samples(mesh, after, 2, blind);
  const CastResult paper = cast_samples(mesh, after, 2, {});
  CHECK(wrong(unchecked) > 10);  // negative control: without a test hidden samples do slip through
  CHECK(wrong(paper) < 0.5 * wrong(unchecked));
  CHECK(paper.hidden > 0);
}

TEST_CASE("casting: a visibility ray per sample leaves no wrong sample") {
  const Camera before = straight();
  Camera after = before;
  after.eye.x = 0.15;
  const auto visible = [&](const Vec3f& hit, bool) {
    if (hit.z < 3) return true;
    const Vec3d way = Vec3d(hit) - after.eye;
    const Vec3d square = after.eye + way * (2 / way.z);
    return !(std::abs(square.x) < 0.3 && std::abs(square.y) < 0.3);
  };
  CastSettings verified;
  verified.method = CastMethod::kVerified;
  std::vector<Sample> samples = cast_samples(seen_by(before, 1), after, 2, verified).samples;
  const std::size_t cast = samples.size(), hidden = drop_hidden(samples, visible);
  for (const Sample& s : samples) CHECK(look(after, s.x, s.y, 2).ray.color == s.ray.color);
  CHECK(hidden > 10);
  CHECK(samples.size() + hidden == cast);
}

TEST_CASE("casting: what leaves a picture that is wider than high, or higher than wide, is out of view") {
  Camera wide = straight(), high = straight();
  wide.height = kSize / 2, high.width = kSize / 2;
  const auto cast = [](double x, double y, const Camera& next) {
    return cast_samples(std::vector{look(straight(), x, y, 1)}, Region::whole(kGrid), next, 2, {});
  };
  CHECK(cast(50, 32, wide).samples.size() == 1);
  CHECK(cast(32, 50, wide).out_of_view == 1);
  CHECK(cast(32, 50, high).samples.size() == 1);
  CHECK(cast(50, 32, high).out_of_view == 1);
}

TEST_CASE("casting: the mean way of samples is as long as they went, along both axes") {
  Camera next = straight();
  next.eye = Vec3d(0.3, -0.5, 0);
  const std::vector<Sample> samples = {look(straight(), 10, 14, 1), look(straight(), 50, 40, 1)};
  const CastResult cast = cast_samples(samples, Region::whole(kGrid), next, 2, {});
  REQUIRE(cast.samples.size() == 2);
  double sum = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const double dx = cast.samples[i].x - samples[i].x, dy = cast.samples[i].y - samples[i].y;
    REQUIRE((std::abs(dx) > 1 && std::abs(dy) > 1));
    sum += std::hypot(dx, dy);
  }
  CHECK(cast.moved == Approx(sum / 2));
}

TEST_CASE("casting: samples are dropped by age, eye-dependent ones earlier") {
  SampleMesh mesh(Region::whole(kGrid));
  for (int frame = 1; frame <= 10; ++frame) {
    Sample plain = look(straight(), 4.0 * frame, 20, frame);
    Sample shiny = look(straight(), 4.0 * frame, 40, frame);
    shiny.ray.eye_dependent = true;
    mesh.insert(plain);
    mesh.insert(shiny);
  }
  CastSettings settings;
  settings.method = CastMethod::kVerified;
  const CastResult cast = cast_samples(mesh, straight(), 11, settings);
  CHECK(cast.samples.size() == 8 + 2);
  CHECK(cast.too_old == 2 + 8);
  for (const Sample& s : cast.samples) CHECK(11 - s.frame <= (s.ray.eye_dependent ? 2 : 8));
}

TEST_CASE("casting: hit points behind the eye and at it are dropped, those at infinity do not move with it") {
  SampleMesh mesh(Region::whole(kGrid));
  const auto put = [&](double x, const Vec3f& hit, bool at_infinity) {
    Sample sample;
    sample.x = x;
    sample.y = 32;
    sample.frame = 1;
    sample.ray.hit = hit;
    sample.ray.at_infinity = at_infinity;
    mesh.insert(sample);
  };
  put(10, {0, 0, -3}, false);
  put(20, {0, 0, 0}, false);
  put(30, {0, 0, 1}, true);
  put(40, {0, 0, -1}, true);
  CastSettings settings;
  settings.method = CastMethod::kVerified;
  Camera away = straight();
  away.eye = {500, 0, 0};
  const CastResult near = cast_samples(mesh, straight(), 2, settings);
  REQUIRE(near.samples.size() == 1);
  CHECK(near.samples[0].x == Approx(32));
  const CastResult far = cast_samples(mesh, away, 2, settings);
  REQUIRE(far.samples.size() == 1);  // the background does not move when the eye does
  CHECK(far.samples[0].x == Approx(32));
}

TEST_CASE("casting: the youngest samples are kept, and of one age neither only the first nor only the last") {
  std::vector<Sample> samples(3000);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].id = i;
    samples[i].frame = i < 1000 ? 1 : 2;
  }
  keep_youngest(samples, 1000);
  REQUIRE(samples.size() == 1000);
  int early = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    CHECK(samples[i].frame == 2);
    CHECK((i == 0 || samples[i - 1].id < samples[i].id));
    early += samples[i].id < 2000;
  }
  CHECK(early == Approx(500).margin(80));  // five standard deviations
}

TEST_CASE("casting: the youngest sample of each pixel is kept, in the old order") {
  std::vector<Sample> samples(4);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].id = i, samples[i].y = 7.5;
  samples[0].x = 2.1, samples[0].frame = 1;
  samples[1].x = 2.9, samples[1].frame = 2;
  samples[2].x = 3.0, samples[2].frame = 1;
  samples[3].x = 2.5, samples[3].frame = 1;
  keep_youngest_of_pixels(samples);
  REQUIRE(samples.size() == 2);
  CHECK(samples[0].id == 1);
  CHECK(samples[1].id == 2);
}

TEST_CASE(
    "casting: of samples of one age in a pixel neither the first nor the last stays, whatever their order") {
  constexpr int kPixels = 400;
  std::vector<Sample> samples;
  for (SampleId id = 0; id < 3 * kPixels; ++id) {
    Sample& sample = samples.emplace_back();
    sample.id = id, sample.frame = 5;
    sample.x = static_cast<double>(id % kPixels) + 0.5;
  }
  std::vector<Sample> reversed(samples.rbegin(), samples.rend());
  keep_youngest_of_pixels(samples);
  keep_youngest_of_pixels(reversed);
  REQUIRE((samples.size() == kPixels && reversed.size() == kPixels));
  std::array<int, 3> kept{};
  for (const Sample& sample : samples) ++kept.at(sample.id / kPixels);
  for (const int of_third : kept) CHECK(of_third == Approx(kPixels / 3.0).margin(50));  // five deviations
  std::set<SampleId> forwards, backwards;
  for (const Sample& sample : samples) forwards.insert(sample.id);
  for (const Sample& sample : reversed) backwards.insert(sample.id);
  CHECK(forwards == backwards);
}

TEST_CASE("casting: one sample in 64 is drawn evenly by id") {
  int drawn = 0;
  for (SampleId id = 0; id < 64000; ++id) {
    Sample sample;
    sample.id = (SampleId{3} << 40) | id;
    drawn += is_one_of(sample, 64);
  }
  CHECK(drawn == Approx(1000).margin(160));
}

TEST_CASE("casting: which samples are drawn follows no pattern of their numbers") {
  // Ranks number their samples in the order of tracing: every 64th would be of a few places.
  std::vector<SampleId> drawn;
  for (SampleId id = 0; id < 64000; ++id) {
    Sample sample;
    sample.id = id;
    if (is_one_of(sample, 64)) drawn.push_back(id);
  }
  int odd = 0, of_64 = 0, close = 0;
  for (std::size_t i = 1; i < drawn.size(); ++i) {
    odd += drawn[i] % 2 != 0, of_64 += (drawn[i] - drawn[i - 1]) % 64 == 0;
    close += drawn[i] - drawn[i - 1] < 32;
  }
  const double count = static_cast<double>(drawn.size());
  CHECK(odd == Approx(count / 2).margin(100));  // six standard deviations
  CHECK(of_64 < 0.05 * count);
  CHECK(close == Approx(count * (1 - std::exp(-0.5))).margin(100));
}

TEST_CASE("casting: one sample in four cast alone equals that sample when all are cast") {
  const SampleMesh seen = seen_by(straight(), 1);
  SampleMesh mesh(Region::whole(kGrid));
  for (Sample s : seen.samples()) {
    s.id = mesh.samples().size();
    mesh.insert(s);
  }
  CastSettings settings{CastMethod::kVerified, 8, 2};
  const CastResult all = cast_samples(mesh, straight(), 2, settings);
  settings.one_of = 4;
  const CastResult drawn = cast_samples(mesh, straight(), 2, settings);
  std::vector<SampleId> expected, found;
  for (const Sample& s : all.samples) {
    if (is_one_of(s, 4)) expected.push_back(s.id);
  }
  for (const Sample& s : drawn.samples) found.push_back(s.id);
  CHECK(found == expected);
  CHECK_FALSE(found.empty());
  CHECK(found.size() < all.samples.size() / 2);
}

TEST_CASE("casting: only samples of the own region are cast") {
  std::vector<std::uint8_t> owned(16, 0);
  owned[5] = 1;
  SampleMesh mesh = seen_by(straight(), 1);
  mesh.set_region(Region(kGrid, owned));
  const CastResult cast = cast_samples(mesh, straight(), 2, {});
  CHECK(cast.samples.size() > 5);
  for (const Sample& s : cast.samples) CHECK(kGrid.tile_at(s.x, s.y) == 5);
}

TEST_CASE("casting: a sample goes where its object is, and is dropped where it is no more or relit") {
  std::vector<Sample> samples;
  for (const double x : {20.0, 32.0, 44.0}) samples.push_back(look(straight(), x, 10.5, 1));
  for (std::size_t i = 0; i < 3; ++i)
    samples[i].ray.primitive = static_cast<std::uint32_t>(i), samples[i].ray.lights = {1, 1};
  CastSettings settings{.method = CastMethod::kVerified};
  settings.carry = [](RaySample& ray) {
    if (ray.primitive == 1) return Carried::kNothing;
    if (ray.primitive == 2) {
      ray.lights = {};
      return Carried::kRelit;
    }
    ray.hit.x += 0.5F;
    return Carried::kKept;
  };
  const auto cast = [&] { return cast_samples(samples, Region::whole(kGrid), straight(), 2, settings); };
  const CastResult all = cast();
  REQUIRE(all.samples.size() == 1);
  CHECK(all.hidden == 2);
  CHECK(all.samples[0].x > 25);  // half a unit at the distance of 4
  CHECK(all.samples[0].y == Approx(10.5));
  CHECK(samples[0].ray.hit.x == look(straight(), 20, 10.5, 1).ray.hit.x);
  // For lights: what is relit counts if it knows any.
  settings.lit_only = true;
  CHECK(cast().samples.size() == 1);
  settings.carry = [](RaySample&) { return Carried::kRelit; };
  CHECK(cast().samples.size() == 3);
}

TEST_CASE("casting: a sample that went with its object is cast on from there") {
  const std::vector<Sample> samples = {look(straight(), 20, 10.5, 1)};
  CastSettings settings{.method = CastMethod::kVerified};
  settings.carry = [](RaySample& ray) {
    ray.hit.x += 0.5F, ray.lights = {1, 1};
    return Carried::kKept;
  };
  const auto cast = [&](const std::vector<Sample>& from, int frame) {
    return cast_samples(from, Region::whole(kGrid), straight(), frame, settings).samples;
  };
  const std::vector<Sample> once = cast(samples, 2);
  REQUIRE(once.size() == 1);
  CHECK(once[0].ray.hit.x == samples[0].ray.hit.x + 0.5F);
  CHECK(once[0].ray.lights.asked == 1);
  const std::vector<Sample> twice = cast(once, 3);
  REQUIRE(twice.size() == 1);
  CHECK(twice[0].x - once[0].x == Approx(once[0].x - 20));
}

TEST_CASE("casting: of what is there no more only what would be in view counts as hidden") {
  const std::vector<Sample> samples = {look(straight(), 20, 10.5, 1), look(straight(), 44, 10.5, 1)};
  CastSettings settings{.method = CastMethod::kVerified};
  settings.carry = [](RaySample&) { return Carried::kNothing; };
  const auto cast = [&](const Camera& next, int frame) {
    return cast_samples(samples, Region::whole(kGrid), next, frame, settings);
  };
  CHECK(cast(straight(), 2).hidden == 2);
  const CastResult late = cast(straight(), 1000);
  CHECK((late.too_old == 2 && late.hidden == 0));
  Camera away = straight();
  away.forward = -away.forward, away.right = -away.right;
  const CastResult behind = cast(away, 2);
  CHECK((behind.out_of_view == 2 && behind.hidden == 0));
}

TEST_CASE("casting: of a triangle that turns over the farthest corner is hidden, and what is nearly as far") {
  // Seen from the right, what is near moves to the left, beyond the corner that is far.
  struct Case {
    std::array<double, 3> depths;
    std::size_t hidden;
  };
  Camera after = straight();
  after.eye.x = 0.9;
  for (const Case& c :
       {Case{{4, 2, 2}, 1}, {{4, 3.99, 2}, 2}, {{4, 3.9, 2}, 1}, {{4, 4, 4}, 0}, {{2, 4, 4}, 0}}) {
    SampleMesh mesh(Region::whole(kGrid));
    const std::array<Vec2d, 3> at = {Vec2d(50, 30), Vec2d(54, 28), Vec2d(54, 36)};
    for (std::size_t i = 0; i < 3; ++i) {
      Sample sample = look(straight(), at[i].x, at[i].y, 1);
      sample.ray.hit = Vec3f(ray_direction(straight(), at[i].x, at[i].y) * c.depths[i]);
      mesh.insert(sample);
    }
    INFO("depths " << c.depths[0] << ", " << c.depths[1] << ", " << c.depths[2]);
    const CastResult cast = cast_samples(mesh, after, 2, {});
    CHECK(cast.samples.size() + cast.hidden == 3);
    CHECK(cast.hidden == c.hidden);
  }
}

TEST_CASE("casting: the borders of a picture are in view, and an age at its limit is young enough") {
  for (const double x : {0.0, 64.0}) {
    for (const double y : {0.0, 64.0}) {
      Sample sample = look(straight(), 32, 32, 1);
      sample.ray.at_infinity = true;
      const Vec3d inside = ray_direction(straight(), x + (x > 0 ? -1e-3 : 1e-3), y + (y > 0 ? -1e-3 : 1e-3));
      const Vec3d outside = ray_direction(straight(), x + (x > 0 ? 1e-3 : -1e-3), y + (y > 0 ? -1e-3 : 1e-3));
      sample.ray.hit = Vec3f(inside);
      const Region whole = Region::whole(kGrid);
      CHECK(project_sample(sample, whole, straight(), 9, {}).outcome == CastOutcome::kCast);
      CHECK(project_sample(sample, whole, straight(), 10, {}).outcome == CastOutcome::kTooOld);
      sample.ray.hit = Vec3f(outside);
      CHECK(project_sample(sample, whole, straight(), 10, {}).outcome == CastOutcome::kOutOfView);
    }
  }
  const std::vector<std::uint8_t> nothing(16, 0);
  CHECK(project_sample(look(straight(), 32, 32, 1), Region(kGrid, nothing), straight(), 2, {}).outcome ==
        ProjectedSample().outcome);
}

TEST_CASE("casting: of a triangle that turns over what lies at infinity is farther than all else") {
  Camera after = straight();
  after.eye.x = 0.9;
  SampleMesh mesh(Region::whole(kGrid));
  const std::array<Vec2d, 3> at = {Vec2d(50, 30), Vec2d(54, 28), Vec2d(54, 36)};
  for (std::size_t i = 0; i < 3; ++i) {
    Sample sample = look(straight(), at[i].x, at[i].y, 1);
    sample.id = i;
    sample.ray.at_infinity = i == 0;
    sample.ray.hit = Vec3f(ray_direction(straight(), at[i].x, at[i].y) * (i == 0 ? 1.0 : 2.0));
    mesh.insert(sample);
  }
  const CastResult cast = cast_samples(mesh, after, 2, {});
  CHECK(cast.hidden == 1);
  for (const Sample& s : cast.samples) CHECK(s.id != 0);
}

}  // namespace pprt::casting_test
