#include "render/render_job.h"

#include <limits>
#include <sstream>
#include <utility>

#include "parallel/network/wire.h"
#include "parser/nff_parser.h"
#include "scene/nff_writer.h"

namespace pprt {
namespace {

// Canonical text may be longer than the file it was made from, which has passed the limits.
NffOptions without_limits() {
  NffOptions options;
  options.max_bytes = options.max_primitives = options.max_polygon_vertices = options.max_lights =
      options.max_materials = std::numeric_limits<std::size_t>::max();
  return options;
}

}  // namespace

std::string canonical_nff(const SceneDescription& scene) {
  std::ostringstream text;
  write_nff(scene, text);
  return std::move(text).str();
}

CompiledScene compile_scene(const RenderJob& job) {
  return compile(parse_nff(job.scene_nff, job.scene_name, without_limits()).scene, job.compile);
}

Bytes encode(const RenderJob& job) {
  WireWriter out;
  out.put(job.go), out.put(job.again), out.put_all<std::byte>(encode(job.settings));
  out.put(job.compile.max_depth), out.put(job.compile.cull);
  out.put(job.compile.effects.has_value()), out.put(job.compile.effects.value_or(EffectSet()).bits());
  out.put(job.scene_name), out.put(job.scene_nff);
  return out.take();
}

RenderJob decode_job(const Bytes& bytes) {
  WireReader in(bytes);
  RenderJob job;
  Bytes settings;
  bool restricted = false;
  unsigned effects = 0;
  in.get(job.go), in.get(job.again), in.get_all(settings);
  job.settings = decode_settings(settings);
  in.get(job.compile.max_depth), in.get(job.compile.cull);
  in.get(restricted), in.get(effects);
  if ((effects & ~EffectSet::all().bits()) != 0)
    throw ProtocolError("a message holds effects that there are not");
  if (restricted) job.compile.effects = EffectSet(effects);
  in.get(job.scene_name), in.get(job.scene_nff);
  in.expect_end();
  return job;
}

}  // namespace pprt
