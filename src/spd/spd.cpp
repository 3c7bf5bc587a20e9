#include "spd/spd.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "spd/generators.h"

namespace pprt {
namespace {

constexpr std::string_view kPrefix = "spd:";

struct Generator {
  double (*count)(double size);  // objects, by closed formula
  void (*build)(spd::SceneBuilder& out, int size);
};

constexpr std::array<SpdDatabase, 9> kDatabases = {{{"tree", 11},
                                                    {"balls", 4},
                                                    {"gears", 4},
                                                    {"mount", 6},
                                                    {"rings", 7},
                                                    {"tetra", 6},
                                                    {"teapot", 12},
                                                    {"jacks", 1},
                                                    {"lattice", 12}}};

// As in kDatabases.
constexpr std::array<Generator, 9> kGenerators = {{
    {[](double n) { return 2 * (std::exp2(n + 1) - 1) + 1; }, spd::build_tree},
    {[](double n) { return (std::pow(9, n + 1) - 1) / 8 + 1; }, spd::build_balls},
    {[](double n) { return 146 * n * n * n + 1; }, spd::build_gears},
    {[](double n) { return 2 * std::pow(4, n) + 4; }, spd::build_mount},
    {[](double n) { return 10 * n * (n + 1) * (2 * n + 1) + 1; }, spd::build_rings},
    {[](double n) { return std::pow(4, n); }, spd::build_tetra},
    {[](double n) { return 65 * n * n - 8 * n; }, spd::build_teapot},
    {[](double n) { return 9 * (std::pow(8, n) - 1) / 7; }, spd::build_jacks},
    {[](double n) { return (n + 1) * (n + 1) * (n + 1) + 3 * n * (n + 1) * (n + 1); }, spd::build_lattice},
}};

[[noreturn]] void reject(std::string_view scene, std::string_view problem) {
  throw InputError(fmt::format("{}: error: {}", scene, problem));
}

std::optional<std::size_t> find_database(std::string_view name) {
  const auto found = std::find_if(kDatabases.begin(), kDatabases.end(),
                                  [name](const SpdDatabase& d) { return d.name == name; });
  if (found == kDatabases.end()) return std::nullopt;
  return static_cast<std::size_t>(found - kDatabases.begin());
}

// Number of insertions, deletions and replacements of one byte that turn `a` into `b` (Levenshtein).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({replaced, row[j] + 1, row[j - 1] + 1}));
    }
  }
  return row.back();
}

// ", did you mean 'tree'?" when a name is close enough to be a slip of the finger; else nothing.
std::string suggestion(std::string_view name) {
  constexpr std::size_t kMostSlips = 2;
  constexpr std::size_t kLongestName = 32;
  if (name.size() > kLongestName) return {};
  const auto nearest = std::min_element(kDatabases.begin(), kDatabases.end(), [name](auto& a, auto& b) {
    return edit_distance(name, a.name) < edit_distance(name, b.name);
  });
  if (edit_distance(name, nearest->name) > kMostSlips) return {};
  return fmt::format("; did you mean '{}'?", nearest->name);
}

std::string all_names() {
  std::string names;
  for (const SpdDatabase& d : kDatabases) {
    if (!names.empty()) names += ' ';
    names += d.name;
  }
  return names;
}

[[noreturn]] void reject_name(std::string_view scene, std::string_view name) {
  reject(scene, fmt::format("no procedural database has the name '{}'{} (there are: {})", name,
                            suggestion(name), all_names()));
}

int largest_size(const Generator& generator) {
  int size = 1;
  while (generator.count(size + 1) <= kMaxSpdPrimitives) ++size;
  return size;
}

void check_size(std::string_view scene, const Generator& generator, int size) {
  if (size < 1) reject(scene, "the size must be at least 1");
  const double count = generator.count(size);
  if (count > kMaxSpdPrimitives) {
    reject(scene, fmt::format("too large: {:.3g} primitives, the limit is {:.3g} (size {})", count,
                              kMaxSpdPrimitives, largest_size(generator)));
  }
}

}  // namespace

std::span<const SpdDatabase> spd_databases() {
  return kDatabases;
}

double spd_primitive_count(std::string_view name, int size) {
  return kGenerators[find_database(name).value()].count(size);
}

SceneDescription make_spd(std::string_view name, std::optional<int> size) {
  const auto index = find_database(name);
  if (!index) reject_name(fmt::format("{}{}", kPrefix, name), name);
  const Generator& generator = kGenerators[*index];
  const int used_size = size.value_or(kDatabases[*index].default_size);
  std::string scene_name = fmt::format("{}{}:{}", kPrefix, name, used_size);
  check_size(scene_name, generator, used_size);

  spd::SceneBuilder builder;
  builder.scene.name = std::move(scene_name);
  builder.scene.order.reserve(static_cast<std::size_t>(generator.count(used_size)));
  generator.build(builder, used_size);
  return std::move(builder.scene);
}

bool is_spd_name(std::string_view scene) {
  return scene.starts_with(kPrefix);
}

SceneDescription make_spd_scene(std::string_view scene) {
  if (!is_spd_name(scene)) reject(scene, "not of the form spd:NAME[:SIZE]");
  const std::string_view rest = scene.substr(kPrefix.size());
  const std::size_t colon = std::min(rest.find(':'), rest.size());
  const std::string_view name = rest.substr(0, colon);
  const auto index = find_database(name);
  if (!index) reject_name(scene, name);
  if (colon == rest.size()) return make_spd(name);

  const std::string_view digits = rest.substr(colon + 1);
  int size = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), size);
  if (end != digits.data() + digits.size() || digits.empty() || error == std::errc::invalid_argument) {
    reject(scene, fmt::format("the size '{}' is not a whole number", digits));
  }
  if (error == std::errc::result_out_of_range) {
    reject(scene, fmt::format("too large: the largest size is {}", largest_size(kGenerators[*index])));
  }
  return make_spd(name, size);
}

}  // namespace pprt
