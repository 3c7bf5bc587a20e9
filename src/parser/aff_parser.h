// Reads AFF, the Animated File Format of BART (Lext, Assarsson and Moller 2000), through all its includes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "parser/parsed_scene.h"
#include "parser/text/reading_memory.h"
#include "scene/movement/movement_limits.h"

namespace pprt {

// How a scene is read. The limits keep hostile or broken files from exhausting memory.
struct AffOptions {
  bool strict = false;          // every deviation is an error, also one that causes no warning
  bool files_anywhere = false;  // included files may lie outside the folder of the scene

  int max_depth = 64;                                 // of includes
  int max_transforms = kMostTransforms;               // in each other
  std::size_t max_reads = 100'000;                    // of files
  std::size_t max_bytes = std::size_t{1} << 30;       // read in all
  std::size_t max_rows = 20'000'000;                  // of one list
  std::size_t max_items = 100'000'000;                // objects, vertices, keys and transforms, in all
  std::uint64_t max_memory = usual_reading_memory();  // bytes that the scene may take
  std::size_t max_errors = 1'000;                     // reading stops here
};

// Reads a scene from memory, which can include no file. `file_name` is for messages. Throws as read_aff().
ParsedScene parse_aff(std::string_view text, std::string_view file_name, const AffOptions& options = {});

// Reads a scene from a file. An included file lies beside the one that includes it, or beside the scene.
// Throws InputError with every problem of every file, each with file:line:column.
ParsedScene read_aff(const std::string& path, const AffOptions& options = {});

}  // namespace pprt
