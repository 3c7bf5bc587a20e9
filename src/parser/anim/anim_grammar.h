// The grammar of animation scripts, pprt-anim(5): rules only.
//
// Every token includes the gap after it. One token of lookahead decides, so no action runs for text that is
// read a second time. A rule named in anim_messages.h must match once it is reached.
#pragma once

#include <cstddef>

#include <tao/pegtl.hpp>
#include <tao/pegtl/contrib/analyze_traits.hpp>

namespace pprt::anim::grammar {

namespace pegtl = tao::pegtl;
using pegtl::any;
using pegtl::at;
using pegtl::digit;
using pegtl::eof;
using pegtl::identifier;
using pegtl::not_at;
using pegtl::not_one;
using pegtl::one;
using pegtl::opt;
using pegtl::plus;
using pegtl::seq;
using pegtl::sor;
using pegtl::star;
using pegtl::string;

// The gap between tokens. "#" begins a comment, "#declare" and "#version" do not.
struct blank : one<' ', '\t', '\n', '\r', '\f', '\v'> {};
struct to_line_end : star<not_one<'\n', '\r'>> {};
struct declare_word : TAO_PEGTL_KEYWORD("#declare") {};
struct version_word : TAO_PEGTL_KEYWORD("#version") {};
struct hash_comment : seq<not_at<sor<declare_word, version_word>>, one<'#'>, to_line_end> {};
struct line_comment : seq<string<'/', '/'>, to_line_end> {};
struct block_comment_rest : pegtl::until<string<'*', '/'>> {};
struct block_comment : seq<string<'/', '*'>, block_comment_rest> {};
struct gap : star<sor<blank, hash_comment, line_comment, block_comment>> {};

template <typename Token>
struct token : seq<Token, gap> {};
template <char... C>
struct mark : token<one<C...>> {};

// Keywords, grouped by block.
struct animation_word : TAO_PEGTL_KEYWORD("animation") {};
struct scene_word : TAO_PEGTL_KEYWORD("scene") {};
struct frames_word : TAO_PEGTL_KEYWORD("frames") {};
struct fps_word : TAO_PEGTL_KEYWORD("fps") {};
struct resolution_word : TAO_PEGTL_KEYWORD("resolution") {};
struct camera_word : TAO_PEGTL_KEYWORD("camera") {};
struct object_word : TAO_PEGTL_KEYWORD("object") {};
struct sun_word : TAO_PEGTL_KEYWORD("sun") {};
struct sky_word : TAO_PEGTL_KEYWORD("sky") {};
struct spline_word : TAO_PEGTL_KEYWORD("spline") {};
struct key_word : TAO_PEGTL_KEYWORD("key") {};
struct hold_word : TAO_PEGTL_KEYWORD("hold") {};
struct cut_word : TAO_PEGTL_KEYWORD("cut") {};
struct field_word
    : sor<TAO_PEGTL_KEYWORD("from"), TAO_PEGTL_KEYWORD("at"), TAO_PEGTL_KEYWORD("up"),
          TAO_PEGTL_KEYWORD("angle"), TAO_PEGTL_KEYWORD("tension"), TAO_PEGTL_KEYWORD("continuity"),
          TAO_PEGTL_KEYWORD("bias"), TAO_PEGTL_KEYWORD("ease_in"), TAO_PEGTL_KEYWORD("ease_out"),
          TAO_PEGTL_KEYWORD("translate"), TAO_PEGTL_KEYWORD("rotate"), TAO_PEGTL_KEYWORD("scale"),
          TAO_PEGTL_KEYWORD("visible"), TAO_PEGTL_KEYWORD("color"), TAO_PEGTL_KEYWORD("horizon"),
          TAO_PEGTL_KEYWORD("zenith")> {};
struct in_animation_word
    : sor<scene_word, frames_word, fps_word, resolution_word, camera_word, object_word, sun_word, sky_word> {
};
struct in_camera_word : sor<spline_word, key_word, hold_word, cut_word> {};
struct above_key_word : sor<declare_word, version_word, animation_word, in_animation_word, in_camera_word> {};
struct statement_word : sor<above_key_word, field_word> {};
struct function_word : sor<TAO_PEGTL_KEYWORD("sin"), TAO_PEGTL_KEYWORD("cos"), TAO_PEGTL_KEYWORD("tan"),
                           TAO_PEGTL_KEYWORD("sqrt"), TAO_PEGTL_KEYWORD("abs"), TAO_PEGTL_KEYWORD("min"),
                           TAO_PEGTL_KEYWORD("max"), TAO_PEGTL_KEYWORD("pi")> {};

// Expressions. A vector has two components (a resolution) or three.
struct expression;
struct sign : one<'+', '-'> {};
struct exponent : seq<one<'e', 'E'>, opt<sign>, plus<digit>> {};
struct whole_part_first : seq<plus<digit>, opt<one<'.'>, star<digit>>> {};
struct number : seq<sor<whole_part_first, seq<one<'.'>, plus<digit>>>, opt<exponent>> {};
struct comma : mark<','> {};
struct close_angle : mark<'>'> {};
struct close_paren : mark<')'> {};
struct two_components : seq<mark<'<'>, expression, comma, expression> {};
struct third_component : seq<mark<','>, expression> {};
struct vector : seq<two_components, opt<third_component>, close_angle> {};
struct group : seq<mark<'('>, expression, close_paren> {};
struct callee : seq<not_at<statement_word>, token<identifier>, at<one<'('>>> {};
struct call : seq<callee, mark<'('>, expression, star<mark<','>, expression>, close_paren> {};
struct variable : seq<not_at<statement_word>, identifier> {};
struct operand : sor<token<number>, vector, group, call, token<variable>> {};
struct unary;
struct to_power : seq<mark<'^'>, unary> {};
struct negation : seq<mark<'-'>, unary> {};
struct unary : sor<negation, seq<mark<'+'>, unary>, seq<operand, opt<to_power>>> {};
struct times : seq<mark<'*'>, unary> {};
struct over : seq<mark<'/'>, unary> {};
struct product : seq<unary, star<sor<times, over>>> {};
struct plus_product : seq<mark<'+'>, product> {};
struct minus_product : seq<mark<'-'>, product> {};
struct expression : seq<product, star<sor<plus_product, minus_product>>> {};

struct quoted : seq<one<'"'>, star<not_one<'"', '\n', '\r'>>, opt<one<'"'>>> {};

// Skips from an error to the place where reading continues. That is the next keyword of a statement, the end
// of the block, or the end of a nested block.
struct skipped_block {
  using rule_t = skipped_block;
  using subs_t = pegtl::empty_list;

