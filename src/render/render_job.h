// What the master tells all ranks before a run: scene and settings, read and checked once.
#pragma once

#include <string>

#include "parallel/network/communicator.h"
#include "parallel/session_settings.h"
#include "trace/compiled_scene.h"

namespace pprt {

struct RenderJob {
  bool go = false;  // false: the master found nothing to do or an error; the ranks leave
  SessionSettings settings;
  CompileOptions compile;
  std::string scene_nff;  // canonical NFF: exact, see scene/nff_writer.h
};

Bytes encode(const RenderJob& job);
RenderJob decode_job(const Bytes& bytes);

}  // namespace pprt
