// Actions of the AFF grammar: what each rule does once it has matched. The result is a SceneDescription.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "parser/aff_grammar.h"
#include "parser/aff_messages.h"
#include "parser/aff_parser.h"
#include "parser/text/parser_input.h"
#include "parser/text/text_input.h"

namespace pprt::aff {

// A place from which the current directive, or everything if fatal, cannot be read on.
struct ParseFailure {
  const char* place;
  std::string message;
  bool fatal = false;
};

// Thrown after AffOptions::max_errors errors, and after a fatal one.
struct TooManyErrors {};
struct Stopped {};

// A file, however often it is read.
struct SourceFile {
  std::string name;  // for messages
  std::string text;
  Diagnostics diagnostics = {};
};

// Builds the scene while it is read. Actions collect the numbers of a directive; at its end they become a
// value of the scene.
class SceneBuilder {
 public:
  // `read_included` reads a file into this builder: by its name, and the place where the name stands.
  using ReadIncluded = std::function<void(std::string_view name)>;
  SceneBuilder(const AffOptions& options, ReadIncluded read_included);

  // --- Called by the actions, in the order of the grammar

  void number(double value, const char* place) {
    if (numbers_.size() < places_.size()) places_[numbers_.size()] = place;
    numbers_.push_back(value);
  }
  void name(std::string_view text) { name_ = text; }
  void begin(std::string_view keyword);
  void count(std::string_view matched);
  std::size_t rows() const { return rows_; }
  void add_view();
  void set_background() { scene_.background = color_at(0); }
  void set_sky();
  void set_ambient() { scene_.ambient = color_at(0); }
  void add_light();
  void add_named_light();
  void add_sun();
  void set_fill();
  void set_material();
  void set_emission();
  void set_textured_emission();
  void add_sphere();
  void add_cone();
  void corner();  // of a polygon
  void smooth_corner();
  void add_polygon();
  void add_textured();
  void add_smooth_textured();
  void moving_key();
  void add_moving();
  void mesh_position();
  void mesh_normal();
  void mesh_texture_point();
  std::size_t indices_of_a_row() const;
  void triangle();
  void add_mesh();
  void include();
  void set_detail();
  void begin_static();
  void begin_animated();
  void close(std::string_view brace);
  void translation_key();
  void rotation_key();
  void scale_key();
  void visibility_key();
  void end_curve();  // of a track, whose keys must be enough
  void end_visibility();
  void add_track();
  void set_times();

  // --- Called by the driver

  void enter(SourceFile& file);
  void leave();
  const SourceFile& file() const { return *open_.back().file; }
  std::size_t depth() const { return open_.size(); }
  void report(const ParseFailure& failure) { error(failure.place, failure.message); }
  void try_at(const char* place) { tried_ = place; }
  const char* tried() const { return tried_; }  // where the last rule that must match was tried
  std::string_view directive() const { return keyword_; }
  SourceLocation locate(const char* place) { return open_.back().cursor.at(place); }
  void finish();  // adds the warnings
  SceneDescription& scene() { return scene_; }
  std::vector<std::string>& texture_places() { return texture_places_; }

 private:
  struct OpenFile {
    SourceFile* file;
    LineCursor cursor;
    std::size_t nodes;  // open when it began
  };
  struct Occurrence {
    std::size_t count = 0;
    SourceFile* file = nullptr;
    SourceLocation first = {};
  };
  struct OpenNode {
    NodeIndex node;
    SourceLocation location;
  };

  void error(const char* place, std::string message);
  void deviation(Deviation kind);
  Vec3d vector_at(std::size_t first) const {
    return {numbers_[first], numbers_[first + 1], numbers_[first + 2]};
  }
  Rgb color_at(std::size_t first) const {
    return {numbers_[first], numbers_[first + 1], numbers_[first + 2]};
  }
  KeyShape shape_at(std::size_t first) const {
    return {numbers_[first], numbers_[first + 1], numbers_[first + 2]};
  }
  int whole(double value, const char* what, int least, int most);
  void use(const Material& material);
  void require_material();
  MaterialIndex material();
  void stand_in_node(std::size_t primitives);
  SourceLocation location_in_scene();
  TextureIndex texture();
  void begin_node(const Affine& to_parent, std::string track);
  void add_corners();
  void count_kept(std::size_t items, std::size_t bytes);
  template <typename Key>
  void check_times(const std::vector<Key>& keys);

  const AffOptions& options_;
  ReadIncluded read_included_;
  SceneDescription scene_;
  MaterialTable materials_;
  std::map<std::string, TextureIndex, std::less<>> textures_;
  std::vector<OpenFile> open_;
  std::vector<OpenNode> nodes_ = {{0, {}}};  // the world, and the transforms that are open
  std::map<std::string, MotionTrack, std::less<>> tracks_;
  std::array<Occurrence, static_cast<std::size_t>(Deviation::kCount)> deviations_{};
  std::size_t errors_ = 0;
  std::size_t kept_ = 0;  // items
  std::uint64_t kept_bytes_ = 0;
  std::vector<std::string> texture_places_;
  int detail_ = 0;
  bool has_material_ = false;
  Material material_;

