#include "parser/anim/anim_parser.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/printable.h"
#include "parser/anim/anim_actions.h"
#include "parser/anim/anim_grammar.h"
#include "parser/anim/anim_messages.h"
#include "parser/anim/anim_script.h"
#include "parser/text/text_input.h"

namespace pprt {
namespace anim {
namespace {

namespace pegtl = tao::pegtl;
using Input = pegtl::memory_input<pegtl::tracking_mode::lazy, pegtl::eol::lf_crlf, const char*>;

// Ten times the size of a script with a long key at each of ten thousand frames.
constexpr std::size_t kMostBytes = std::size_t{16} << 20;

// Turns the failure of a rule that must match into a ParseFailure. When such a rule fails the input has not
// moved, except in a comment, where `match` keeps its beginning.
template <typename Rule>
struct control : pegtl::normal<Rule> {
  static void failure(const Input& in, ScriptReader&) {
    if constexpr (expected<Rule> != nullptr) {
      throw ParseFailure{in.current(), fmt::format("expected {}, found {}", expected<Rule>,
                                                   found_at(in.current(), in.end()))};
    }
  }
};

template <>
struct control<grammar::block_comment_rest> : pegtl::normal<grammar::block_comment_rest> {
  template <pegtl::apply_mode A, pegtl::rewind_mode M, template <typename...> class Action,
            template <typename...> class Control>
  static bool match(Input& in, ScriptReader& reader) {
    const char* const begin = in.current() - 2;
    if (pegtl::match<grammar::block_comment_rest, A, M, Action, pegtl::normal>(in, reader)) return true;
    throw ParseFailure{begin, fmt::format("expected {}", expected<grammar::block_comment_rest>), true};
  }
};

void read_script(std::string_view text, ScriptReader& reader) {
  Input in(text.data(), text.data() + text.size(), "");
  try {
    pegtl::parse<grammar::script, action, control>(in, reader);
  } catch (const ParseFailure& failure) {
    reader.problems().error(failure.place, failure.message);
  }
}

}  // namespace
}  // namespace anim

ParsedAnimation parse_animation(std::string_view text, std::string_view file_name) {
  if (text.size() > anim::kMostBytes) {
    throw InputError(
        fmt::format("{}: error: longer than {} bytes, the most for a script", file_name, anim::kMostBytes));
  }
  anim::ScriptReader reader(text);
  anim::read_script(text, reader);
  anim::Problems& problems = reader.problems();
  Animation animation = anim::interpret(reader.script(), file_name, problems);
  if (!reader.script().has_animation && !problems.diagnostics().has_errors()) {
    problems.error(text.data() + text.size(), "expected 'animation { ... }', found the end of the script");
  }
  std::string report = report_of(problems.diagnostics(), file_name, text);
  if (!problems.diagnostics().has_errors()) return {std::move(animation), std::move(report)};
  report.pop_back();  // the last line end
  throw InputError(report);
}

ParsedAnimation read_animation(const std::string& path) {
  return parse_animation(read_text(path, anim::kMostBytes), path == "-" ? "<stdin>" : printable(path));
}

}  // namespace pprt
