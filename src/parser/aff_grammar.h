// The grammar of AFF, the Animated File Format of BART: rules only.
//
// Tokens are separated by blanks, line ends and comments, which begin with # or %. Braces are tokens of their
// own, also without a blank. A rule that has a text in aff_messages.h must match once it is reached.
#pragma once

#include <algorithm>
#include <cstddef>
#include <tao/pegtl.hpp>
#include <tao/pegtl/contrib/analyze_traits.hpp>

#include "parser/scene_rules.h"

namespace pprt::aff::grammar {

namespace pegtl = tao::pegtl;
using pegtl::any;
using pegtl::at;
using pegtl::eof;
using pegtl::not_at;
using pegtl::one;
using pegtl::opt;
using pegtl::plus;
using pegtl::seq;
using pegtl::sor;
using pegtl::star;
using pegtl::string;
using rules::number_begin;
using rules::rows;

// A text as a parameter of a rule.
template <std::size_t N>
struct Text {
  char text[N] = {};
  consteval Text(const char (&literal)[N]) { std::copy_n(literal, N, text); }  // NOLINT: implicit on purpose
};

// --- Tokens

struct blank : one<' ', '\t', '\f', '\v', '\n', '\r'> {};
struct comment : seq<one<'#', '%'>, star<pegtl::not_one<'\n', '\r'>>> {};
struct gap : star<sor<blank, comment>> {};
struct token_end : sor<eof, blank, one<'#', '%', '{', '}'>> {};
struct token : sor<one<'{', '}'>, plus<not_at<token_end>, any>> {};

struct number : rules::finite_number<number> {
  static bool ends_token(const char* p, const char* end) {
    return p == end || std::string_view(" \t\f\v\n\r#%{}").find(*p) != std::string_view::npos;
  }
};

// A number that must stand here: what it is.
template <Text What>
struct num : seq<gap, number> {};
// A word that must stand here.
template <Text Word>
struct word {
  using rule_t = word;
  using subs_t = pegtl::empty_list;