  // The current directive.
  std::string_view keyword_, name_;
  std::vector<double> numbers_;
  std::size_t rows_ = 0;
  TriangleMesh mesh_;
  std::vector<TriangleCorners> triangles_of_mesh_;
  MovingTriangle moving_;
  MotionTrack track_;
  const char* tried_ = nullptr;
  std::array<const char*, 9> places_{};  // of the first numbers at hand: a triangle has nine at most
};

template <typename Rule>
struct action : grammar::pegtl::nothing<Rule> {};

template <>
struct action<grammar::number> : grammar::pegtl::nothing<grammar::number> {
  static void value(double value, const char* place, SceneBuilder& builder) { builder.number(value, place); }
};

template <>
struct action<grammar::name_token> : with_text<&SceneBuilder::name> {};
template <grammar::Text What>
struct action<grammar::count<What>> : with_text<&SceneBuilder::count> {};

template <>
struct action<grammar::view_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::view> : without_text<&SceneBuilder::add_view> {};
template <>
struct action<grammar::background_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::background> : without_text<&SceneBuilder::set_background> {};
template <>
struct action<grammar::sky_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::sky> : without_text<&SceneBuilder::set_sky> {};
template <>
struct action<grammar::ambient_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::ambient> : without_text<&SceneBuilder::set_ambient> {};
template <>
struct action<grammar::light_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::light> : without_text<&SceneBuilder::add_light> {};
template <>
struct action<grammar::sun_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::sun> : without_text<&SceneBuilder::add_sun> {};
template <>
struct action<grammar::named_light_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::named_light> : without_text<&SceneBuilder::add_named_light> {};
template <>
struct action<grammar::fill_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::fill> : without_text<&SceneBuilder::set_fill> {};
template <>
struct action<grammar::material_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::material> : without_text<&SceneBuilder::set_material> {};

template <>
struct action<grammar::emission_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::emission> : without_text<&SceneBuilder::set_emission> {};
template <>
struct action<grammar::textured_emission_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::textured_emission> : without_text<&SceneBuilder::set_textured_emission> {};

template <>
struct action<grammar::sphere_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::sphere> : without_text<&SceneBuilder::add_sphere> {};
template <>
struct action<grammar::cone_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::cone> : without_text<&SceneBuilder::add_cone> {};
template <>
struct action<grammar::polygon_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::polygon_row> : without_text<&SceneBuilder::corner> {};
template <>
struct action<grammar::polygon> : without_text<&SceneBuilder::add_polygon> {};
template <>
struct action<grammar::patch_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::patch_row> : without_text<&SceneBuilder::smooth_corner> {};
template <>
struct action<grammar::patch> : without_text<&SceneBuilder::add_polygon> {};
template <>
struct action<grammar::textured_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::textured> : without_text<&SceneBuilder::add_textured> {};
template <>
struct action<grammar::smooth_textured_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::smooth_textured> : without_text<&SceneBuilder::add_smooth_textured> {};
template <>
struct action<grammar::moving_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::moving_row> : without_text<&SceneBuilder::moving_key> {};
template <>
struct action<grammar::moving> : without_text<&SceneBuilder::add_moving> {};

template <>
struct action<grammar::mesh_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::mesh_position> : without_text<&SceneBuilder::mesh_position> {};
template <>
struct action<grammar::mesh_normal> : without_text<&SceneBuilder::mesh_normal> {};
template <>
struct action<grammar::mesh_texture_point> : without_text<&SceneBuilder::mesh_texture_point> {};
template <>
struct action<grammar::mesh> : without_text<&SceneBuilder::add_mesh> {};

template <>
struct action<grammar::include_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::include> : without_text<&SceneBuilder::include> {};
template <>
struct action<grammar::detail_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::detail> : without_text<&SceneBuilder::set_detail> {};
template <>
struct action<grammar::static_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::static_begin> : without_text<&SceneBuilder::begin_static> {};
template <>
struct action<grammar::animated_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::animated_begin> : without_text<&SceneBuilder::begin_animated> {};
template <>
struct action<grammar::close_brace> : with_text<&SceneBuilder::close> {};

template <>
struct action<grammar::track_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::translation_row> : without_text<&SceneBuilder::translation_key> {};
template <>
struct action<grammar::rotation_row> : without_text<&SceneBuilder::rotation_key> {};
template <>
struct action<grammar::scale_row> : without_text<&SceneBuilder::scale_key> {};
template <>
struct action<grammar::visibility_row> : without_text<&SceneBuilder::visibility_key> {};
template <>
struct action<grammar::translation_keys> : without_text<&SceneBuilder::end_curve> {};
template <>
struct action<grammar::rotation_keys> : without_text<&SceneBuilder::end_curve> {};
template <>
struct action<grammar::scale_keys> : without_text<&SceneBuilder::end_curve> {};
template <>
struct action<grammar::visibility_keys> : without_text<&SceneBuilder::end_visibility> {};
template <>
struct action<grammar::track> : without_text<&SceneBuilder::add_track> {};
template <>
struct action<grammar::times_keyword> : with_text<&SceneBuilder::begin> {};
template <>
struct action<grammar::times> : without_text<&SceneBuilder::set_times> {};

}  // namespace pprt::aff
