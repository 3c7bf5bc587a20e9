#include "study/accuracy/effects.h"

#include <utility>

#include "study/accuracy/curves.h"
#include "study/accuracy/reference.h"
#include "study/accuracy/verdicts.h"

namespace pprt {
namespace {

constexpr int kCells = 2;  // 8 samples a pixel: effects differ by more than the rest of its error

struct Variant {
  std::string name;
  CompileOptions options;
};

std::vector<Variant> variants_of(EffectSet effects) {
  std::vector<Variant> variants = {{"all effects called for", {}}};
  for (const Effect effect : every_effect()) {
    if (!effects.has(effect)) continue;
    CompileOptions options;
    options.effects = EffectSet(effects.bits() & ~static_cast<unsigned>(effect));
    variants.push_back({"without " + std::string(name(effect)), options});
  }
  CompileOptions none, general;
  none.effects = EffectSet();
  general.general_kernel = true;
  variants.push_back({"without any", none});
  variants.push_back({"the general kernel", general});
  return variants;
}

// Seconds for one sample a pixel, in scan lines.
double scan_seconds(const Subject& subject, const SecondsClock& clock, RayCounts& counts) {
  Tracer tracer(subject.scene, subject.camera);
  float sum = 0;
  const double begin = clock();
  for (int y = 0; y < subject.camera.height; ++y) {
    for (int x = 0; x < subject.camera.width; ++x) sum += tracer.trace(x + 0.5, y + 0.5).color.x;
  }
  const double seconds = clock() - begin;
  counts = tracer.counts();
  // Uses the sum, so that nothing measured is left out by the compiler.
  return sum < 0 ? 0 : seconds;
}

}  // namespace

SceneEffects measure_effects(const std::string& scene_name, const SceneDescription& description,
                             const Camera& camera, const Image& reference, int repeats,
                             const SecondsClock& clock) {
  const CompiledScene whole = compile(description);
  SceneEffects result{scene_name, whole.census(), {}};
  const std::vector<Variant> variants = variants_of(whole.effects());
  std::vector<CompiledScene> scenes;
  scenes.reserve(variants.size());
  for (const Variant& v : variants) scenes.push_back(compile(description, v.options));
  std::vector<RayCounts> counts(variants.size());
  std::vector<std::vector<double>> ratios(variants.size());
  for (int repeat = 0; repeat < repeats; ++repeat) {
    double of_whole = 0;
    for (std::size_t i = 0; i < variants.size(); ++i) {
      const double seconds = scan_seconds({scenes[i], camera}, clock, counts[i]);
      if (i == 0) of_whole = seconds;
      ratios[i].push_back(seconds / of_whole);
    }
  }
  for (std::size_t i = 0; i < variants.size(); ++i) {
    const Image picture = converged_reference({scenes[i], camera}, kCells).image;
    result.costs.push_back({scene_name, variants[i].name, spread_of(ratios[i]).median,
                            static_cast<double>(counts[i].traced()) / static_cast<double>(counts[i].primary),
                            rmse_of(picture, reference)});
  }
  return result;
}

Table effects_table(const std::vector<SceneEffects>& scenes) {
  Table table{{"scene", "simulated", "time", "rays an eye ray", "rmse"}, {}, {}};
  for (const SceneEffects& scene : scenes) {
    for (const EffectCost& c : scene.costs) {
      table.rows.push_back({c.scene, c.variant, c.time_ratio, c.rays_per_eye, c.rmse});
    }
  }
  return table;
}

}  // namespace pprt
