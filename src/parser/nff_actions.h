// Actions of the NFF grammar: what each rule does once it has matched. The result is a SceneDescription.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "parser/nff_grammar.h"
#include "parser/nff_messages.h"
#include "parser/nff_parser.h"
#include "parser/text/parser_input.h"
#include "parser/text/text_input.h"
#include "scene/description/scene_description.h"

namespace pprt::nff {

// A place from which the current entity, or the whole file if fatal, cannot be read on.
struct ParseFailure {
  const char* place;
  std::string message;
  bool fatal = false;
};

// The parts of a view.
enum class ViewItem : unsigned { kFrom, kAt, kUp, kAngle, kHither, kYon, kResolution };

// Thrown after NffOptions::max_errors errors.
struct TooManyErrors {};

// Builds the scene while it is read. Actions collect the numbers of an entity; at its end they become a value
// of the scene.
class SceneBuilder {
 public:
  SceneBuilder(std::string_view text, std::string_view file_name, const NffOptions& options);

  // Called by the actions, in the order of the grammar.
  void number(double value, const char* place) {
    if (count_ < numbers_.size()) numbers_[count_] = value;
    if (count_ == kFillNumbers) after_fill_ = place;
    ++count_;
  }
  void begin_entity(std::string_view keyword) {
    entity_ = keyword;
    count_ = 0;
    vertex_count_ = 0;
    ++entities_;
  }
  void begin_view(std::string_view keyword);
  void view_item(ViewItem item, const char* place);
  void add_view();
  void color_name(std::string_view name);
  void set_background();
  void add_light();
  void fill_tail(std::string_view tail);
  void set_material();
  void add_sphere();
  void add_cone();
  void begin_vertices(std::string_view matched);
  std::size_t rows() const { return vertex_count_; }
  void polygon_vertex() {
    polygon_.emplace_back(numbers_[0], numbers_[1], numbers_[2]);
    count_ = 0;
  }
  void patch_vertex() {
    patch_.push_back({{numbers_[0], numbers_[1], numbers_[2]}, {numbers_[3], numbers_[4], numbers_[5]}});
    count_ = 0;
  }
  void add_polygon();
  void add_patch();
  bool mail_header(std::string_view line);
  void unknown(std::string_view word);
  void deviation(Deviation kind, const char* place);
  void comment(Deviation kind, const char* place);

  // Called by the driver.
  void report(const ParseFailure& failure);
  void try_at(const char* place) { tried_ = place; }
  const char* tried() const { return tried_; }  // where the last rule that must match was tried
  std::string_view entity() const { return entity_; }
  std::size_t vertex_at_hand() const;  // from 1; 0 outside a list of vertices
  SourceLocation locate(const char* place) { return cursor_.at(place); }
  std::size_t entities() const { return entities_; }
  const Diagnostics& finish();  // adds the warnings
  SceneDescription& scene() { return scene_; }

 private:
  static constexpr std::size_t kFillNumbers = 8;  // of a complete 'f'

  struct Occurrence {
    std::size_t count = 0;
    SourceLocation first;
  };

  void error(const char* place, std::string message);
  void add_error(SourceLocation at, std::string message);
  void deviation_at(Deviation kind, SourceLocation at);
  void check_view(const View& view, const char* place);
  Rgb color() const { return {numbers_[0], numbers_[1], numbers_[2]}; }
  MaterialIndex material();
  SourceLocation begin_object();
  template <typename Vertex>
  bool worth_keeping(const std::vector<Vertex>& vertices, SourceLocation at);
  std::string quantity(std::size_t count, const char* wanted) const;

  std::string_view text_;
  const NffOptions& options_;
  LineCursor cursor_;
  Diagnostics diagnostics_;
  SceneDescription scene_;
  MaterialTable table_;

  // The current entity.
  std::string_view entity_;  // its keyword, a view into the text
  std::array<double, 16> numbers_{};
  std::size_t count_ = 0;             // numbers read, including those beyond the array
  const char* after_fill_ = nullptr;  // the number after the first kFillNumbers, if there is one
  std::size_t vertex_count_ = 0;
  std::vector<Vec3d> polygon_;
  std::vector<PatchVertex> patch_;
  View view_;
  unsigned view_items_ = 0;  // one bit per ViewItem

