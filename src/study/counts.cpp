#include "study/counts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "base/counted.h"
#include "base/diagnostics.h"
#include "cli/scenes/scene_source.h"
#include "study/frame_series.h"

namespace pprt {
namespace {

constexpr int kPublishedCorners = 513;

// The numbers of a scene, with their names in the table and in JSON.
struct CountKind {
  const char* name;  // null: not published
  const char* json;
  std::uint64_t (*of)(const RayCounts& counts);
};

constexpr std::array kKinds = {
    CountKind{"eye hits", "eye_hits", [](const RayCounts& c) { return c.eye_hits; }},
    CountKind{"reflect", "reflect", [](const RayCounts& c) { return c.reflection; }},
    CountKind{"refract", "refract",
              [](const RayCounts& c) { return c.refraction + c.total_internal_reflection; }},
    CountKind{nullptr, "tir", [](const RayCounts& c) { return c.total_internal_reflection; }},
    CountKind{"shadow", "shadow", [](const RayCounts& c) { return c.shadow; }}};

using Published = std::array<std::uint64_t, kKinds.size()>;

// Haines, SPD 3.14, "Database Analysis": 513 x 513 eye rays, depth 5.
const std::vector<std::pair<std::string, Published>> kPublished = {
    {"spd:balls:4", {263169, 175095, 0, 0, 954368}},
    {"spd:gears:4", {245086, 304643, 207564, 0, 2246955}},
    {"spd:mount:6", {173125, 354769, 354769, 0, 412922}},
    {"spd:rings:7", {263169, 315236, 0, 0, 1085002}},
    {"spd:teapot:12", {161120, 225248, 0, 0, 407656}},
    {"spd:tetra:6", {49788, 0, 0, 0, 46112}},
    {"spd:tree:11", {169836, 0, 0, 0, 1097419}},
};

double difference_percent(std::uint64_t counted, std::uint64_t published) {
  if (counted == published) return 0;
  if (published == 0) return std::numeric_limits<double>::infinity();
  const auto reference = static_cast<double>(published);
  return 100 * (static_cast<double>(counted) - reference) / reference;
}

// Returns a line per published number, and clears `all_within` when one is beyond the tolerance. `published`
// may be null.
std::string table_lines(const std::string& scene, const RayCounts& counts, const Published* published,
                        double tolerance_percent, bool& all_within) {
  std::string text;
  for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
    const char* name = kKinds[kind].name;
    if (!name) continue;
    const std::uint64_t counted = kKinds[kind].of(counts);
    text += fmt::format("{:<16} {:<8} {:>10} ", text.empty() ? scene : "", name, counted);
    if (published) {
      const double difference = difference_percent(counted, (*published)[kind]);
      const bool within = std::abs(difference) <= tolerance_percent;
      all_within = all_within && within;
      text += fmt::format("{:>10} {:>+9.3f} %{}\n", (*published)[kind], difference,
                          within ? "" : "  beyond the tolerance");
    } else {
      text += fmt::format("{:>10} {:>11}\n", "-", "-");
    }
  }
  return text;
}

std::string json_line(const std::string& scene, const RayCounts& counts) {
  nlohmann::ordered_json line{{"scene", scene}};
  for (const CountKind& kind : kKinds) line[kind.json] = kind.of(counts);
  return line.dump() + "\n";
}

// Returns what to tell of a scene that stands beside no published number.
std::string why_not_comparable(const std::string& scene, int corners) {
  const std::string database = scene.substr(0, scene.rfind(':'));
  for (const auto& [name, counts] : kPublished) {
    if (name == scene)
      return fmt::format("{}: nothing is published for {}, only for {}\n", scene,
                         counted(corners, "corner", "corners"), kPublishedCorners);
    if (name.starts_with(database + ":"))
      return fmt::format("{}: nothing is published for this size, only for {}\n", scene, name);
  }
  return fmt::format("{}: nothing is published for this scene\n", scene);
}

// Traces one ray through each pixel corner of the scene's view.
RayCounts count_rays(const SceneDescription& scene, int corners, bool two_sided) {
  if (!scene.view) throw InputError(scene.name + ": error: the scene has no view");
  CompileOptions options;
  options.cull = !two_sided;
  options.count_as_published = true;
  const CompiledScene compiled = compile(scene, options);
  Tracer tracer(compiled, square_camera(compiled, *scene.view, corners - 1));
  for (int y = 0; y < corners; ++y) {
    for (int x = 0; x < corners; ++x) tracer.trace(x, y);
  }
  return tracer.counts();
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
    for (const auto& [name, counts] : kPublished) scenes.push_back(name);
  }
  for (const std::string& name : scenes) {
    const ParsedScene parsed = load_scene(name);
    std::cerr << parsed.warnings;
    const std::string& scene = parsed.scene.name;
    const bool as_published = scene.starts_with("spd:teapot:");  // which is counted two-sided
    const RayCounts counts = count_rays(parsed.scene, options.corners, options.two_sided || as_published);
    const auto published = std::find_if(kPublished.begin(), kPublished.end(),
                                        [&](const auto& row) { return row.first == scene; });
    const bool comparable = options.corners == kPublishedCorners && published != kPublished.end();
    if (!comparable && !options.json) std::cerr << why_not_comparable(scene, options.corners);
    const std::string table = table_lines(scene, counts, comparable ? &published->second : nullptr,
                                          options.tolerance_percent, all_within);
    std::cout << (options.json ? json_line(scene, counts) : table) << std::flush;
  }
  if (!std::cout) throw std::runtime_error("cannot write to standard output");
  return all_within;
}

}  // namespace pprt
