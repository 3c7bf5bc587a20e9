// Reads NFF, the Neutral File Format of Haines' Standard Procedural Databases (NFF.TXT 3.9).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "parser/parsed_scene.h"
#include "parser/text/reading_memory.h"

namespace pprt {

// How a scene file is read. The limits keep a hostile or broken file from exhausting memory. The defaults
// allow a hundred times the largest SPD scene (mount of size 8: 131,076 objects, 11 MB).
struct NffOptions {
  bool strict = false;  // every deviation from NFF.TXT is an error, also one that causes no warning

  std::size_t max_bytes = std::size_t{512} << 20;
  std::size_t max_primitives = 20'000'000;
  std::size_t max_polygon_vertices = 1'000'000;  // per 'p' or 'pp'
  std::size_t max_lights = 10'000;
  std::size_t max_materials = 1'000'000;              // distinct materials
  std::uint64_t max_memory = usual_reading_memory();  // bytes that the scene may take
  std::size_t max_errors = 1'000;                     // reading stops here
};

// Reads a scene from memory. `file_name` is for messages and becomes the scene's name. Throws InputError with
// every problem of the text.
ParsedScene parse_nff(std::string_view text, std::string_view file_name, const NffOptions& options = {});

// Reads a scene from a file; "-" is standard input. Throws InputError also for a file that cannot be read.
ParsedScene read_nff(const std::string& path, const NffOptions& options = {});

}  // namespace pprt
