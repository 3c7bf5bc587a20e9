// Where a scene named on a command line comes from.
#pragma once

#include <string>
#include <vector>

#include "parser/nff_parser.h"

namespace pprt {

// "spd:NAME[:SIZE]" is generated; anything else is an NFF file, "-" standard input.
// Throws InputError: no such database or file, too large, or rejected by the parser.
ParsedScene load_scene(const std::string& name, const NffOptions& options = {});

// "spd:tree" and the like, of every database.
std::vector<std::string> generated_scenes();

// "; did you mean 'spd:teapot'?" for the name of a file that is not there: a file beside where it should be,
// or a scene that is generated; or nothing.
std::string hint_at_meant(const std::string& name);

// Throws InputError when there is no such file, with what could have been meant: a file beside where it
// should be, or a scene that is generated.
void require_file(const std::string& path);

}  // namespace pprt