  template <pegtl::apply_mode, pegtl::rewind_mode, template <typename...> class, template <typename...> class,
            typename Input, typename... States>
  static bool match(Input& in, States&&...) {
    pegtl::parse<gap>(in);
    const std::string_view wanted(Word.text);
    const std::string_view left(in.current(), static_cast<std::size_t>(in.end() - in.current()));
    if (!left.starts_with(wanted)) return false;
    if (left.size() > wanted.size() &&
        std::string_view(" \t\f\v\n\r#%{}").find(left[wanted.size()]) == std::string_view::npos)
      return false;
    in.bump(wanted.size());
    return true;
  }
};
// A name that must stand here.
struct name_token : plus<not_at<token_end>, any> {};
template <Text What>
struct name : seq<gap, name_token> {};
struct open_brace : seq<gap, one<'{'>> {};

// A count that must stand here. The rows after it are as many.
template <Text What>
struct count : seq<gap, number> {};

template <char... Letters>
struct keyword : seq<string<Letters...>, at<token_end>> {};

// --- Parts

template <Text X, Text Y, Text Z>
struct three : seq<num<X>, num<Y>, num<Z>> {};
struct point : three<"x", "y", "z"> {};
struct normal : three<"x of the normal", "y of the normal", "z of the normal"> {};
struct color : three<"red", "green", "blue"> {};
struct texture_point : seq<num<"u">, num<"v">> {};
struct more_color : opt<at<gap, number_begin>, color> {};

// --- Directives

struct view_keyword : keyword<'v'> {};
struct view : seq<view_keyword, word<"from">, point, word<"at">, point, word<"up">, point, word<"angle">,
                  num<"the angle">, word<"hither">, num<"hither">, word<"resolution">, num<"the width">,
                  num<"the height">> {};

struct background_keyword : keyword<'b'> {};
struct background : seq<background_keyword, color> {};
// A sky and a sun are words of this program, not of BART. So is what a material gives off.
struct sky_keyword : keyword<'b', 's'> {};
struct sky : seq<sky_keyword, three<"x of the zenith", "y of the zenith", "z of the zenith">,
                 three<"red of the horizon", "green of the horizon", "blue of the horizon">,
                 three<"red of the zenith", "green of the zenith", "blue of the zenith">> {};
struct ambient_keyword : keyword<'a', 'm'> {};
struct ambient : seq<ambient_keyword, color> {};

struct light_keyword : keyword<'l'> {};
struct light : seq<light_keyword, point, more_color> {};
struct sun_keyword : keyword<'l', 's'> {};
struct sun : seq<sun_keyword, point, more_color> {};
struct named_light_keyword : keyword<'l', 'a'> {};
struct named_light : seq<named_light_keyword, name<"the light's name">, point, more_color> {};

struct fill_keyword : keyword<'f'> {};
struct fill
    : seq<fill_keyword, color, num<"Kd">, num<"Ks">, num<"Shine">, num<"T">, num<"the index of refraction">> {
};
struct material_keyword : keyword<'f', 'm'> {};
struct material
    : seq<material_keyword,
          three<"red of the ambient colour", "green of the ambient colour", "blue of the ambient colour">,
          three<"red of the diffuse colour", "green of the diffuse colour", "blue of the diffuse colour">,
          three<"red of the specular colour", "green of the specular colour", "blue of the specular colour">,
          num<"Shine">, num<"T">, num<"the index of refraction">> {};

struct emission_keyword : keyword<'f', 'e'> {};
struct emission : seq<emission_keyword, color> {};
struct textured_emission_keyword : keyword<'f', 'e', 't'> {};
struct textured_emission : seq<textured_emission_keyword, name<"the texture">, color> {};

struct sphere_keyword : keyword<'s'> {};
struct sphere : seq<sphere_keyword, point, num<"the radius">> {};
struct cone_keyword : keyword<'c'> {};
struct cone : seq<cone_keyword, point, num<"the base radius">, point, num<"the apex radius">> {};

struct polygon_keyword : keyword<'p'> {};
struct polygon_row : point {};
struct polygon : seq<polygon_keyword, count<"vertices">, rows<polygon_row>> {};
struct patch_keyword : keyword<'p', 'p'> {};
struct patch_row : seq<point, normal> {};
struct patch : seq<patch_keyword, count<"vertices">, rows<patch_row>> {};

struct textured_corner : seq<point, texture_point> {};
struct textured_keyword : keyword<'t', 't'> {};
struct textured
    : seq<textured_keyword, name<"the texture">, textured_corner, textured_corner, textured_corner> {};
struct smooth_corner : seq<point, normal, texture_point> {};
struct smooth_textured_keyword : keyword<'t', 't', 'p'> {};
struct smooth_textured
    : seq<smooth_textured_keyword, name<"the texture">, smooth_corner, smooth_corner, smooth_corner> {};

struct moving_corner : seq<point, normal> {};
struct moving_row : seq<num<"the time">, moving_corner, moving_corner, moving_corner> {};
struct moving_keyword : keyword<'t', 'p', 'a'> {};
struct moving : seq<moving_keyword, count<"keys">, rows<moving_row>> {};

// m vertices n ... [normals n ...] [texturecoords n texture ...] triangles n rows. A row has as many indices
// as the lists ask for.
struct mesh_position : point {};
struct mesh_normal : normal {};
struct mesh_texture_point : texture_point {};
struct mesh_positions : seq<word<"vertices">, count<"vertices">, rows<mesh_position>> {};
struct normals_word : keyword<'n', 'o', 'r', 'm', 'a', 'l', 's'> {};
struct mesh_normals : seq<gap, normals_word, count<"normals">, rows<mesh_normal>> {};
struct texture_word : keyword<'t', 'e', 'x', 't', 'u', 'r', 'e', 'c', 'o', 'o', 'r', 'd', 's'> {};
struct mesh_texture_points
    : seq<gap, texture_word, count<"texture coordinates">, name<"the texture">, rows<mesh_texture_point>> {};
struct mesh_triangles {
  using rule_t = mesh_triangles;
  using subs_t = pegtl::type_list<num<"an index">>;

