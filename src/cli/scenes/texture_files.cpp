#include "cli/scenes/texture_files.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <string>
#include <system_error>

#include "base/diagnostics.h"
#include "base/printable.h"
#include "image/image_io.h"
#include "parser/text/reading_memory.h"

namespace pprt {
namespace {

namespace fs = std::filesystem;

// A name is plain: textures lie in no other folder.
std::optional<fs::path> find_texture(const std::string& name, const fs::path& folder) {
  if (fs::path(name).filename() != fs::path(name)) return std::nullopt;
  for (const char* place : {"", "TextureFiles", "../TextureFiles"}) {
    const fs::path path = folder / place / name;
    std::error_code unknown;
    if (fs::is_regular_file(path, unknown)) return path;
  }
  return std::nullopt;
}

}  // namespace

void fill(Texture& texture, const Image& image) {
  texture.width = image.width, texture.height = image.height;
  texture.rgb.reserve(3 * image.pixels.size());
  for (const Color& pixel : image.pixels) {
    for (int i = 0; i < 3; ++i)
      texture.rgb.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(pixel[i], 0.F, 1.F))));
  }
}

void read_textures(ParsedScene& parsed, const fs::path& folder, std::uint64_t max_memory) {
  SceneDescription& scene = parsed.scene;
  std::string problems;
  std::uint64_t taken = memory_of(scene);
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    Texture& texture = scene.textures[i];
    const auto note = [&](const std::string& problem) {
      problems += (problems.empty() ? "" : "\n") + parsed.texture_places[i] + ": error: " + problem;
    };
    const std::optional<fs::path> path = find_texture(texture.name, folder);
    if (!path) {
      note("there is no texture '" + printable(texture.name) +
           "' beside the scene, in TextureFiles/ or in ../TextureFiles/");
      continue;
    }
    try {
      fill(texture, read_image(*path, max_memory - std::min(max_memory, taken)));
      parsed.files.push_back(path->string());
      taken += texture.rgb.size();
    } catch (const std::exception& e) {
      note(e.what());
    }
  }
  if (!problems.empty()) throw InputError(problems);
}

}  // namespace pprt