  std::size_t entities_ = 0;
  bool has_material_ = false;
  MaterialIndex material_ = 0;
  const char* tried_ = nullptr;
  const char* last_comment_ = nullptr;
  std::array<Occurrence, static_cast<std::size_t>(Deviation::kCount)> deviations_{};
  std::map<std::string, Occurrence, std::less<>> unknown_;
};

template <typename Rule>
struct action : grammar::pegtl::nothing<Rule> {};

template <>
struct action<grammar::number> : grammar::pegtl::nothing<grammar::number> {
  static void value(double value, const char* place, SceneBuilder& builder) { builder.number(value, place); }
};

template <Deviation Kind>
struct deviating_comment {
  template <typename Input>
  static void apply(const Input& in, SceneBuilder& builder) {
    builder.comment(Kind, in.begin());
  }
};
template <ViewItem Item>
struct part_of_view {
  template <typename Input>
  static void apply(const Input& in, SceneBuilder& builder) {
    builder.view_item(Item, in.begin());
  }
};

template <>
struct action<grammar::percent_comment> : deviating_comment<Deviation::kPercentComment> {};
template <>
struct action<grammar::block_comment> : deviating_comment<Deviation::kBlockComment> {};

template <>
struct action<grammar::view_keyword> : with_text<&SceneBuilder::begin_view> {};
template <>
struct action<grammar::view_from> : part_of_view<ViewItem::kFrom> {};
template <>
struct action<grammar::view_at> : part_of_view<ViewItem::kAt> {};
template <>
struct action<grammar::view_up> : part_of_view<ViewItem::kUp> {};
template <>
struct action<grammar::view_angle> : part_of_view<ViewItem::kAngle> {};
template <>
struct action<grammar::view_hither> : part_of_view<ViewItem::kHither> {};
template <>
struct action<grammar::view_yon> : part_of_view<ViewItem::kYon> {};
template <>
struct action<grammar::view_resolution> : part_of_view<ViewItem::kResolution> {};
template <>
struct action<grammar::view> : without_text<&SceneBuilder::add_view> {};

template <>
struct action<grammar::color_name> : with_text<&SceneBuilder::color_name> {};
template <>
struct action<grammar::background_keyword> : with_text<&SceneBuilder::begin_entity> {};
template <>
struct action<grammar::background> : without_text<&SceneBuilder::set_background> {};
template <>
struct action<grammar::light_keyword> : with_text<&SceneBuilder::begin_entity> {};
template <>
struct action<grammar::light> : without_text<&SceneBuilder::add_light> {};
template <>
struct action<grammar::fill_keyword> : with_text<&SceneBuilder::begin_entity> {};
template <>
struct action<grammar::fill_tail> : with_text<&SceneBuilder::fill_tail> {};
template <>
struct action<grammar::fill> : without_text<&SceneBuilder::set_material> {};

template <>
struct action<grammar::sphere_keyword> : with_text<&SceneBuilder::begin_entity> {};
template <>
struct action<grammar::sphere> : without_text<&SceneBuilder::add_sphere> {};
template <>
struct action<grammar::cone_keyword> : with_text<&SceneBuilder::begin_entity> {};
template <>
struct action<grammar::cone> : without_text<&SceneBuilder::add_cone> {};

template <>
struct action<grammar::vertex_count> : with_text<&SceneBuilder::begin_vertices> {};
template <>
struct action<grammar::polygon_keyword> : with_text<&SceneBuilder::begin_entity> {};
template <>
struct action<grammar::polygon_vertex> : without_text<&SceneBuilder::polygon_vertex> {};
template <>
struct action<grammar::polygon> : without_text<&SceneBuilder::add_polygon> {};
template <>
struct action<grammar::patch_keyword> : with_text<&SceneBuilder::begin_entity> {};
template <>
struct action<grammar::patch_vertex> : without_text<&SceneBuilder::patch_vertex> {};
template <>
struct action<grammar::patch> : without_text<&SceneBuilder::add_patch> {};

template <>
struct action<grammar::header_begin> {
  template <typename Input>
  static bool apply(const Input& in, SceneBuilder& builder) {
    return builder.mail_header({in.begin(), in.size()});
  }
};
template <>
struct action<grammar::unknown_word> : with_text<&SceneBuilder::unknown> {};

}  // namespace pprt::nff
