// What every rank needs to know before a run. The master reads and checks it once and broadcasts it.
#pragma once

#include <string>

#include "parallel/network/communicator.h"
#include "parallel/session_settings.h"
#include "scene/scene_description.h"
#include "trace/compiled_scene.h"

namespace pprt {

// All ranks, the master's too, compile the scene from the same text: what canonical NFF does not keep, such
// as unused materials, exists for none of them.
struct RenderJob {
  bool go = false;     // false: there is nothing to render, or an error; the ranks leave
  bool again = false;  // another job follows when this one is done
  SessionSettings settings;
  CompileOptions compile;
  std::string scene_name;  // for messages
  std::string scene_nff;   // canonical: see scene/nff_writer.h; empty: that of the job before
};

// Returns the scene's text in canonical NFF.
std::string canonical_nff(const SceneDescription& scene);

// Compiles the job's scene. Equal jobs give equal scenes.
CompiledScene compile_scene(const RenderJob& job);

// For the broadcast. decode_job() throws ProtocolError for bytes that encode() cannot have made.
Bytes encode(const RenderJob& job);
RenderJob decode_job(const Bytes& bytes);

}  // namespace pprt
