#include "convert/mesh/isolated_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>

#include "base/diagnostics.h"
#include "base/system/available_memory.h"
#include "base/wire.h"
#include "scene/bytes/scene_bytes.h"

namespace pprt {
namespace {

// What comes back begins with whether the mesh has been read.
Bytes rejected(const std::string& report) {
  WireWriter out;
  out.put(false), out.put(report);
  return out.take();
}

Bytes accepted(const ReadMesh& mesh) {
  WireWriter out;
  out.put(true);
  for (const auto* lines : {&mesh.notes, &mesh.files}) {
    out.put(static_cast<std::uint64_t>(lines->size()));
    for (const std::string& line : *lines) out.put(line);
  }
  Bytes bytes = out.take();
  const Bytes scene = encode(mesh.scene);
  bytes.insert(bytes.end(), scene.begin(), scene.end());
  return bytes;
}

Bytes answer(const std::string& path, const MeshOptions& options) {
  try {
    return accepted(read_mesh(path, options));
  } catch (const InputError& e) {
    return rejected(e.what());
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::length_error&) {
    throw;
  } catch (const std::exception& e) {
    return rejected(path + ": error: " + e.what());
  }
}

// Throws InputError for a rejected mesh.
ReadMesh mesh_of(const Bytes& answer) {
  WireReader in(answer);
  bool is_read = false;
  in.get(is_read);
  if (!is_read) {
    std::string report;
    in.get(report);
    throw InputError(report);
  }
  ReadMesh mesh;
  for (auto* lines : {&mesh.notes, &mesh.files}) {
    std::uint64_t count = 0;
    in.get(count);
    for (; count > 0; --count) in.get(lines->emplace_back());
  }
  mesh.scene = decode_scene(in.rest());
  return mesh;
}

std::string problem_of(const CallResult& result, const MeshLimits& limits) {
  switch (result.end) {
    case CallEnd::kNoTime:
      return fmt::format("reading it takes more than {:g} seconds (--mesh-seconds allows more)",
                         limits.seconds);
    case CallEnd::kNoMemory:
      return too_much_memory(limits.memory_bytes);
    default:
      return fmt::format("it is damaged, or has something that cannot be read: reading it ended in {}",
                         result.signal == 0 ? "an unknown error" : strsignal(result.signal));
  }
}

}  // namespace

CallLimits call_limits(const MeshLimits& limits, std::uint64_t available) {
  constexpr double kWallShare = 4;
  constexpr std::uint64_t kLibraryShare =
      4;  // it holds the file, a library's scene and this program's at a time
  const std::uint64_t memory =
      limits.memory_bytes < available / kLibraryShare ? kLibraryShare * limits.memory_bytes : available;
  return {.memory_bytes = memory, .cpu_seconds = limits.seconds, .wall_seconds = kWallShare * limits.seconds};
}

ReadMesh read_mesh_isolated(const std::string& path, const MeshLimits& limits) {
  const CallResult result = call_isolated(
      [&] {
        return answer(path, {limits.memory_bytes, limits.animation});
      },
      call_limits(limits, available_memory()));
  if (result.end != CallEnd::kDone) throw InputError(path + ": error: " + problem_of(result, limits));
  return mesh_of(result.bytes);
}

}  // namespace pprt
