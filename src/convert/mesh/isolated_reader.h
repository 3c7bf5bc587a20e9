// Reading meshes where a damaged file can do no harm.
#pragma once

#include <cstdint>
#include <string>

#include "base/isolated_call.h"
#include "convert/mesh/mesh_reader.h"

namespace pprt {

// What reading a mesh may take.
struct MeshLimits {
  double seconds = 120;                                 // of the processor; four times as long in all
  std::uint64_t memory_bytes = usual_reading_memory();  // of the scene; reading may take four times as much
  std::string animation = {};                           // MeshOptions::animation
};

// Returns what the process that reads may take. `available`: memory that this host has left, bytes.
CallLimits call_limits(const MeshLimits& limits, std::uint64_t available);

// Returns what read_mesh() does, in a process of its own: libraries crash on some damaged files and read
// others without end. This process must not have other threads. Throws InputError also for these.
ReadMesh read_mesh_isolated(const std::string& path, const MeshLimits& limits = {});

}  // namespace pprt
