// pprt-convert: a scene from one format into another.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "convert/default_view.h"
#include "convert/mesh/isolated_reader.h"

namespace pprt {

struct ConvertOptions {
  // *.nff, *.aff, "-" (NFF on standard input), "spd:NAME[:SIZE]" or a mesh that Assimp reads
  std::string input;
  // *.nff, "-" (NFF on standard output), *.aff, *.pov, or one of mesh_output_extensions()
  std::string output;
  bool strict = false;
  std::optional<std::uint64_t> memory = {};  // bytes that reading may take; empty: a share of what is there
  std::optional<int> tessellate =
      {};  // Fineness::divisions; empty: keep curved surfaces if the format has them
  std::optional<double> chord_error = {};  // Fineness::chord_error
  UpAxis up = UpAxis::kY;                  // of an added view
  // Time at which a scene that moves is taken, seconds. Empty: its movement, where the format has that; else
  // the start of its animation.
  std::optional<double> at = {};
  std::string animation = {};                  // MeshOptions::animation
  double mesh_seconds = MeshLimits().seconds;  // MeshLimits::seconds
};

// Reads the input and writes the output, which is left as it was on failure. Prints warnings about the scene,
// and what the output does not keep, on standard error. Throws InputError for the scene, std::runtime_error
// for the output. Throws UsageError:
// - for an unknown format
// - for a time of a scene where nothing moves
// - for an output that is a file read besides the input
void convert(const ConvertOptions& options);

}  // namespace pprt