  template <pegtl::apply_mode A, pegtl::rewind_mode M, template <typename...> class Action,
            template <typename...> class Control, typename Input, typename Builder>
  static bool match(Input& in, Builder& builder) {
    for (std::size_t left = builder.rows(); left > 0; --left) {
      for (std::size_t i = builder.indices_of_a_row(); i > 0; --i) {
        if (!Control<num<"an index">>::template match<A, M, Action, Control>(in, builder)) return false;
      }
      if constexpr (A == pegtl::apply_mode::action) builder.triangle();
    }
    return true;
  }
};
struct mesh_keyword : keyword<'m'> {};
struct mesh : seq<mesh_keyword, mesh_positions, opt<mesh_normals>, opt<mesh_texture_points>,
                  word<"triangles">, count<"triangles">, mesh_triangles> {};

struct include_keyword : keyword<'i'> {};
struct include : seq<include_keyword, num<"the level">, name<"the file">> {};
struct detail_keyword : keyword<'d'> {};
struct detail : seq<detail_keyword, num<"the level">> {};

struct static_keyword : keyword<'x', 's'> {};
struct static_begin
    : seq<static_keyword, three<"x of the scale", "y of the scale", "z of the scale">,
          three<"x of the axis", "y of the axis", "z of the axis">, num<"the degrees">,
          three<"x of the translation", "y of the translation", "z of the translation">, open_brace> {};
struct animated_keyword : keyword<'x'> {};
struct animated_begin : seq<animated_keyword, name<"the name of the transform">, open_brace> {};
struct close_brace : one<'}'> {};

struct shape : three<"the tension", "the continuity", "the bias"> {};
struct vector_row : seq<num<"the time">, point, shape> {};
struct translation_row : vector_row {};
struct scale_row : vector_row {};
struct rotation_row : seq<num<"the time">, three<"x of the axis", "y of the axis", "z of the axis">,
                          num<"the degrees">, shape> {};
struct visibility_row : seq<num<"the time">, num<"the flag">> {};
struct translation_word : keyword<'t', 'r', 'a', 'n', 's', 'l'> {};
struct scale_word : keyword<'s', 'c', 'a', 'l', 'e'> {};
struct rotation_word : keyword<'r', 'o', 't'> {};
struct visibility_word : keyword<'v', 'i', 's', 'i', 'b', 'i', 'l', 'i', 't', 'y'> {};
struct translation_keys : seq<translation_word, count<"keys">, rows<translation_row>> {};
struct scale_keys : seq<scale_word, count<"keys">, rows<scale_row>> {};
struct rotation_keys : seq<rotation_word, count<"keys">, rows<rotation_row>> {};
struct visibility_keys : seq<visibility_word, count<"keys">, rows<visibility_row>> {};
struct track_end : seq<gap, one<'}'>> {};
struct track_part : seq<gap, sor<translation_keys, scale_keys, rotation_keys, visibility_keys>> {};
struct track_keyword : keyword<'k'> {};
struct track : seq<track_keyword, name<"the name of the track">, open_brace, star<track_part>, track_end> {};

struct times_keyword : keyword<'a'> {};
struct times : seq<times_keyword, num<"the start">, num<"the end">, num<"the number of frames">> {};

struct directive : sor<mesh, track, static_begin, animated_begin, close_brace, include, material, emission,
                       textured_emission, light, sun, view, background, sky, ambient, named_light, fill,
                       sphere, cone, patch, polygon, smooth_textured, textured, moving, detail, times> {};
struct end_of_directives : eof {};
struct file : seq<gap, star<directive, gap>, end_of_directives> {};

// Where reading continues after a problem: at a keyword that stands at the beginning of a line, or at a
// brace.
struct any_keyword
    : sor<view_keyword, background_keyword, sky_keyword, ambient_keyword, light_keyword, sun_keyword,
          named_light_keyword, fill_keyword, material_keyword, emission_keyword, textured_emission_keyword,
          sphere_keyword, cone_keyword, polygon_keyword, patch_keyword, textured_keyword,
          smooth_textured_keyword, moving_keyword, mesh_keyword, include_keyword, detail_keyword,
          static_keyword, animated_keyword, track_keyword, times_keyword> {};
struct line_of_directive : seq<one<'\n', '\r'>, gap, at<any_keyword>> {};
struct resume : seq<opt<token>, star<not_at<sor<line_of_directive, one<'}'>>>, sor<comment, any>>> {};

}  // namespace pprt::aff::grammar

namespace tao::pegtl {

template <typename Name, pprt::aff::grammar::Text Word>
struct analyze_traits<Name, pprt::aff::grammar::word<Word>> : analyze_any_traits<> {};
template <typename Name>
struct analyze_traits<Name, pprt::aff::grammar::mesh_triangles>
    : analyze_opt_traits<pprt::aff::grammar::num<"an index">> {};

}  // namespace tao::pegtl
