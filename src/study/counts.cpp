#include "study/counts.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "base/diagnostics.h"
#include "cli/scene_source.h"
#include "trace/compiled_scene.h"

namespace pprt {
namespace {

constexpr int kPublishedCorners = 513;

struct PublishedRow {
  std::string_view scene;
  StudiedCounts counts;
};

// The table has no column for total internal reflection.
constexpr std::array kPublished = {
    PublishedRow{"spd:balls:4", {263169, 175095, 0, 0, 954368}},
    PublishedRow{"spd:gears:4", {245086, 304643, 207564, 0, 2246955}},
    PublishedRow{"spd:mount:6", {173125, 354769, 354769, 0, 412922}},
    PublishedRow{"spd:rings:7", {263169, 315236, 0, 0, 1085002}},
    PublishedRow{"spd:teapot:12", {161120, 225248, 0, 0, 407656}},
    PublishedRow{"spd:tetra:6", {49788, 0, 0, 0, 46112}},
    PublishedRow{"spd:tree:11", {169836, 0, 0, 0, 1097419}},
};

// One number of the table.
struct Column {
  const char* name;
  std::uint64_t StudiedCounts::*value;
};

constexpr std::array kColumns = {
    Column{"eye hits", &StudiedCounts::eye_hits},
    Column{"reflect", &StudiedCounts::reflect},
    Column{"refract", &StudiedCounts::refract},
    Column{"shadow", &StudiedCounts::shadow},
};

double difference_percent(std::uint64_t counted, std::uint64_t published) {
  if (counted == published) return 0;
  if (published == 0) return std::numeric_limits<double>::infinity();
  const auto reference = static_cast<double>(published);
  return 100 * (static_cast<double>(counted) - reference) / reference;
}

bool within(const StudiedCounts& counted, const StudiedCounts& published, double tolerance_percent) {
  for (const Column& column : kColumns) {
    const double difference = difference_percent(counted.*column.value, published.*column.value);
    if (!(std::abs(difference) <= tolerance_percent)) return false;
  }
  return true;
}

std::string table_lines(const std::string& scene, const StudiedCounts& counted,
                        const std::optional<StudiedCounts>& published, double tolerance_percent) {
  std::string text;
  for (const Column& column : kColumns) {
    const std::uint64_t count = counted.*column.value;
    text += fmt::format("{:<16} {:<8} {:>10} ", &column == kColumns.data() ? scene : "", column.name, count);
    if (published) {
      const double difference = difference_percent(count, (*published).*column.value);
      text += fmt::format("{:>10} {:>+9.3f} %{}", (*published).*column.value, difference,
                          std::abs(difference) <= tolerance_percent ? "" : "  beyond the tolerance");
    } else {
      text += fmt::format("{:>10} {:>11}", "-", "-");
    }
    text += '\n';
  }
  return text;
}

std::string json_line(const std::string& scene, const StudiedCounts& counted) {
  return nlohmann::ordered_json{{"scene", scene},
                                {"eye_hits", counted.eye_hits},
                                {"reflect", counted.reflect},
                                {"refract", counted.refract},
                                {"tir", counted.tir},
                                {"shadow", counted.shadow}}
             .dump() +
         "\n";
}

// The published statistics take opaque surfaces as one-sided in every scene but this.
bool is_spd_teapot(std::string_view scene) {
  return scene.substr(0, 11) == "spd:teapot:";
}

std::vector<std::string> published_scenes() {
  std::vector<std::string> scenes;
  for (const PublishedRow& row : kPublished) scenes.emplace_back(row.scene);
  return scenes;
}

}  // namespace

std::optional<StudiedCounts> published_counts(std::string_view scene) {
  for (const PublishedRow& row : kPublished) {
    if (row.scene == scene) return row.counts;
  }
  return std::nullopt;
}

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

bool study_counts(const CountsOptions& options) {
  bool all_within = true;
  if (!options.json) {
    std::cout << fmt::format("{:<16} {:<8} {:>10} {:>10} {:>11}\n", "scene", "rays", "counted", "published",
                             "difference");
  }
  for (const std::string& name : options.scenes.empty() ? published_scenes() : options.scenes) {
    const ParsedScene parsed = load_scene(name);
    std::cerr << parsed.warnings;
    const std::string& scene = parsed.scene.name;
    const StudiedCounts counted =
        count_rays(parsed.scene, options.corners, options.two_sided || is_spd_teapot(scene));
    const auto published =
        options.corners == kPublishedCorners ? published_counts(scene) : std::optional<StudiedCounts>();
    if (published && !within(counted, *published, options.tolerance_percent)) all_within = false;
    std::cout << (options.json ? json_line(scene, counted)
                               : table_lines(scene, counted, published, options.tolerance_percent));
    std::cout.flush();
  }
  if (!std::cout) throw std::runtime_error("cannot write to standard output");
  return all_within;
}

}  // namespace pprt
