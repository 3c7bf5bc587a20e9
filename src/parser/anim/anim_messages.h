// Error messages of the animation grammar.
#pragma once

#include "parser/anim/anim_grammar.h"

namespace pprt::anim {

// What a rule expects that must match; nullptr for rules that may fail. The report appends what was found:
// "expected ',', found 'at'".
template <typename Rule>
inline constexpr const char* expected = nullptr;

template <>
inline constexpr const char* expected<grammar::block_comment_rest> = "'*/' at the end of this comment";
template <>
inline constexpr const char* expected<grammar::operand> = "a number, a name, a vector or '('";
template <>
inline constexpr const char* expected<grammar::comma> = "',' and the next component of the vector";
template <>
inline constexpr const char* expected<grammar::close_angle> = "'>' at the end of the vector";
template <>
inline constexpr const char* expected<grammar::close_paren> = "')'";
template <>
inline constexpr const char* expected<grammar::new_name> = "a name to declare";
template <>
inline constexpr const char* expected<grammar::equals> = "'=' after the declared name";
template <>
inline constexpr const char* expected<grammar::semicolon> = "';' after the declared value";
template <>
inline constexpr const char* expected<grammar::version_semicolon> = "';' after the version";
template <>
inline constexpr const char* expected<grammar::open_key> = "'{' with the camera of the key";
template <>
inline constexpr const char* expected<grammar::close_key> = "'}' at the end of the key";
template <>
inline constexpr const char* expected<grammar::spline_kind> = "linear, catmull_rom or tcb";
template <>
inline constexpr const char* expected<grammar::open_camera> = "'{' after 'camera'";
template <>
inline constexpr const char* expected<grammar::close_camera> = "'}' at the end of the camera";
template <>
inline constexpr const char* expected<grammar::open_quote> = "the scene's name in quotation marks";
template <>
inline constexpr const char* expected<grammar::scene_name> = "the scene's name between the quotation marks";
template <>
inline constexpr const char* expected<grammar::close_quote> = "'\"' at the end of the scene's name";
template <>
inline constexpr const char* expected<grammar::open_object_quote> = "the object's name in quotation marks";
template <>
inline constexpr const char* expected<grammar::object_name> = "the object's name between the quotation marks";
template <>
inline constexpr const char* expected<grammar::close_object_quote> = "'\"' at the end of the object's name";
template <>
inline constexpr const char* expected<grammar::open_object> = "'{' with the keys of the object";
template <>
inline constexpr const char* expected<grammar::close_object> = "'}' at the end of the object";
template <>
inline constexpr const char* expected<grammar::open_light> = "'{' with the fields of the sun or the sky";
template <>
inline constexpr const char* expected<grammar::close_light> = "'}' at the end of the sun or the sky";
template <>
inline constexpr const char* expected<grammar::open_animation> = "'{' after 'animation'";
template <>
inline constexpr const char* expected<grammar::close_animation> = "'}' at the end of the animation";

}  // namespace pprt::anim
