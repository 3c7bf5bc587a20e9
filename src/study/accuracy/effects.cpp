#include "study/accuracy/effects.h"

#include <utility>

#include "study/accuracy/methods.h"
#include "study/accuracy/statistics.h"

namespace pprt {
namespace {

constexpr int kCells = 2;  // 8 samples per pixel: their own error is small against that of a missing effect

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

// CPU time of one sample per pixel, in scan lines.
double scan_seconds(const Subject& subject, RayCounts& counts) {
  Tracer tracer(subject.scene, subject.camera);
  float sum = 0;
  const double begin = thread_cpu_seconds();
  for (int y = 0; y < subject.camera.height; ++y) {
    for (int x = 0; x < subject.camera.width; ++x) sum += tracer.trace(x + 0.5, y + 0.5).color.x;
  }
  const double seconds = thread_cpu_seconds() - begin;
  counts = tracer.counts();
  return sum < 0 ? 0 : seconds;  // uses the sum, so that the compiler leaves nothing out
}

}  // namespace

SceneEffects measure_effects(const std::string& scene_name, const SceneDescription& description,
                             const Camera& camera, const Image& reference, int repeats) {
  const CompiledScene whole = compile(description);
  SceneEffects result{whole.census(), {}};
  const std::vector<Variant> variants = variants_of(whole.effects());
  std::vector<CompiledScene> scenes;
  scenes.reserve(variants.size());
  for (const Variant& v : variants) scenes.push_back(compile(description, v.options));
  std::vector<RayCounts> counts(variants.size());
  std::vector<std::vector<double>> ratios(variants.size());
  for (int repeat = 0; repeat < repeats; ++repeat) {
    double of_whole = 0;
    for (std::size_t i = 0; i < variants.size(); ++i) {
      const double seconds = scan_seconds({scenes[i], camera}, counts[i]);
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
  std::vector<EffectCost> costs;
  for (const SceneEffects& scene : scenes) costs.insert(costs.end(), scene.costs.begin(), scene.costs.end());
  return table_of<EffectCost>(costs, {{"scene", &EffectCost::scene},
                                      {"simulated", &EffectCost::variant},
                                      {"time", &EffectCost::time_ratio},
                                      {"rays an eye ray", &EffectCost::rays_per_eye},
                                      {"rmse", &EffectCost::rmse}});
}

}  // namespace pprt
