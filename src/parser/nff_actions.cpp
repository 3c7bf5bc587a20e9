#include "parser/nff_actions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "base/counted.h"
#include "parser/colour_names.h"

namespace pprt::nff {
namespace {

constexpr int kLargestResolution = 65536;  // pixels

// Smallest sine of the angle between the line of sight and up. Below it, rounding would turn the image
// (docs/numerics.md).
constexpr double kSmallestSine = 1e-9;

// Distinct unknown words that warnings name; the others are counted together.
constexpr std::size_t kMostUnknownWords = 8;

bool has(unsigned items, ViewItem item) {
  return items >> static_cast<unsigned>(item) & 1;
}

const Vec3d& position(const Vec3d& vertex) {
  return vertex;
}
const Vec3d& position(const PatchVertex& vertex) {
  return vertex.position;
}

// Returns whether a polygon has no area, as far as its decimal coordinates can tell.
//
// Bound, with u = 2^-53, M the largest coordinate and L the largest difference. Reading rounds a coordinate
// by at most uM, so a difference of two is off by at most 3uM. A component of a cross product of differences
// is off by 4 * 3uM * L from them, and by 3u * L^2 <= 6uM * L from its own rounding. That makes 18uML for
// each of the n - 2 triangles of the fan.
template <typename Vertex>
bool is_flat(const std::vector<Vertex>& vertices) {
  constexpr double kUnit = std::numeric_limits<double>::epsilon() / 2;
  const Vec3d origin = position(vertices[0]);
  Vec3d normal(0, 0, 0);
  Vec3d previous = position(vertices[1]) - origin;
  double largest = 0;  // M
  double extent = 0;   // L
  for (const Vertex& vertex : vertices) {
    const Vec3d& p = position(vertex);
    const Vec3d edge = p - origin;
    for (int i = 0; i < 3; ++i) {
      largest = std::max(largest, std::abs(p[i]));
      extent = std::max(extent, std::abs(edge[i]));
    }
    normal += previous.cross(edge);
    previous = edge;
  }
  const double bound = 18 * kUnit * largest * extent * static_cast<double>(vertices.size());
  return std::abs(normal.x) <= bound && std::abs(normal.y) <= bound && std::abs(normal.z) <= bound;
}

std::string times(std::size_t count) {
  return count > 1 ? fmt::format(" ({} times, first here)", count) : "";
}

}  // namespace

SceneBuilder::SceneBuilder(std::string_view text, std::string_view file_name, const NffOptions& options)
    : text_(text), options_(options), cursor_(text) {
  scene_.name = file_name;
}

// Problems.

void SceneBuilder::add_error(SourceLocation at, std::string message) {
  diagnostics_.error(at, std::move(message));
  if (diagnostics_.error_count() >= options_.max_errors) throw TooManyErrors{};
}

void SceneBuilder::error(const char* place, std::string message) {
  add_error(cursor_.at(place), std::move(message));
}

void SceneBuilder::report(const ParseFailure& failure) {
  error(failure.place, failure.message);
}

void SceneBuilder::deviation(Deviation kind, const char* place) {
  deviation_at(kind, cursor_.at(place));
}

void SceneBuilder::deviation_at(Deviation kind, SourceLocation at) {
  if (options_.strict) return add_error(at, text_of(kind).problem);
  Occurrence& occurrence = deviations_[static_cast<std::size_t>(kind)];
  if (occurrence.count++ == 0) occurrence.first = at;
}

// Counts a comment once, although the gap before an alternative is read again.
void SceneBuilder::comment(Deviation kind, const char* place) {
  if (last_comment_ && place <= last_comment_) return;
  last_comment_ = place;
  deviation(kind, place);
}

void SceneBuilder::unknown(std::string_view word) {
  if (entities_ == 0 && unknown_.empty() &&
      (word == "nff" || word == "NFF" || word == "nff2" || word == "NFF2")) {
    throw ParseFailure{
        word.data(),
        "this is a Sense8 (WorldToolKit) file, another format of the same name: NFF of the Standard "
        "Procedural Databases is expected",
        true};
  }
  std::string name = quoted(word);
  const char* const meaning = foreign_entity(word);
  if (meaning) name += fmt::format(" ({})", meaning);
  if (options_.strict) return error(word.data(), "unknown entity " + name);
  auto place = unknown_.find(name);
  if (place == unknown_.end()) {
    if (unknown_.size() >= kMostUnknownWords) name = "of other kinds";
    place = unknown_.try_emplace(std::move(name)).first;
  }
  if (place->second.count++ == 0) place->second.first = cursor_.at(word.data());
}

bool SceneBuilder::mail_header(std::string_view line) {
  if (entities_ > 0) return false;
  deviation(Deviation::kMailHeader, line.data());
  return true;
}

const Diagnostics& SceneBuilder::finish() {
  for (std::size_t i = 0; i < deviations_.size(); ++i) {
    const DeviationText text = text_of(static_cast<Deviation>(i));
    if (deviations_[i].count == 0 || !text.reading) continue;
    diagnostics_.warning(deviations_[i].first,
                         fmt::format("{}: {}{}", text.problem, text.reading, times(deviations_[i].count)));
  }
  for (const auto& [name, occurrence] : unknown_) {
    diagnostics_.warning(occurrence.first, fmt::format("unknown entity {}: skipped to the end of its line{}",
                                                       name, times(occurrence.count)));
  }
  return diagnostics_;
}

// View, background, lights, materials.

void SceneBuilder::begin_view(std::string_view keyword) {
  begin_entity(keyword);
  view_ = View{};
  view_items_ = 0;
  if (scene_.primitive_count() > 0) deviation(Deviation::kViewAfterObject, keyword.data());
}

void SceneBuilder::view_item(ViewItem item, const char* place) {
  const Vec3d vector(numbers_[0], numbers_[1], numbers_[2]);
  if (has(view_items_, item)) deviation(Deviation::kViewItemRepeated, place);
  view_items_ |= 1u << static_cast<unsigned>(item);
  count_ = 0;
  switch (item) {
    case ViewItem::kFrom:
      view_.from = vector;
      break;
    case ViewItem::kAt:
      view_.at = vector;
      break;
    case ViewItem::kUp:
      view_.up = vector;
      break;
    case ViewItem::kAngle:
      view_.angle_degrees = vector.x;
      if (!(vector.x > 0 && vector.x < 180))
        error(place, "the view's angle must lie between 0 and 180 degrees");
      break;
    case ViewItem::kHither:
      view_.hither = vector.x;
      break;
    case ViewItem::kYon:
      deviation(Deviation::kViewYon, place);
      break;
    case ViewItem::kResolution:
      for (const double size : {vector.x, vector.y}) {
        if (size >= 1 && size <= kLargestResolution && size == std::floor(size)) continue;
        return error(
            place, fmt::format("the resolution must be two whole numbers from 1 to {}", kLargestResolution));
      }
      view_.width = static_cast<int>(vector.x);
      view_.height = static_cast<int>(vector.y);
      break;
  }
}

void SceneBuilder::add_view() {
  const char* const place = entity_.data();
  view_.location = cursor_.at(place);
  std::string missing;
  for (const auto& [item, name] :
       {std::pair(ViewItem::kFrom, "'from'"), std::pair(ViewItem::kAt, "'at'"),
        std::pair(ViewItem::kUp, "'up'"), std::pair(ViewItem::kAngle, "'angle'")}) {
    if (!has(view_items_, item)) missing += (missing.empty() ? "" : ", ") + std::string(name);
  }
  if (!missing.empty()) {
    error(place, "'v' lacks " + missing);
  } else {
    check_view(view_, place);
  }
  if (!has(view_items_, ViewItem::kHither)) deviation(Deviation::kViewWithoutHither, place);
  if (!has(view_items_, ViewItem::kResolution)) deviation(Deviation::kViewWithoutResolution, place);
  if (scene_.view) deviation(Deviation::kViewRepeated, place);
  scene_.view = view_;
}

void SceneBuilder::check_view(const View& view, const char* place) {
  const Vec3d direction = view.at - view.from;
  if (direction == Vec3d(0, 0, 0)) return error(place, "the view's 'from' and 'at' are the same point");
  if (direction.normalized().cross(view.up.normalized()).length() < kSmallestSine) {
    error(place, "the view's 'up' is 0 or points along the line of sight");
  }
}

void SceneBuilder::color_name(std::string_view name) {
  const std::optional<Rgb> named = color_by_name(name);
  if (!named) throw ParseFailure{name.data(), quoted(name) + " is neither a number nor the name of a colour"};
  deviation(Deviation::kColorName, name.data());
  for (const double value : {named->x, named->y, named->z}) number(value, name.data());
}

void SceneBuilder::set_background() {
  if (scene_.background) deviation(Deviation::kBackgroundRepeated, entity_.data());
  scene_.background = color();
}

std::string SceneBuilder::quantity(std::size_t count, const char* wanted) const {
  return fmt::format("'{}' takes {}, found {}", entity_, wanted, count);
}

void SceneBuilder::add_light() {
  if (scene_.primitive_count() > 0) deviation(Deviation::kLightAfterObject, entity_.data());
  Light light;
  light.position = {numbers_[0], numbers_[1], numbers_[2]};
  light.location = cursor_.at(entity_.data());
  if (count_ == 6) {
    light.color = Rgb(numbers_[3], numbers_[4], numbers_[5]);
  } else if (count_ == 7) {
    deviation(Deviation::kLightIntensity, entity_.data());
    light.color = Rgb(numbers_[4], numbers_[5], numbers_[6]) * numbers_[3];
  } else if (count_ != 3) {
    return error(entity_.data(), quantity(count_, "3 numbers (x y z) or 6 (x y z r g b)"));
  }
  if (scene_.lights.size() >= options_.max_lights) {
    throw ParseFailure{entity_.data(), fmt::format("more than {} lights", options_.max_lights), true};
  }
  scene_.lights.push_back(light);
}

// Within the colour any word is an error; after it, the word is the name of a texture.
void SceneBuilder::fill_tail(std::string_view tail) {
  constexpr std::string_view kBlank = " \t\f\v";
  tail.remove_prefix(tail.find_first_not_of(kBlank));
  if (count_ < 3) {
    const std::string_view token = tail.substr(0, tail.find_first_of(kBlank));
    throw ParseFailure{token.data(), fmt::format("expected a number for {} in the colour of 'f', found {}",
                                                 count_ == 1 ? "green" : "blue", quoted(token))};
  }
  deviation(Deviation::kFillTail, tail.data());
}

void SceneBuilder::set_material() {
  constexpr Material kDefault;
  const double missing[kFillNumbers] = {0,
                                        0,
                                        0,
                                        kDefault.diffuse,
                                        kDefault.specular,
                                        kDefault.shine,
                                        kDefault.transmittance,
                                        kDefault.refractive_index};
  if (count_ < 3) {
    deviation(Deviation::kFillGrey, entity_.data());
    for (; count_ < 3; ++count_) numbers_[count_] = numbers_[count_ - 1];
  } else if (count_ < kFillNumbers) {
    deviation(Deviation::kFillShort, entity_.data());
  }
  if (count_ > kFillNumbers) deviation(Deviation::kFillLong, after_fill_);
  for (; count_ < kFillNumbers; ++count_) numbers_[count_] = missing[count_];
  Material material{color(), numbers_[3], numbers_[4], numbers_[5], numbers_[6], numbers_[7]};
  if (material.transmittance > 0 && material.refractive_index <= 0) {
    deviation(Deviation::kGlassIndex, entity_.data());
    material.refractive_index = 1;
  }
  material_ = table_.intern(scene_.materials, material);
  has_material_ = true;
  if (scene_.materials.size() > options_.max_materials) {
    throw ParseFailure{entity_.data(),
                       fmt::format("more than {} different materials", options_.max_materials), true};
  }
}

// Objects.

MaterialIndex SceneBuilder::material() {
  if (!has_material_) {
    has_material_ = true;
    material_ = table_.intern(scene_.materials, Material{});
    deviation(Deviation::kNoFill, entity_.data());
  }
  return material_;
}

SourceLocation SceneBuilder::begin_object() {
  if (scene_.primitive_count() >= options_.max_primitives) {
    throw ParseFailure{entity_.data(), fmt::format("more than {} objects", options_.max_primitives), true};
  }
  // Twice, for lists grow by doubling.
  if (2 * memory_of(scene_) > options_.max_memory)
    throw ParseFailure{entity_.data(), too_much_memory(options_.max_memory), true};
  return cursor_.at(entity_.data());
}

void SceneBuilder::add_sphere() {
  const SourceLocation at = begin_object();
  if (count_ == 6) {
    deviation_at(Deviation::kSphereExtra, at);
  } else if (count_ != 4) {
    return error(entity_.data(), quantity(count_, "4 numbers (x y z radius)"));
  }
  if (numbers_[3] == 0) return deviation_at(Deviation::kSphereZeroRadius, at);
  pprt::add_sphere(scene_, {{numbers_[0], numbers_[1], numbers_[2]}, numbers_[3], material(), at});
}

void SceneBuilder::add_cone() {
  const SourceLocation at = begin_object();
  const Vec3d base(numbers_[0], numbers_[1], numbers_[2]);
  const Vec3d apex(numbers_[4], numbers_[5], numbers_[6]);
  const double base_radius = numbers_[3];
  const double apex_radius = numbers_[7];
  if (base == apex) return deviation_at(Deviation::kConeWithoutLength, at);
  if (base_radius == 0 && apex_radius == 0) return deviation_at(Deviation::kConeWithoutRadius, at);
  if (std::min(base_radius, apex_radius) < 0 && std::max(base_radius, apex_radius) > 0) {
    return deviation_at(Deviation::kConeMixedRadii, at);
  }
  pprt::add_cone(scene_, {base, base_radius, apex, apex_radius, material(), at});
}

// Checks a vertex count before anything is reserved for it. With fewer bytes than vertices left, the count is
// wrong. With a few vertices missing, the error at the first missing number says more.
void SceneBuilder::begin_vertices(std::string_view matched) {
  constexpr std::string_view kPartOfNumber = "0123456789.+-eE";
  const double count = numbers_[0];
  const char* const place = matched.data() + (matched.find_last_not_of(kPartOfNumber) + 1);
  const auto left = static_cast<std::size_t>(text_.data() + text_.size() - (matched.data() + matched.size()));
  polygon_.clear();
  patch_.clear();
  count_ = 0;
  if (count < 0 || count != std::floor(count)) {
    throw ParseFailure{place, fmt::format("the number of vertices of '{}' must be a whole number", entity_)};
  }
  if (count > static_cast<double>(options_.max_polygon_vertices)) {
    throw ParseFailure{
        place, fmt::format("'{}' with more than {} vertices", entity_, options_.max_polygon_vertices)};
  }
  if (count > static_cast<double>(left)) {
    throw ParseFailure{place, fmt::format("'{}' with {} vertices, but only {} left", entity_, count,
                                          counted(left, "byte of the file is", "bytes of the file are"))};
  }
  vertex_count_ = static_cast<std::size_t>(count);
}

std::size_t SceneBuilder::vertex_at_hand() const {
  return vertex_count_ > 0 ? polygon_.size() + patch_.size() + 1 : 0;
}

template <typename Vertex>
bool SceneBuilder::worth_keeping(const std::vector<Vertex>& vertices, SourceLocation at) {
  if (vertices.size() < 3) {
    deviation_at(Deviation::kFewVertices, at);
    return false;
  }
  if (is_flat(vertices)) {
    deviation_at(Deviation::kZeroArea, at);
    return false;
  }
  return true;
}

void SceneBuilder::add_polygon() {
  const SourceLocation at = begin_object();
  if (worth_keeping(polygon_, at)) pprt::add_polygon(scene_, polygon_, material(), at);
}

void SceneBuilder::add_patch() {
  const SourceLocation at = begin_object();
  if (worth_keeping(patch_, at)) pprt::add_patch(scene_, patch_, material(), at);
}

}  // namespace pprt::nff
