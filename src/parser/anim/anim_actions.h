// Actions of the animation grammar: what each rule does once it has matched. The result is a WrittenScript.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "parser/anim/anim_grammar.h"
#include "parser/anim/anim_script.h"
#include "parser/anim/anim_value.h"

namespace pprt::anim {

// A place where the text no longer follows the grammar.
struct ParseFailure {
  const char* place;
  std::string message;
  bool fatal = false;  // nothing after it can be read either
};

// The block that is being read; messages name it when a word does not belong there.
enum class Block { kTop, kAnimation, kCamera, kKey, kObject, kObjectKey, kLight };

// Collects the script while it is read. Values of expressions are kept on a stack.
class ScriptReader {
 public:
  explicit ScriptReader(std::string_view text) : problems_(text) {}

  // Expressions. Operands are pushed; operations replace their operands by the result.
  void push_number(std::string_view token);
  void push_variable(std::string_view name);
  void calculate_top(Operation operation, const char* place);
  void negate_top(const char* place);
  void join_two(const char* place);
  void append_third(const char* place);
  void begin_call(std::string_view callee);
  void end_call();
  void enter_operand(const char* place);  // throws ParseFailure when operands nest too deeply
  void leave_operand() { --depth_; }

  // Statements; each takes its value off the stack.
  void begin_declaration(std::string_view name) { declared_ = name; }
  void declare();
  void check_version();
  void begin_animation(const char* place);
  void begin_camera(const char* place);
  void begin_object(std::string_view name);
  void end_object() { owner_ = FieldOwner::kCamera; }
  void begin_sun(const char* place) { begin_light(FieldOwner::kSun, place); }
  void begin_sky(const char* place) { begin_light(FieldOwner::kSky, place); }
  void end_sun();
  void end_sky();
  void begin_key(WrittenKey::Kind kind, const char* place);
  void set_in_seconds() { key_.in_seconds = true; }
  void set_when();
  void begin_field(std::string_view word);
  void set_field();
  void end_key();
  void begin_setting(const char* place) { setting_ = place; }
  void set_scene(std::string_view name);
  void set_frames() { set(script_.frames, "frames", take()); }
  void set_fps() { set(script_.fps, "fps", take()); }
  void set_resolution() { set(script_.resolution, "resolution", take()); }
  void set_spline(std::string_view kind);

  // Problems. `recover` reports a failure and drops the unfinished statement; it rethrows a fatal one.
  void unknown(std::string_view token, Block block);
  void missing_brace(const char* place) { problems_.error(place, "expected '{' before this"); }
  void recover(const ParseFailure& failure);

  WrittenScript& script() { return script_; }
  Problems& problems() { return problems_; }

 private:
  struct Call {
    std::string_view name;
    std::size_t first_argument;  // its index on the stack
  };

  Value take();
  void begin_light(FieldOwner owner, const char* place);
  void given_twice(std::string_view word);
  template <typename T>
  void set(std::optional<T>& into, std::string_view word, T value) {
    if (into) given_twice(word);
    into = std::move(value);
  }

