// What every rank needs to know before a run. The master reads and checks it once and broadcasts it.
#pragma once

#include "parallel/network/communicator.h"
#include "parallel/settings/session_settings.h"
#include "trace/compiled_scene.h"

namespace pprt {

// Other processes compile the scene from the bytes of what the first has read.
struct RenderJob {
  bool go = false;     // false: there is nothing to render, or an error; the ranks leave
  bool again = false;  // another job follows when this one is done
  SessionSettings settings{.sampler = SamplerChoice::kAuto};
  CompileOptions compile;
  Bytes scene;  // see scene_bytes.h; empty: that of the job before
};

// Compiles the job's scene. Equal jobs give equal scenes.
CompiledScene compile_scene(const RenderJob& job);

// For the broadcast. decode_job() throws ProtocolError for bytes that encode() cannot have made.
Bytes encode(const RenderJob& job);
RenderJob decode_job(const Bytes& bytes);

}  // namespace pprt
