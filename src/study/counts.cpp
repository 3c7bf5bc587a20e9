#include "study/counts.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "base/diagnostics.h"
#include "cli/scene_source.h"
#include "trace/compiled_scene.h"

namespace pprt {
namespace {

constexpr int kPublishedCorners = 513;

struct StudiedCounts {
  std::uint64_t eye_hits = 0;
  std::uint64_t reflect = 0;
  std::uint64_t refract = 0;  // as published: includes tir
  std::uint64_t tir = 0;      // prevented by total internal reflection
  std::uint64_t shadow = 0;
};

struct PublishedRow {
  std::string_view scene;
  StudiedCounts counts;
};

constexpr std::array kPublished = {
    PublishedRow{"spd:balls:4", {263169, 175095, 0, 0, 954368}},
    PublishedRow{"spd:gears:4", {245086, 304643, 207564, 0, 2246955}},
    PublishedRow{"spd:mount:6", {173125, 354769, 354769, 0, 412922}},
    PublishedRow{"spd:rings:7", {263169, 315236, 0, 0, 1085002}},
    PublishedRow{"spd:teapot:12", {161120, 225248, 0, 0, 407656}},
    PublishedRow{"spd:tetra:6", {49788, 0, 0, 0, 46112}},
    PublishedRow{"spd:tree:11", {169836, 0, 0, 0, 1097419}},
};

// The numbers of a scene, with their names in the table (none: not published) and in JSON.
struct CountName {
  const char* name;
  const char* json;
  std::uint64_t StudiedCounts::*value;
};

constexpr std::array kNames = {CountName{"eye hits", "eye_hits", &StudiedCounts::eye_hits},
                               CountName{"reflect", "reflect", &StudiedCounts::reflect},
                               CountName{"refract", "refract", &StudiedCounts::refract},
                               CountName{nullptr, "tir", &StudiedCounts::tir},
                               CountName{"shadow", "shadow", &StudiedCounts::shadow}};

double difference_percent(std::uint64_t counted, std::uint64_t published) {
  if (counted == published) return 0;
  if (published == 0) return std::numeric_limits<double>::infinity();
  const auto reference = static_cast<double>(published);
  return 100 * (static_cast<double>(counted) - reference) / reference;
}

// Returns a line per published number, and clears `all_within` when one is beyond the tolerance.
std::string table_lines(const std::string& scene, const StudiedCounts& counted,
                        const std::optional<StudiedCounts>& published, double tolerance_percent,
                        bool& all_within) {
  std::string text;
  for (const auto& [name, json, value] : kNames) {
    if (!name) continue;
    text += fmt::format("{:<16} {:<8} {:>10} ", text.empty() ? scene : "", name, counted.*value);
    if (published) {
      const double difference = difference_percent(counted.*value, (*published).*value);
      const bool within = std::abs(difference) <= tolerance_percent;
      all_within = all_within && within;
      text += fmt::format("{:>10} {:>+9.3f} %{}\n", (*published).*value, difference,
                          within ? "" : "  beyond the tolerance");
    } else {
      text += fmt::format("{:>10} {:>11}\n", "-", "-");
    }
  }
  return text;
}

std::string json_line(const std::string& scene, const StudiedCounts& counted) {
  nlohmann::ordered_json line{{"scene", scene}};
  for (const CountName& count : kNames) line[count.json] = counted.*count.value;
  return line.dump() + "\n";
}

// Haines, SPD 3.14, "Database Analysis": 513 x 513 eye rays, depth 5.
std::optional<StudiedCounts> published_counts(std::string_view scene) {
  for (const PublishedRow& row : kPublished) {
    if (row.scene == scene) return row.counts;
  }
  return std::nullopt;
}

// Traces one ray through each pixel corner of the scene's view.
StudiedCounts count_rays(const SceneDescription& scene, int corners, bool two_sided) {
  if (!scene.view) throw InputError(scene.name + ": error: the scene has no view");
  CompileOptions options;
  options.cull = !two_sided;
  options.count_as_published = true;
  const CompiledScene compiled = compile(scene, options);
  View view = *scene.view;
  view.width = view.height = corners - 1;
  Tracer tracer(compiled, compiled.camera(view));
  for (int y = 0; y < corners; ++y) {
    for (int x = 0; x < corners; ++x) tracer.trace(x, y);
  }
  const RayCounts& counts = tracer.counts();
  return {counts.eye_hits, counts.reflection, counts.refraction + counts.total_internal_reflection,
          counts.total_internal_reflection, counts.shadow};
}

}  // namespace

bool study_counts(const CountsOptions& options) {
  bool all_within = true;
  if (!options.json) {
    std::cout << fmt::format("{:<16} {:<8} {:>10} {:>10} {:>11}\n", "scene", "rays", "counted", "published",
                             "difference");
  }
  std::vector<std::string> scenes = options.scenes;
  if (scenes.empty()) {
    for (const PublishedRow& row : kPublished) scenes.emplace_back(row.scene);
  }
  for (const std::string& name : scenes) {
    const ParsedScene parsed = load_scene(name);
    std::cerr << parsed.warnings;
    const std::string& scene = parsed.scene.name;
    const bool two_sided =
        options.two_sided || scene.starts_with("spd:teapot:");  // as the published statistics
    const StudiedCounts counted = count_rays(parsed.scene, options.corners, two_sided);
    std::optional<StudiedCounts> published;
    if (options.corners == kPublishedCorners) published = published_counts(scene);
    const std::string table = table_lines(scene, counted, published, options.tolerance_percent, all_within);
    std::cout << (options.json ? json_line(scene, counted) : table) << std::flush;
  }
  if (!std::cout) throw std::runtime_error("cannot write to standard output");
  return all_within;
}

}  // namespace pprt