  Problems problems_;
  WrittenScript script_;
  std::map<std::string, Value, std::less<>> names_;
  std::vector<Value> stack_;
  std::vector<Call> calls_;
  int depth_ = 0;
  std::string_view declared_;
  std::size_t keys_ = 0;                    // of camera and objects
  FieldOwner owner_ = FieldOwner::kCamera;  // of the fields at hand; an object is the last one of the script
  WrittenKey key_;
  std::size_t field_ = 0;
  const char* field_place_ = nullptr;
  const char* setting_ = nullptr;  // the keyword of the current setting
};

// Returns what stands at a place, quoted for a message.
std::string found_at(const char* place, const char* end);

template <typename Rule>
struct action : tao::pegtl::nothing<Rule> {};

// Action: passes the matched text to a member function.
template <auto Member>
struct with_text {
  template <typename ActionInput>
  static void apply(const ActionInput& in, ScriptReader& reader) {
    (reader.*Member)(std::string_view(in.begin(), in.size()));
  }
};

// Action: passes the place where the match begins.
template <auto Member>
struct with_place {
  template <typename ActionInput>
  static void apply(const ActionInput& in, ScriptReader& reader) {
    (reader.*Member)(in.begin());
  }
};

template <auto Member>
struct plainly {
  static void apply0(ScriptReader& reader) { (reader.*Member)(); }
};

template <Operation operation>
struct calculating {
  template <typename ActionInput>
  static void apply(const ActionInput& in, ScriptReader& reader) {
    reader.calculate_top(operation, in.begin());
  }
};

template <Block block>
struct unknown_in {
  template <typename ActionInput>
  static void apply(const ActionInput& in, ScriptReader& reader) {
    reader.unknown(std::string_view(in.begin(), in.size()), block);
  }
};

// Reports a failure inside an item of a block and continues with the next item.
struct recovering : tao::pegtl::maybe_nothing {
  template <typename Rule, tao::pegtl::apply_mode A, tao::pegtl::rewind_mode M,
            template <typename...> class Action, template <typename...> class Control, typename Input>
  static bool match(Input& in, ScriptReader& reader) {
    try {
      return tao::pegtl::match<Rule, A, M, Action, Control>(in, reader);
    } catch (const ParseFailure& failure) {
      reader.recover(failure);
      // After the exception the input stands at the item's beginning, or somewhere within the item.
      in.bump(static_cast<std::size_t>(failure.place - in.current()));
    }
    return Control<grammar::skip>::template match<A, tao::pegtl::rewind_mode::dontcare, Action, Control>(
        in, reader);
  }
};

// Limits nesting, so that parentheses cannot exhaust the call stack.
struct limiting_depth : tao::pegtl::maybe_nothing {
  template <typename Rule, tao::pegtl::apply_mode A, tao::pegtl::rewind_mode M,
            template <typename...> class Action, template <typename...> class Control, typename Input>
  static bool match(Input& in, ScriptReader& reader) {
    reader.enter_operand(in.current());
    const bool matched = tao::pegtl::match<Rule, A, M, Action, Control>(in, reader);
    reader.leave_operand();
    return matched;
  }
};

template <>
struct action<grammar::top_item> : recovering {};
template <>
struct action<grammar::animation_item> : recovering {};
template <>
struct action<grammar::camera_item> : recovering {};
template <>
struct action<grammar::object_item> : recovering {};
template <>
struct action<grammar::key_item> : recovering {};
template <>
struct action<grammar::light_item> : recovering {};
template <>
struct action<grammar::unary> : limiting_depth {};

template <>
struct action<grammar::number> : with_text<&ScriptReader::push_number> {};
template <>
struct action<grammar::variable> : with_text<&ScriptReader::push_variable> {};
template <>
struct action<grammar::plus_product> : calculating<Operation::kAdd> {};
template <>
struct action<grammar::minus_product> : calculating<Operation::kSubtract> {};
template <>
struct action<grammar::times> : calculating<Operation::kMultiply> {};
template <>
struct action<grammar::over> : calculating<Operation::kDivide> {};
template <>
struct action<grammar::to_power> : calculating<Operation::kPower> {};
template <>
struct action<grammar::negation> : with_place<&ScriptReader::negate_top> {};
template <>
struct action<grammar::two_components> : with_place<&ScriptReader::join_two> {};
template <>
struct action<grammar::third_component> : with_place<&ScriptReader::append_third> {};
template <>
struct action<grammar::callee> : with_text<&ScriptReader::begin_call> {};
template <>
struct action<grammar::call> : plainly<&ScriptReader::end_call> {};

template <>
struct action<grammar::new_name> : with_text<&ScriptReader::begin_declaration> {};
template <>
struct action<grammar::declaration> : plainly<&ScriptReader::declare> {};
template <>
struct action<grammar::version> : plainly<&ScriptReader::check_version> {};
template <>
struct action<grammar::animation_word> : with_place<&ScriptReader::begin_animation> {};
template <>
struct action<grammar::camera_word> : with_place<&ScriptReader::begin_camera> {};
template <>
struct action<grammar::seconds> : plainly<&ScriptReader::set_in_seconds> {};
template <>
struct action<grammar::place> : plainly<&ScriptReader::set_when> {};
template <>
struct action<grammar::field_word> : with_text<&ScriptReader::begin_field> {};
template <>
struct action<grammar::field> : plainly<&ScriptReader::set_field> {};
template <>
struct action<grammar::key> : plainly<&ScriptReader::end_key> {};
template <>
struct action<grammar::object_name> : with_text<&ScriptReader::begin_object> {};
template <>
struct action<grammar::object> : plainly<&ScriptReader::end_object> {};
template <>
struct action<grammar::object_key> : plainly<&ScriptReader::end_key> {};
template <>
struct action<grammar::sun_word> : with_place<&ScriptReader::begin_sun> {};
template <>
struct action<grammar::sky_word> : with_place<&ScriptReader::begin_sky> {};
template <>
struct action<grammar::sun> : plainly<&ScriptReader::end_sun> {};
template <>
struct action<grammar::sky> : plainly<&ScriptReader::end_sky> {};
template <>
struct action<grammar::hold> : plainly<&ScriptReader::end_key> {};
template <>
struct action<grammar::spline_kind> : with_text<&ScriptReader::set_spline> {};
template <>
struct action<grammar::scene_name> : with_text<&ScriptReader::set_scene> {};
template <>
struct action<grammar::frames> : plainly<&ScriptReader::set_frames> {};
template <>
struct action<grammar::fps> : plainly<&ScriptReader::set_fps> {};
template <>
struct action<grammar::resolution> : plainly<&ScriptReader::set_resolution> {};
template <>
struct action<grammar::scene_word> : with_place<&ScriptReader::begin_setting> {};
template <>
struct action<grammar::frames_word> : with_place<&ScriptReader::begin_setting> {};
template <>
struct action<grammar::fps_word> : with_place<&ScriptReader::begin_setting> {};
template <>
struct action<grammar::resolution_word> : with_place<&ScriptReader::begin_setting> {};
template <>
struct action<grammar::spline_word> : with_place<&ScriptReader::begin_setting> {};

template <WrittenKey::Kind kind>
struct beginning_key {
  template <typename ActionInput>
  static void apply(const ActionInput& in, ScriptReader& reader) {
    reader.begin_key(kind, in.begin());
  }
};
template <>
struct action<grammar::key_word> : beginning_key<WrittenKey::Kind::kKey> {};
template <>
struct action<grammar::hold_word> : beginning_key<WrittenKey::Kind::kHold> {};
template <>
struct action<grammar::cut_word> : beginning_key<WrittenKey::Kind::kCut> {};

template <>
struct action<grammar::no_brace_before_field> : with_place<&ScriptReader::missing_brace> {};
template <>
struct action<grammar::no_brace_before_camera_word> : with_place<&ScriptReader::missing_brace> {};
template <>
struct action<grammar::no_brace_before_animation_word> : with_place<&ScriptReader::missing_brace> {};
template <>
struct action<grammar::unknown_at_top> : unknown_in<Block::kTop> {};
template <>
struct action<grammar::unknown_in_animation> : unknown_in<Block::kAnimation> {};
template <>
struct action<grammar::unknown_in_camera> : unknown_in<Block::kCamera> {};
template <>
struct action<grammar::unknown_in_key> : unknown_in<Block::kKey> {};
template <>
struct action<grammar::unknown_in_object> : unknown_in<Block::kObject> {};
template <>
struct action<grammar::unknown_in_light> : unknown_in<Block::kLight> {};

}  // namespace pprt::anim
