// pprt-convert: a scene from one form into another.
#pragma once

#include <string>

namespace pprt {

struct ConvertOptions {
  std::string input;   // *.nff, "-" (NFF on standard input) or "spd:NAME[:SIZE]"
  std::string output;  // *.nff, *.pov or "-" (NFF on standard output)
  bool strict = false;
};

// Reads the input and writes the output, which is left alone on failure. Warnings about the scene go to
// standard error. Throws UsageError (a format not known), InputError (the scene), std::runtime_error
// (output).
void convert(const ConvertOptions& options);

}  // namespace pprt
