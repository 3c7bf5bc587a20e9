// The grammar of NFF as it occurs in practice (NFF.TXT 3.9 and the dialects of its readers): rules only.
//
// Blanks, line ends and comments separate tokens; a line end matters only where a rule says so. A rule named
// in nff_messages.h must match once it is reached. All other rules may fail, and an alternative is tried.
#pragma once

#include <tao/pegtl.hpp>

#include "parser/scene_rules.h"

namespace pprt::nff::grammar {

namespace pegtl = tao::pegtl;
using pegtl::any;
using pegtl::at;
using pegtl::eof;
using pegtl::not_at;
using pegtl::not_one;
using pegtl::one;
using pegtl::opt;
using pegtl::plus;
using pegtl::seq;
using pegtl::sor;
using pegtl::star;
using pegtl::string;
using rules::number_begin;
using rules::rows;

// The gap between tokens.
struct inline_blank : one<' ', '\t', '\f', '\v'> {};
struct line_end : one<'\n', '\r'> {};
struct blank : sor<inline_blank, line_end> {};
struct to_line_end : star<not_one<'\n', '\r'>> {};
struct hash_comment : seq<one<'#'>, to_line_end> {};
struct percent_comment : seq<one<'%'>, to_line_end> {};
struct block_comment_rest : pegtl::until<string<'*', '/'>> {};
struct block_comment : seq<string<'/', '*'>, block_comment_rest> {};
struct gap : star<sor<blank, hash_comment, percent_comment, block_comment>> {};

// Tokens.
struct comment_begin : sor<one<'#', '%'>, string<'/', '*'>> {};
struct token_end : sor<eof, blank, comment_begin> {};
struct token : plus<not_at<token_end>, any> {};

struct number : rules::finite_number<number> {
  static bool ends_token(const char* p, const char* end) {
    if (p == end) return true;
    switch (*p) {
      case ' ':
      case '\n':
      case '\t':
      case '\r':
      case '\f':
      case '\v':
      case '#':
      case '%':
        return true;
      default:
        return *p == '/' && p + 1 != end && p[1] == '*';
    }
  }
};

struct field : seq<gap, number> {};
struct more_numbers : star<field> {};

// Keywords. The first number may follow without a blank ("s0 0 0 1", "p3").
template <char... Letters>
struct keyword : seq<string<Letters...>, at<sor<token_end, number_begin>>> {};

// Where reading continues after a problem: a keyword that stands alone or before a number.
struct entity_letters : sor<string<'p', 'p'>, one<'v', 'b', 'l', 'f', 'c', 's', 'p'>> {};
struct entity_begin : seq<entity_letters, sor<at<token_end>, number>> {};
struct open_comment : seq<string<'/', '*'>, star<any>> {};
struct passed_over : sor<blank, hash_comment, percent_comment, block_comment, open_comment, token, any> {};
struct resume : star<not_at<entity_begin>, passed_over> {};

// v from x y z at x y z up x y z angle a hither d [yon d] resolution w h, in any order.
struct view_value : field {};
struct view_vector : seq<view_value, view_value, view_value> {};
struct view_from : seq<keyword<'f', 'r', 'o', 'm'>, view_vector> {};
struct view_at : seq<keyword<'a', 't'>, view_vector> {};
struct view_up : seq<keyword<'u', 'p'>, view_vector> {};
struct view_angle : seq<keyword<'a', 'n', 'g', 'l', 'e'>, view_value> {};
struct view_hither : seq<keyword<'h', 'i', 't', 'h', 'e', 'r'>, view_value> {};
struct view_yon : seq<keyword<'y', 'o', 'n'>, view_value> {};
struct view_resolution
    : seq<keyword<'r', 'e', 's', 'o', 'l', 'u', 't', 'i', 'o', 'n'>, view_value, view_value> {};
struct view_item : sor<view_from, view_at, view_up, view_angle, view_hither, view_yon, view_resolution> {};
struct view_first_item : seq<gap, view_item> {};
struct view_keyword : keyword<'v'> {};
struct view : seq<view_keyword, view_first_item, star<gap, view_item>> {};

// A colour: three numbers, or one of X11's names.
struct color_name : seq<pegtl::rep<3, pegtl::alpha>, star<pegtl::alnum>, at<token_end>> {};
struct color_green : field {};
struct color_blue : field {};
struct color_value : sor<color_name, seq<number, color_green, color_blue>> {};
struct color : seq<gap, color_value> {};

struct background_keyword : keyword<'b'> {};
struct background : seq<background_keyword, color> {};

// l x y z [r g b]. Further numbers are judged by their count.
struct light_x : field {};
struct light_y : field {};
struct light_z : field {};
struct light_keyword : keyword<'l'> {};
struct light : seq<light_keyword, light_x, light_y, light_z, more_numbers> {};

// f r g b Kd Ks Shine T ior, or fewer of them. Dialects add the name of a texture on the same line.
struct rest_of_line : star<sor<inline_blank, block_comment, token>> {};
struct fill_tail : seq<star<inline_blank>, not_at<sor<token_end, entity_begin>>, rest_of_line> {};
struct fill_value : sor<color_name, number> {};
struct fill_color : seq<gap, fill_value> {};
struct fill_keyword : keyword<'f'> {};
struct fill : seq<fill_keyword, fill_color, more_numbers, opt<fill_tail>> {};

struct sphere_x : field {};
struct sphere_y : field {};
struct sphere_z : field {};
struct sphere_radius : field {};
struct sphere_keyword : keyword<'s'> {};
struct sphere : seq<sphere_keyword, sphere_x, sphere_y, sphere_z, sphere_radius, more_numbers> {};

struct base_x : field {};
struct base_y : field {};
struct base_z : field {};
struct base_radius : field {};
struct apex_x : field {};
struct apex_y : field {};
struct apex_z : field {};
struct apex_radius : field {};
struct cone_keyword : keyword<'c'> {};
struct cone : seq<cone_keyword, base_x, base_y, base_z, base_radius, apex_x, apex_y, apex_z, apex_radius> {};

struct vertex_count : field {};
struct vertex_x : field {};
struct vertex_y : field {};
struct vertex_z : field {};
struct normal_x : field {};
struct normal_y : field {};
struct normal_z : field {};
struct polygon_vertex : seq<vertex_x, vertex_y, vertex_z> {};
struct polygon_keyword : keyword<'p'> {};
struct polygon : seq<polygon_keyword, vertex_count, rows<polygon_vertex>> {};
struct patch_vertex : seq<vertex_x, vertex_y, vertex_z, normal_x, normal_y, normal_z> {};
struct patch_keyword : keyword<'p', 'p'> {};
struct patch : seq<patch_keyword, vertex_count, rows<patch_vertex>> {};

// The header of a mailed scene: "Subject: ..." with its folded lines, or mbox's "From ...".
struct header_name : seq<pegtl::alpha, star<sor<pegtl::alnum, one<'-'>>>, one<':'>> {};
struct folded_line : seq<sor<string<'\r', '\n'>, line_end>, plus<one<' ', '\t'>>,
                         not_at<sor<eof, line_end, entity_begin>>, to_line_end> {};
struct header_begin : sor<header_name, string<'F', 'r', 'o', 'm', ' '>> {};
struct mail_header : seq<header_begin, to_line_end, star<folded_line>> {};

// Any other word that begins an entity. It is skipped to the end of its line, with the numbers that follow.
struct unknown_word : seq<not_at<number_begin>, token> {};
struct unknown : seq<unknown_word, rest_of_line, pegtl::disable<more_numbers>> {};

struct entity : sor<patch, polygon, sphere, cone, fill, light, background, view, mail_header, unknown> {};
struct end_of_entities : eof {};
struct file : seq<gap, star<entity, gap>, end_of_entities> {};

}  // namespace pprt::nff::grammar
