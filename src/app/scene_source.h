// Where a scene named on a command line comes from.
#pragma once

#include <string>

#include "parser/nff_parser.h"

namespace pprt {

// "spd:NAME[:SIZE]" is generated; anything else is an NFF file, "-" standard input.
// Throws InputError: no such database or file, too large, or rejected by the parser.
ParsedScene load_scene(const std::string& name, const NffOptions& options = {});

}  // namespace pprt
