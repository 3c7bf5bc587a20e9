#include "render/options/examples.h"

#include <filesystem>
#include <string_view>
#include <system_error>

namespace pprt {
namespace {

// SCENES stands for their folder.
constexpr std::string_view kExamples = R"(# A still, rendered until it looks converged
pprt-render spd:tree -s 256x256 -o tree.png

# A still as good as asked for: an estimated FLIP of 0.02, the error that the eye sees
pprt-render spd:balls -s 256x256 --quality 0.02 -o balls.png

# An animation on two ranks, each frame by its deadline: pictures, a film, figures for each frame
pprt-render SCENES/demo.anim --frames 1-8 -np 2 -o demo/%04d.png --film demo/demo.gif --stats demo/ledger.ndjson

# A scene that moves, at 24 frames a second
pprt-render SCENES/carousel.aff -s 320x180 --fps 24 --frames 1-24 -o carousel/%04d.png

# The same pictures in every run and under any load: the clock counts work
pprt-render SCENES/demo.anim --frames 1-2 --clock work -o same/%04d.exr

# How a frame came about: its samples, their triangulation, the regions of the ranks
pprt-render spd:tree -s 256x256 --samples 19000 -np 2 --layers samples,triangulation,regions -o how.png

# What a scene consists of, and which effects it calls for
pprt-render spd:gears:2 --census

# Watch and steer from a browser, until Ctrl-C
pprt-render SCENES/demo.anim --live 8080)";

// Returns the folder of the scenes as a user would name it.
std::string scenes_folder() {
  std::error_code unknown;
  const bool in_sources = std::filesystem::exists("scenes/demo.anim", unknown);
  const bool installed = std::filesystem::exists(PPRT_INSTALLED_SCENES "/demo.anim", unknown);
  return installed && !in_sources ? PPRT_INSTALLED_SCENES : "scenes";
}

}  // namespace

std::string first_steps() {
  return "pprt-render needs a scene. To begin with:\n"
         "  pprt-render spd:tree -s 256x256 -o tree.png\n"
         "More commands: pprt-render --examples. All options: pprt-render --help all\n";
}

std::string examples() {
  constexpr std::string_view kPlace = "SCENES";
  std::string text(kExamples);
  const std::string folder = scenes_folder();
  for (std::size_t at = 0; (at = text.find(kPlace, at)) != std::string::npos; at += folder.size())
    text.replace(at, kPlace.size(), folder);
  return text;
}

}  // namespace pprt
