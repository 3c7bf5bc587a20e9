#include "render/render_job.h"

#include <catch2/catch.hpp>

#include "parser/nff_parser.h"

namespace pprt {
namespace {

// A scene that canonical NFF does not keep whole: its first material is unused, so that the ball's is the
// second one here and the first one in canonical form.
constexpr const char* kLossyScene =
    "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 30\nhither 1\nresolution 8 8\nl 5 5 5\n"
    "f 1 0 0 1 0 0 0 0\nf 0.2 0.4 0.1 0.7 0.2 9 0 0\ns 0.1 0.2 0.3 1\n";

RenderJob job_of(const SceneDescription& scene) {
  return {.go = true, .settings = {}, .compile = {}, .scene_name = "t", .scene_nff = canonical_nff(scene)};
}

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
  job.scene_name = "ball.nff", job.scene_nff = "s 0 0 0 1\n";
  const RenderJob back = decode_job(encode(job));
  CHECK((back.go && back.settings.width == 77 && back.settings.stop.flip == 0.25));
  CHECK((back.compile.max_depth == 3 && back.compile.cull));
  REQUIRE(back.compile.effects);
  CHECK(back.compile.effects->bits() == job.compile.effects->bits());
  CHECK((back.scene_name == job.scene_name && back.scene_nff == job.scene_nff));
  CHECK_FALSE(decode_job(encode(RenderJob())).compile.effects);
}

TEST_CASE("all ranks see the same scene, also one that canonical NFF does not keep whole") {
  const SceneDescription read = parse_nff(kLossyScene, "t").scene;
  const View view = read.view.value();
  const RenderJob job = job_of(read);
  const Shown on_master = shown(compile_scene(job), view);
  const Shown on_worker = shown(compile_scene(decode_job(encode(job))), view);
  CHECK(on_master == on_worker);
  // Control: the scene as it was read is another one.
  CHECK_FALSE(shown(compile(read, job.compile), view).materials == on_worker.materials);
}

TEST_CASE("a scene's canonical text is that of its own parse") {
  const SceneDescription read = parse_nff(kLossyScene, "t").scene;
  const std::string text = canonical_nff(read);
  CHECK(text != kLossyScene);
  CHECK(canonical_nff(parse_nff(text, "t").scene) == text);
}

TEST_CASE("a render job cut short anywhere is refused") {
  RenderJob job;
  job.scene_nff = "s 0 0 0 1\n";
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

}  // namespace pprt
