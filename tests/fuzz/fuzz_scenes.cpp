// libFuzzer entry. Any scene of AFF that is put together by its structure must be an InputError, or a scene
// whose indices are in range and that is finite at every time. It must then be refused in words, or compiled
// and traced at several times.
#include <cstddef>
#include <cstdint>
#include <span>

#include "aff_invariants.h"
#include "aff_text.h"
#include "base/diagnostics.h"
#include "parser/aff_parser.h"
#include "trace/compiled_scene.h"

namespace {

// The files of textures are not there: a texel stands for each.
void give_texels(pprt::SceneDescription& scene) {
  for (pprt::Texture& texture : scene.textures) {
    texture.width = texture.height = 1;
    texture.rgb = {200, 100, 50};
  }
}

void trace_some(const pprt::SceneDescription& scene) {
  const pprt::CompiledScene compiled = pprt::compile(scene);
  pprt::Tracer tracer(compiled, {});
  for (const double time : {0.0, 0.5, 3.0}) {
    tracer.set_time(time);
    tracer.set_camera(compiled.camera(*pprt::view_at(scene, time)));
    for (const double at : {0.5, 1.5, 2.5, 3.5}) {
      tracer.trace(at, 3 - at);
      tracer.first_hit(at, at);
      tracer.glass_seen(at, 2);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = pprt::fuzz::aff_text({data, size});
  try {
    pprt::SceneDescription scene = pprt::parse_aff(text, "fuzz.aff").scene;
    pprt::fuzz::require_indices_in_range(scene);
    pprt::fuzz::require_finite_at_all_times(scene);
    give_texels(scene);
    trace_some(scene);
  } catch (const pprt::InputError&) {
  }
  return 0;
}
