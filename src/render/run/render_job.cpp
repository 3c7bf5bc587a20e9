#include "render/run/render_job.h"

#include "base/wire.h"
#include "scene/bytes/scene_bytes.h"

namespace pprt {

CompiledScene compile_scene(const RenderJob& job) {
  return compile(decode_scene(job.scene), job.compile);
}

Bytes encode(const RenderJob& job) {
  WireWriter out;
  out.put(job.go), out.put(job.again), out.put_all<std::byte>(encode(job.settings));
  out.put(job.compile.max_depth), out.put(job.compile.cull);
  out.put(job.compile.effects.has_value()), out.put(job.compile.effects.value_or(EffectSet()).bits());
  out.put_all<std::byte>(job.scene);
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
  in.get_all(job.scene);
  in.expect_end();
  return job;
}

}  // namespace pprt
