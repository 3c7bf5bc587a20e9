// pprt-study counts: rays by kind, counted by the rules of Haines' tables, beside what he published.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene_description.h"

namespace pprt {

struct CountsOptions {
  std::vector<std::string> scenes;  // as load_scene takes them; empty: every scene with published counts
  double tolerance_percent = 0.5;
  int corners = 513;       // corners x corners eye rays, of an image of (corners - 1)^2 pixels
  bool two_sided = false;  // opaque surfaces seen from both sides in every scene; else only in SPD's teapot
  bool json = false;
};

struct StudiedCounts {
  std::uint64_t eye_hits = 0;
  std::uint64_t reflect = 0;
  std::uint64_t refract = 0;  // as published: with those that total internal reflection turned away
  std::uint64_t tir = 0;      // these
  std::uint64_t shadow = 0;

  friend bool operator==(const StudiedCounts&, const StudiedCounts&) = default;
};

// Haines, SPD 3.14, "Database Analysis": 513 x 513 eye rays, depth 5. `scene` as make_spd names it.
std::optional<StudiedCounts> published_counts(std::string_view scene);

// One ray through each pixel corner of the scene's view. Throws InputError when the scene has no view.
StudiedCounts count_rays(const SceneDescription& scene, int corners, bool two_sided);

// Prints the table, or a JSON object a line, on standard output. False when a published number was missed by
// more than the tolerance.
bool study_counts(const CountsOptions& options);

}  // namespace pprt
