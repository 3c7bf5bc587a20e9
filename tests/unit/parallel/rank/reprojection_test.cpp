// Which samples of a rank serve the next frame, where all that is seen is made up.
#include "parallel/rank/reprojection.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <span>
#include <vector>

#include "pipeline/core/display_values.h"
#include "unit/parallel/rank/one_rank.h"

namespace pprt::reprojection_test {
namespace {

using test::OneRank;

Camera straight() {
  Camera camera;
  camera.width = camera.height = OneRank::kSize;
  camera.slope_per_pixel = 0.01;
  return camera;
}

// A rank that has taken some samples in frame 1. The half of them where x is not positive will be hidden.
struct Caster : OneRank {
  explicit Caster(SamplerChoice sampler, const RaySample& seen = {})
      : OneRank(settings_of({}, sampler)), reprojection(sampling, tracer, clock, timer) {
    ray = seen;
    is_wavy = true;
    shade = [](double x, double y, RaySample& found) {
      found.hit = Vec3f(ray_direction(straight(), x, y) * 5);
    };
    tracer.begin_frame(order(1, Carry::kNothing));
    sampling.begin_picture(false);
    sampling.trace_seeds();
    for (int i = 0; i < 1500; ++i) REQUIRE(sampling.refine(nullptr));
  }

  static FrameOrder order(int number, Carry carry) {
    FrameOrder order;
    order.number = number, order.carry = carry, order.camera = straight();
    return order;
  }

  std::vector<Sample> cast(Carry carry, bool eye_rests = false) {
    tracer.begin_frame(order(2, carry));
    reprojection.begin_frame();
    return reprojection.cast(order(2, carry), eye_rests);
  }

  std::size_t seen_at_right() const {
    const std::span<const Sample> all = sampling.sampler().samples();
    return static_cast<std::size_t>(
        std::count_if(all.begin(), all.end(), [](const Sample& s) { return s.ray.hit.x > 0; }));
  }