  // Not recursive, because the input decides the depth.
  template <typename Input>
  static bool match(Input& in) {
    std::size_t depth = 0;
    do {
      if (in.empty()) return depth > 0;
      if (pegtl::parse<sor<plus<blank>, hash_comment, line_comment, block_comment, quoted>>(in)) continue;
      const char c = in.peek_char();
      if (c == '{') ++depth;
      if (c == '}') --depth;
      if (depth > 0 || c == '}') in.bump(1);
    } while (depth > 0);
    return true;
  }
};
struct skip_end : sor<statement_word, one<'{', '}'>, eof> {};
struct skipped_token : sor<plus<blank>, hash_comment, line_comment, block_comment, quoted, identifier, any> {
};
struct skip : seq<star<not_at<skip_end>, skipped_token>, opt<at<one<'{'>>, skipped_block>, gap> {};

// #declare NAME = expression;
struct new_name : seq<not_at<sor<statement_word, function_word>>, identifier> {};
struct equals : mark<'='> {};
struct semicolon : mark<';'> {};
struct declaration : seq<token<declare_word>, token<new_name>, equals, expression, semicolon> {};

// key, hold, cut
struct seconds : TAO_PEGTL_KEYWORD("s") {};
struct place : seq<expression, opt<token<seconds>>> {};
struct field : seq<token<field_word>, expression> {};
struct unknown_in_key : sor<identifier, quoted, any> {};
struct key_item : sor<field, seq<not_at<sor<above_key_word, one<'}'>, eof>>, unknown_in_key, skip>> {};
struct no_brace_before_field : at<field_word> {};
struct open_key : sor<mark<'{'>, no_brace_before_field> {};
struct close_key : mark<'}'> {};
struct key_begin : sor<key_word, cut_word> {};
struct key : seq<token<key_begin>, place, open_key, star<key_item>, close_key> {};
struct hold : seq<token<hold_word>, place> {};

// camera
struct spline_kind : identifier {};
struct spline : seq<token<spline_word>, token<spline_kind>> {};
struct unknown_in_camera : sor<identifier, quoted, any> {};
struct camera_item
    : sor<declaration, key, hold, spline,
          seq<not_at<sor<camera_word, animation_word, one<'}'>, eof>>, unknown_in_camera, skip>> {};
struct no_brace_before_camera_word : at<in_camera_word> {};
struct open_camera : sor<mark<'{'>, no_brace_before_camera_word> {};
struct close_camera : mark<'}'> {};
struct camera : seq<token<camera_word>, open_camera, star<camera_item>, close_camera> {};

// object
struct object_name : plus<not_one<'"', '\n', '\r'>> {};
struct open_object_quote : one<'"'> {};
struct close_object_quote : one<'"'> {};
struct object_key : seq<token<key_word>, place, open_key, star<key_item>, close_key> {};
struct unknown_in_object : sor<identifier, quoted, any> {};
struct object_item
    : sor<declaration, object_key,
          seq<not_at<sor<in_animation_word, animation_word, one<'}'>, eof>>, unknown_in_object, skip>> {};
struct open_object : mark<'{'> {};
struct close_object : mark<'}'> {};
struct object : seq<token<object_word>, open_object_quote, object_name, token<close_object_quote>,
                    open_object, star<object_item>, close_object> {};

// sun, sky
struct unknown_in_light : sor<identifier, quoted, any> {};
struct light_item : sor<field, seq<not_at<sor<above_key_word, one<'}'>, eof>>, unknown_in_light, skip>> {};
struct open_light : sor<mark<'{'>, no_brace_before_field> {};
struct close_light : mark<'}'> {};
struct sun : seq<token<sun_word>, open_light, star<light_item>, close_light> {};
struct sky : seq<token<sky_word>, open_light, star<light_item>, close_light> {};

// animation
struct scene_name : plus<not_one<'"', '\n', '\r'>> {};
struct open_quote : one<'"'> {};
struct close_quote : one<'"'> {};
struct scene : seq<token<scene_word>, open_quote, scene_name, token<close_quote>> {};
struct frames : seq<token<frames_word>, expression> {};
struct fps : seq<token<fps_word>, expression> {};
struct resolution : seq<token<resolution_word>, expression> {};
struct unknown_in_animation : sor<identifier, quoted, any> {};
struct animation_item : sor<declaration, camera, object, sun, sky, scene, frames, fps, resolution,
                            seq<not_at<sor<animation_word, one<'}'>, eof>>, unknown_in_animation, skip>> {};
struct no_brace_before_animation_word : at<in_animation_word> {};
struct open_animation : sor<mark<'{'>, no_brace_before_animation_word> {};
struct close_animation : mark<'}'> {};
struct animation : seq<token<animation_word>, open_animation, star<animation_item>, close_animation> {};

// #version expression;
struct version_semicolon : semicolon {};
struct version : seq<token<version_word>, expression, version_semicolon> {};

struct unknown_at_top : sor<identifier, quoted, any> {};
struct top_item : sor<version, declaration, animation, seq<not_at<eof>, unknown_at_top, skip>> {};
struct script : seq<opt<pegtl::utf8::bom>, gap, star<top_item>, eof> {};

}  // namespace pprt::anim::grammar

// For pegtl::analyze: the rule consumes a block, so it always makes progress.
namespace TAO_PEGTL_NAMESPACE {
template <typename Name>
struct analyze_traits<Name, pprt::anim::grammar::skipped_block> : analyze_any_traits<> {};
}  // namespace TAO_PEGTL_NAMESPACE
