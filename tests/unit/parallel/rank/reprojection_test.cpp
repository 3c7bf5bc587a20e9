// Which samples of a rank serve the next frame, where all that is seen is made up.
#include "parallel/rank/reprojection.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

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