  StageTimer timer{clock};
  Reprojection reprojection;
};

RaySample with_lights(std::uint8_t asked) {
  RaySample seen;
  seen.lights = {asked, 0};
  return seen;
}

}  // namespace

TEST_CASE(
    "reprojection: where casting pays each visible sample is carried once, those tried out first, too") {
  Caster rank(SamplerChoice::kDelaunay);
  const std::vector<Sample> cast = rank.cast(Carry::kCastWherePaying);
  std::set<SampleId> ids;
  for (const Sample& sample : cast) {
    CHECK(sample.ray.hit.x > 0);
    CHECK(ids.insert(sample.id).second);
  }
  CHECK(static_cast<double>(cast.size()) > 0.9 * static_cast<double>(rank.seen_at_right()));
  const CastEvidence& evidence = rank.reprojection.evidence();
  CHECK((evidence.asked > 5 && evidence.hidden > 0 && evidence.hidden < evidence.asked));
  CHECK(rank.reprojection.retraced() == 0);
}

TEST_CASE("reprojection: colour that depends on the eye is carried where it is traced anew, unproved not") {
  RaySample shiny;
  shiny.eye_dependent = true;
  Caster rank(SamplerChoice::kDelaunay, shiny);
  const std::vector<Sample> cast = rank.cast(Carry::kCastWherePaying);
  CHECK_FALSE(cast.empty());
  CHECK(cast.size() == rank.reprojection.retraced());
  for (const Sample& sample : cast) CHECK(sample.frame == 2);
  CHECK(rank.reprojection.evidence().stale == static_cast<double>(cast.size()));
}

TEST_CASE("reprojection: proof of other ranks or of the frame before lets all such colour be carried, once") {
  RaySample shiny;
  shiny.eye_dependent = true;
  CastEvidence proof;  // the picture is wrong, and its samples dear
  proof.fresh = proof.fresh_area = 10, proof.fresh_error = 1, proof.fresh_rays = 1000;
  for (const bool is_own : {false, true}) {
    Caster rank(SamplerChoice::kDelaunay, shiny);
    FrameOrder order = Caster::order(2, Carry::kCastWherePaying);
    (is_own ? rank.reprojection.evidence() : order.evidence) = proof;
    const auto carried = [&] {
      rank.tracer.begin_frame(order);
      rank.reprojection.begin_frame();
      return rank.reprojection.cast(order, false);
    };
    const std::vector<Sample> cast = carried();
    CHECK(static_cast<double>(cast.size()) > 0.9 * static_cast<double>(rank.seen_at_right()));
    CHECK((rank.reprojection.retraced() > 0 && cast.size() > 4 * rank.reprojection.retraced()));
    CHECK(std::count_if(cast.begin(), cast.end(), [](const Sample& s) { return s.frame == 1; }) ==
          static_cast<std::ptrdiff_t>(cast.size() - rank.reprojection.retraced()));
    order.evidence = {};  // what this frame has found says nothing of the picture
    CHECK(carried().size() == rank.reprojection.retraced());
  }
}

TEST_CASE("reprojection: each frame's evidence is its own, and what was traced anew is counted anew") {
  RaySample shiny;
  shiny.eye_dependent = true;
  Caster rank(SamplerChoice::kDelaunay, shiny);
  const std::size_t first = rank.cast(Carry::kCastWherePaying).size();
  const CastEvidence found = rank.reprojection.evidence();
  CHECK(
      (first > 0 && found.stale == static_cast<double>(first) && found.asked - found.hidden == found.stale));
  CHECK(found.stale_error == Approx(0).margin(1e-4));  // the colours are as they were
  rank.cast(Carry::kCastWherePaying);
  CHECK(rank.reprojection.evidence().asked == found.asked);
  CHECK(rank.reprojection.retraced() == first);
  rank.reprojection.begin_frame();
  CHECK((rank.reprojection.retraced() == 0 && rank.reprojection.evidence().asked == 0));
}

TEST_CASE("reprojection: what is traced anew shows how wrong the old colours were") {
  RaySample shiny;
  shiny.eye_dependent = true;
  Caster rank(SamplerChoice::kDelaunay, shiny);
  rank.shade = [](double x, double y, RaySample& found) {
    found.hit = Vec3f(ray_direction(straight(), x, y) * 5);
    found.color = Color(0.0F);
  };
  const std::vector<Sample> cast = rank.cast(Carry::kCastWherePaying);
  const std::span<const Sample> before = rank.sampling.sampler().samples();
  double error = 0;
  for (const Sample& now : cast) {
    const auto old = std::find_if(before.begin(), before.end(), [&](const Sample& s) {
      return std::abs(s.x - now.x) < 1e-3 && std::abs(s.y - now.y) < 1e-3;
    });
    REQUIRE(old != before.end());
    error += display_error(old->ray.color, now.ray.color);
  }
  CHECK(error > 0);
  CHECK(rank.reprojection.evidence().stale_error == Approx(error));
}

TEST_CASE("reprojection: the paper's way guesses what is hidden, and sends no ray") {
  Caster rank(SamplerChoice::kDelaunay);
  const std::size_t all = rank.sampling.sampler().samples().size();
  CHECK(static_cast<double>(rank.cast(Carry::kCastPaper).size()) > 0.9 * static_cast<double>(all));
  CHECK(rank.counts.visibility == 0);
  CHECK(rank.reprojection.evidence().asked == 0);
}

TEST_CASE(
    "reprojection: a picture at rest keeps one sample a pixel where it has outlines and enough samples") {
  for (const bool shines : {false, true}) {
    RaySample seen;
    seen.eye_dependent = shines;
    Caster rank(SamplerChoice::kDelaunay, seen);
    while (rank.sampling.in_region() < 2 * rank.sampling.region().pixel_count())
      REQUIRE(rank.sampling.refine(nullptr));
    const std::vector<Sample> cast = rank.cast(Carry::kCastWherePaying, true);
    const std::size_t pixels = rank.sampling.region().pixel_count();
    CHECK((cast.size() > pixels) == shines);
    CHECK(rank.counts.visibility == 0);
    CHECK(rank.cast(Carry::kCastVerified, true).size() >
          pixels);  // the choice is that of casting where it pays
  }
}

TEST_CASE("reprojection: under an eye at rest nothing is hidden, and no ray is sent") {
  Caster rank(SamplerChoice::kDelaunay);
  const auto all = static_cast<double>(rank.sampling.sampler().samples().size());
  for (const Carry carry : {Carry::kCastWherePaying, Carry::kCastVerified}) {
    CHECK(static_cast<double>(rank.cast(carry, true).size()) > 0.9 * all);
    CHECK(rank.counts.visibility == 0);
  }
  CHECK(rank.cast(Carry::kCastVerified, false).size() <= rank.seen_at_right());
  CHECK(static_cast<double>(rank.counts.visibility) > 0.9 * all);
}

TEST_CASE("reprojection: for lights samples are carried where they sent one and a half shadow rays each") {
  for (const auto& [asked, carry, serves] : {std::tuple(1, Carry::kCastWherePaying, false),
                                             {1, Carry::kCastVerified, true},
                                             {5, Carry::kCastWherePaying, true}}) {
    Caster rank(SamplerChoice::kAuto, with_lights(static_cast<std::uint8_t>(asked)));
    INFO("lights " << asked);
    CHECK(rank.cast(carry).empty() != serves);
    CHECK(rank.counts.visibility == 0);
  }
}

TEST_CASE("reprojection: where a frame with a rate has no time samples are dropped, without one all stay") {
  Caster rank(SamplerChoice::kDelaunay);
  const std::span<const Sample> taken = rank.sampling.sampler().samples();
  std::vector<Sample> samples(taken.begin(), taken.end());
  FrameOrder order = Caster::order(2, Carry::kCastPaper);
  rank.reprojection.keep_affordable(order, samples);
  CHECK(samples.size() == taken.size());
  order.deadline_s = 1;  // of a clock without a budget: nothing is affordable
  rank.reprojection.keep_affordable(order, samples);
  CHECK(samples.empty());
}

}  // namespace pprt::reprojection_test
