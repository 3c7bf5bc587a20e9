// pprt-convert: a scene from one form into another.
#pragma once

#include <optional>
#include <string>

#include "convert/default_view.h"

namespace pprt {

struct ConvertOptions {
  std::string input;   // *.nff, "-" (NFF on standard input), "spd:NAME[:SIZE]" or a mesh that Assimp reads
  std::string output;  // *.nff, "-" (NFF on standard output), *.pov, or one of mesh_output_extensions()
  bool strict = false;
  std::optional<int>
      tessellate;  // Fineness::divisions; absent: curved surfaces stay where the format has them
  std::optional<double> chord_error;  // Fineness::chord_error
  UpAxis up = UpAxis::kY;             // of a view that has to be made up
};

// Reads the input and writes the output, which is left alone on failure. Warnings about the scene, and what
// the output does not keep, go to standard error. Throws UsageError (a format not known), InputError (the
// scene), std::runtime_error (output).
void convert(const ConvertOptions& options);

}  // namespace pprt
