#include "render/render_job.h"

#include <catch2/catch.hpp>

namespace pprt {

TEST_CASE("a job reaches the other ranks as it was settled") {
  RenderJob job;
  job.go = true;
  job.settings.width = 77, job.settings.stop.quality = 0.25;
  job.compile.max_depth = 3, job.compile.cull = true;
  job.compile.effects = parse_effects("shadows,reflection");
  job.scene_nff = "s 0 0 0 1\n";
  const RenderJob back = decode_job(encode(job));
  CHECK((back.go && back.settings.width == 77 && back.settings.stop.quality == 0.25));
  CHECK((back.compile.max_depth == 3 && back.compile.cull));
  REQUIRE(back.compile.effects);
  CHECK(back.compile.effects->bits() == job.compile.effects->bits());
  CHECK(back.scene_nff == job.scene_nff);
  CHECK_FALSE(decode_job(encode(RenderJob())).compile.effects);
}

TEST_CASE("a job cut short anywhere is refused") {
  RenderJob job;
  job.scene_nff = "s 0 0 0 1\n";
  const Bytes whole = encode(job);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    CHECK_THROWS_AS(decode_job(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))),
                    ProtocolError);
  }
}

TEST_CASE("a job that asks for an effect that there is not is refused") {
  RenderJob job;
  job.compile.effects = EffectSet(EffectSet::all().bits() + 1);
  CHECK_THROWS_AS(decode_job(encode(job)), ProtocolError);
}

}  // namespace pprt
