#include "trace/survey/effects.h"

#include <catch2/catch.hpp>

#include "base/diagnostics.h"
#include "spd/spd.h"
#include "trace/compiled_scene.h"
#include "unit/trace/test_scenes.h"

namespace pprt::effects_test {

using namespace pprt::test;

namespace {

RayCounts picture_counts(const SceneDescription& scene, const CompileOptions& options = {}) {
  const CompiledScene compiled = compile(scene, options);
  View view = *scene.view;
  view.width = view.height = 48;
  Tracer tracer(compiled, compiled.camera(view));
  std::uint64_t rays = 0;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 48; ++x) rays += tracer.trace(x + 0.5, y + 0.5).rays;
  }
  CHECK(rays == tracer.counts().traced());
  return tracer.counts();
}

}  // namespace

TEST_CASE("each database calls for its own effects, and no ray is traced for another") {
  struct Expected {
    const char* database;
    int size;
    const char* effects;
  };
  const Expected all[] = {{"tree", 3, "shadows"},
                          {"tetra", 3, "shadows"},
                          {"balls", 2, "shadows,highlights,reflection"},
                          {"gears", 1, "shadows,highlights,reflection,refraction"},
                          {"mount", 2, "shadows,highlights,reflection,refraction"},
                          {"teapot", 3, "shadows,highlights,reflection,smooth-normals"}};
  for (const Expected& e : all) {
    CAPTURE(e.database);
    const SceneDescription scene = make_spd(e.database, e.size);
    const EffectSet effects = effects_called_for(scene);
    CHECK(to_string(effects) == e.effects);
    const CompiledScene compiled = compile(scene);
    CHECK(compiled.effects() == effects);
    CHECK_THAT(compiled.census(), Catch::Contains("simulated   " + std::string(e.effects) + "\n"));
    const RayCounts counts = picture_counts(scene);
    CHECK((counts.shadow > 0) == effects.has(Effect::kShadows));
    CHECK((counts.reflection > 0) == effects.has(Effect::kReflection));
    CHECK((counts.refraction > 0) == effects.has(Effect::kRefraction));
  }
}

TEST_CASE("a scene without lights traces no shadow ray") {
  SceneDescription scene = make_spd("balls", 2);
  scene.lights.clear();
  CHECK(to_string(effects_called_for(scene)) == "reflection");
  const RayCounts counts = picture_counts(scene);
  CHECK(counts.shadow == 0);
  CHECK(counts.reflection > 0);
  CHECK_THAT(compile(scene).census(), Catch::Contains("shadows         no   no light"));
}

TEST_CASE("emission and a sky are called for where a scene has them") {
  SceneDescription scene = make_spd("tree", 2);
  scene.sky = Sky();
  Material lamp;
  lamp.emission.y = 0.5;
  scene.materials.push_back(lamp);
  CHECK(to_string(effects_called_for(scene)) == "shadows,sky");  // nothing has the material
  scene.spheres.at(0).material = static_cast<MaterialIndex>(scene.materials.size() - 1);
  CHECK(to_string(effects_called_for(scene)) == "shadows,emission,sky");
  const std::string census = compile(scene).census();
  CHECK_THAT(census, Catch::Contains("emission        yes  1 material that gives off light\n"));
  CHECK_THAT(census, Catch::Contains("sky             yes  the background is a sky\n"));
  CHECK_THAT(compile(make_spd("tree", 2)).census(),
             Catch::Contains("sky             no   the background is"));
}

TEST_CASE("a material that no object uses calls for nothing") {
  SceneDescription scene = make_spd("tree", 2);
  Material glass;
  glass.specular = 0.5;
  glass.shine = 10;
  glass.transmittance = 0.5;
  scene.materials.push_back(glass);
  CHECK(to_string(effects_called_for(scene)) == "shadows");
}

TEST_CASE("effects can be ruled out, and the census says so") {
  CompileOptions options;
  options.effects = parse_effects("highlights,refraction");
  const SceneDescription scene = make_spd("mount", 2);
  const RayCounts counts = picture_counts(scene, options);
  CHECK(counts.shadow == 0);
  CHECK(counts.reflection == 0);
  CHECK(counts.refraction > 0);
  CHECK_THAT(compile(scene, options).census(), Catch::Contains("ruled out by the effects asked for"));
}

TEST_CASE("depth 1 traces eye rays and their shadows only") {
  CompileOptions options;
  options.max_depth = 1;
  const RayCounts counts = picture_counts(make_spd("gears", 1), options);
  CHECK(counts.shadow > 0);
  CHECK(counts.reflection + counts.refraction == 0);
}

TEST_CASE("the words for effects are read and written") {
  CHECK(parse_effects("all") == EffectSet::all());
  CHECK(parse_effects("none") == EffectSet());
  CHECK(to_string(EffectSet()) == "none");
  CHECK(parse_effects("shadows, refraction").has(Effect::kRefraction));
  for (const Effect effect : every_effect()) CHECK(parse_effects(name(effect)).has(effect));
  CHECK(parse_effects(to_string(EffectSet::all())) == EffectSet::all());
  CHECK_THROWS_AS(parse_effects("shadow"), UsageError);
  CHECK_THROWS_WITH(parse_effects("shadows,caustics"), Catch::Contains("'caustics'"));
  CHECK_THROWS_AS(parse_effects(""), UsageError);
}

}  // namespace pprt::effects_test
