// pprt-convert: a scene from one format into another.
#pragma once

#include <optional>
#include <string>

#include "convert/default_view.h"

namespace pprt {

struct ConvertOptions {
  std::string
      input;  // *.nff, *.aff, "-" (NFF on standard input), "spd:NAME[:SIZE]" or a mesh that Assimp reads
  std::string output;  // *.nff, "-" (NFF on standard output), *.pov, or one of mesh_output_extensions()
  bool strict = false;
  std::optional<int> tessellate;  // Fineness::divisions; empty: keep curved surfaces if the format has them
  std::optional<double> chord_error;  // Fineness::chord_error
  UpAxis up = UpAxis::kY;             // of an added view
  std::optional<double> at = {};  // time of a scene that moves, seconds; empty: the start of its animation
};

// Reads the input and writes the output, which is left as it was on failure. Prints warnings about the scene,
// and what the output does not keep, on standard error. Throws UsageError for an unknown format and for a
// time of a scene where nothing moves, InputError for the scene, std::runtime_error for the output.
void convert(const ConvertOptions& options);

}  // namespace pprt
