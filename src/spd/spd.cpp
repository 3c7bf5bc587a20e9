#include "spd/spd.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "base/nearest_word.h"
#include "base/printable.h"
#include "spd/generators.h"

namespace pprt {
namespace {

constexpr std::string_view kPrefix = "spd:";

struct Generator {
  double (*count)(double size);  // number of objects, by closed formula
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

// In the order of kDatabases.
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
  throw InputError(printable(fmt::format("{}: error: {}", scene, problem)));
}

std::optional<std::size_t> find_database(std::string_view name) {
  const auto found = std::find_if(kDatabases.begin(), kDatabases.end(),
                                  [name](const SpdDatabase& d) { return d.name == name; });
  if (found == kDatabases.end()) return std::nullopt;
  return static_cast<std::size_t>(found - kDatabases.begin());
}

[[noreturn]] void reject_name(std::string_view scene, std::string_view name) {
  std::vector<std::string_view> names;
  names.reserve(kDatabases.size());
  for (const SpdDatabase& d : kDatabases) names.push_back(d.name);
  reject(scene, fmt::format("no procedural database has the name '{}'{} (there are: {})", name,
                            did_you_mean(name, names), fmt::join(names, " ")));
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
