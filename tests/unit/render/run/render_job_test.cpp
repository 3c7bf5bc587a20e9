#include "render/run/render_job.h"

#include <catch2/catch.hpp>

#include "parser/nff_parser.h"
#include "scene/bytes/scene_bytes.h"

namespace pprt::render_job_test {
namespace {

constexpr const char* kScene =
    "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 30\nhither 1\nresolution 8 8\nl 5 5 5\n"
    "f 1 0 0 1 0 0 0 0\nf 0.2 0.4 0.1 0.7 0.2 9 0 0\ns 0.1 0.2 0.3 1\n";

// What a scene shows through its own view: hits and colours at every pixel's centre.
struct Shown {
  std::vector<std::uint32_t> materials;
  std::vector<Color> colors;

  friend bool operator==(const Shown&, const Shown&) = default;
};

Shown shown(const CompiledScene& scene, const View& view) {
  Tracer tracer(scene, scene.camera(view));
  Shown result;
  for (int pixel = 0; pixel < view.width * view.height; ++pixel) {
    const double x = pixel % view.width + 0.5, y = pixel / view.width + 0.5;
    result.materials.push_back(tracer.first_hit(x, y).material);
    result.colors.push_back(tracer.trace(x, y).color);
  }
  return result;
}

}  // namespace

TEST_CASE("a render job arrives as it was sent") {
  RenderJob job;
  job.go = true;
  job.settings.width = 77, job.settings.stop.flip = 0.25;
  job.compile.max_depth = 3, job.compile.cull = true;
  job.compile.effects = parse_effects("shadows,reflection");
  job.scene = encode(parse_nff(kScene, "ball.nff").scene);
  const RenderJob back = decode_job(encode(job));
  CHECK((back.go && back.settings.width == 77 && back.settings.stop.flip == 0.25));
  CHECK((back.compile.max_depth == 3 && back.compile.cull));
  REQUIRE(back.compile.effects);
  CHECK(back.compile.effects->bits() == job.compile.effects->bits());
  CHECK(back.scene == job.scene);
  CHECK_FALSE(decode_job(encode(RenderJob())).compile.effects);
}

TEST_CASE("all ranks see the scene that the first has read") {
  const SceneDescription read = parse_nff(kScene, "t").scene;
  const View view = read.view.value();
  RenderJob job;
  job.scene = encode(read);
  const Shown on_worker = shown(compile_scene(decode_job(encode(job))), view);
  CHECK(shown(compile(read), view) == on_worker);
  // Control: with one number changed it is another one.
  SceneDescription other = read;
  other.spheres[0].radius = 1.1;
  CHECK_FALSE(shown(compile(other), view) == on_worker);
}

TEST_CASE("a render job cut short anywhere is refused") {
  RenderJob job;
  job.scene = encode(parse_nff("f 1 1 1 1 0 0 0 0 s 0 0 0 1\n", "t").scene);
  const Bytes whole = encode(job);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    CHECK_THROWS_AS(decode_job(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))),
                    ProtocolError);
  }
}

TEST_CASE("a render job with an unknown effect is refused") {
  RenderJob job;
  job.compile.effects = EffectSet(EffectSet::all().bits() + 1);
  CHECK_THROWS_AS(decode_job(encode(job)), ProtocolError);
}

}  // namespace pprt::render_job_test
