#include "study/accuracy/effects.h"

#include "study/accuracy/methods.h"
#include "study/accuracy/statistics.h"

namespace pprt {
namespace {

constexpr int kCells = 2;  // 8 samples per pixel: their own error is small against that of a missing effect

// A scene as it is simulated, and what repeats of a picture took.
struct Variant {
  std::string name;
  CompiledScene scene;
  RayCounts counts = {};
  std::vector<double> time_ratios = {};
};

std::vector<Variant> variants_of(const SceneDescription& description) {
  std::vector<Variant> variants;
  const auto add = [&](const std::string& its_name, const CompileOptions& options) {
    variants.push_back({its_name, compile(description, options)});
  };
  add("all effects called for", {});
  const EffectSet effects = variants.front().scene.effects();
  for (const Effect effect : every_effect()) {
    const EffectSet others(effects.bits() & ~static_cast<unsigned>(effect));
    if (effects.has(effect)) add("without " + std::string(name(effect)), {.effects = others});
  }
  add("without any", {.effects = EffectSet()});
  return variants;
}

// CPU time of one sample per pixel, in scan lines.
double scan_seconds(const Subject& subject, RayCounts& counts) {
  Tracer tracer = tracer_of(subject);
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

std::vector<EffectCost> measure_effects(const std::string& scene_name, const SceneDescription& description,
                                        const Camera& camera, const Image& reference, int repeats) {
  std::vector<Variant> variants = variants_of(description);
  for (int repeat = 0; repeat < repeats; ++repeat) {
    double of_whole = 0;
    for (Variant& variant : variants) {
      const double seconds = scan_seconds({variant.scene, camera}, variant.counts);
      if (&variant == variants.data()) of_whole = seconds;
      variant.time_ratios.push_back(seconds / of_whole);
    }
  }
  std::vector<EffectCost> costs;
  for (const Variant& v : variants) {
    const Image picture = converged_reference({v.scene, camera}, kCells).image;
    costs.push_back({scene_name, v.name, spread_of(v.time_ratios).median,
                     static_cast<double>(v.counts.traced()) / static_cast<double>(v.counts.primary),
                     rmse_of(picture, reference)});
  }
  return costs;
}

Table effects_table(const std::vector<EffectCost>& costs) {
  return table_of<EffectCost>(costs, {{"scene", &EffectCost::scene},
                                      {"simulated", &EffectCost::variant},
                                      {"time", &EffectCost::time_ratio},
                                      {"rays an eye ray", &EffectCost::rays_per_eye},
                                      {"rmse", &EffectCost::rmse}});
}

}  // namespace pprt
