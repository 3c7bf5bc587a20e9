#include "parser/nff_parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>

#include "base/diagnostics.h"
#include "base/printable.h"
#include "parser/nff_actions.h"
#include "parser/nff_grammar.h"
#include "parser/nff_messages.h"
#include "parser/text/parser_input.h"
#include "parser/text/text_input.h"

namespace pprt {
namespace nff {
namespace {

namespace pegtl = tao::pegtl;
using Input = ParserInput;

// Returns why a token that looks like a number is none.
const char* number_problem(std::string_view token) {
  const std::size_t sign = token.starts_with('-') || token.starts_with('+') ? 1 : 0;
  const char* const end = token.data() + token.size();
  std::string word(token.substr(sign));
  for (char& c : word) c = static_cast<char>(c | 0x20);
  if (word == "nan" || word == "inf" || word == "infinity") return ", but numbers must be finite";
  double value = 0;
  const bool number_in_form = std::from_chars(token.data() + sign, end, value).ptr == end;
  return number_in_form && !scan_number(token.data(), end, value) ? ", which is too large" : "";
}

// Reports what a rule expected and what was found. The caret points to the wrong token, or after the token
// before when the text or its line ends there.
template <typename Rule>
[[noreturn]] void fail(const Input& in, SceneBuilder& builder) {
  const char* const tried = builder.tried();  // before the gap
  std::string message = fmt::format("expected {}", expected<Rule>);
  if constexpr (std::is_same_v<Rule, grammar::block_comment_rest>) {
    throw ParseFailure{tried - 2, message, true};
  }
  if constexpr (!std::is_same_v<Rule, grammar::end_of_entities>) {
    if (builder.vertex_at_hand() > 0) {
      message += fmt::format(" of vertex {} of {}", builder.vertex_at_hand(), builder.rows());
    }
    message += fmt::format(" of '{}'", builder.entity());
  } else if (!builder.entity().empty()) {
    message += fmt::format(" after '{}'", builder.entity());
  }
  const std::string_view token = next_token<grammar::gap, grammar::token>(tried, in.end());
  if (token.empty()) throw ParseFailure{tried, message + ", found the end of the file"};

  message += ", found " + quoted(token) + number_problem(token);
  const SourceLocation before = builder.locate(tried);
  const SourceLocation found = builder.locate(token.data());
  if (found.line == before.line) throw ParseFailure{token.data(), message};
  throw ParseFailure{tried, message + fmt::format(" on line {}", found.line)};
}

// Like PEGTL's must_if, except that the builder's cursor finds the place; PEGTL would count from the
// beginning of the text.
template <typename Rule>
struct control : pegtl::normal<Rule> {
  static void start(const Input& in, SceneBuilder& builder) {
    if constexpr (expected<Rule> != nullptr) builder.try_at(in.current());
  }
  static void failure(const Input& in, SceneBuilder& builder) {
    if constexpr (expected<Rule> != nullptr) fail<Rule>(in, builder);
  }
};

// Reads the entities. After a problem it continues at the next place that looks like an entity. Returns
// whether the text was read to its end.
bool read_entities(Input& in, SceneBuilder& builder) {
  try {
    while (!in.empty()) {
      try {
        pegtl::parse<grammar::file, action, control>(in, builder);
      } catch (const ParseFailure& failure) {
        builder.report(failure);
        if (failure.fatal) return false;
        // Continues at the failure: a wrong token that looks like an entity is read as one.
        if (failure.place > in.current()) in.bump(static_cast<std::size_t>(failure.place - in.current()));
        pegtl::parse<grammar::resume>(in);
      }
    }
  } catch (const TooManyErrors&) {
    return false;
  }
  return true;
}

// Returns what is wrong with a text as a whole; empty when it may be NFF.
std::string unreadable(std::string_view text) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
    return "the text is in UTF-16; save it as UTF-8 or ASCII";
  }
  if (text.find('\0') != std::string_view::npos) return "this is not a text file (it has zero bytes)";
  if (text.find_first_not_of(" \t\n\r\f\v") == std::string_view::npos) return "the file is empty";
  return {};
}

std::string_view without_byte_order_mark(std::string_view text) {
  return text.substr(text.starts_with("\xef\xbb\xbf") ? 3 : 0);
}

// Drops the ^Z that CP/M and DOS put at the end of a text.
std::string_view without_end_mark(std::string_view text) {
  return text.substr(0, text.find_last_not_of(" \t\n\r\f\v\x1a") + 1);
}

// Returns the one problem of a text without any entity.
Diagnostics nothing_found(const Input& whole, SceneBuilder& builder) {
  const std::string_view token = next_token<grammar::gap, grammar::token>(whole.begin(), whole.end());
  Diagnostics diagnostics;
  if (token.empty()) {
    diagnostics.error({}, "the file holds only comments");
    return diagnostics;
  }
  const char* const meaning = foreign_entity(token);
  diagnostics.error(
      builder.locate(token.data()),
      fmt::format("this is {}: no entity (v, b, l, f, c, s, p or pp) in it; it begins with {}{}",
                  meaning ? "no scene that is understood" : "not an NFF scene", quoted(token),
                  meaning ? fmt::format(" ({})", meaning) : ""));
  return diagnostics;
}

[[noreturn]] void reject(const Diagnostics& diagnostics, std::string_view file_name, std::string_view text,
                         const NffOptions& options) {
  std::string report = report_of(diagnostics, file_name, text);
  report.pop_back();  // the last line end
  if (diagnostics.error_count() >= options.max_errors) {
    report += fmt::format("\n{}: reading stopped after {} errors", file_name, diagnostics.error_count());
  }
  throw InputError(report);
}

}  // namespace
}  // namespace nff

ParsedScene parse_nff(std::string_view text, std::string_view file_name, const NffOptions& options) {
  // SourceLocation has 32 bits for lines and columns.
  const std::size_t max_bytes =
      std::min<std::size_t>(options.max_bytes, std::numeric_limits<std::uint32_t>::max());
  text = nff::without_byte_order_mark(text);
  std::string problem = nff::unreadable(text.substr(0, max_bytes));
  if (text.size() > max_bytes) problem = fmt::format("larger than the limit of {} bytes", max_bytes);
  if (!problem.empty()) throw InputError(fmt::format("{}: error: {}", file_name, problem));

  const std::string_view scene = nff::without_end_mark(text);
  nff::SceneBuilder builder(scene, file_name, options);
  nff::Input in(scene.data(), scene.data() + scene.size(), "");
  const bool whole = nff::read_entities(in, builder);
  if (whole && builder.entities() == 0) {
    in.restart();
    nff::reject(nff::nothing_found(in, builder), file_name, text, options);
  }
  const Diagnostics& diagnostics = builder.finish();
  if (diagnostics.has_errors()) nff::reject(diagnostics, file_name, text, options);
  return {.scene = std::move(builder.scene()), .warnings = report_of(diagnostics, file_name, text)};
}

ParsedScene read_nff(const std::string& path, const NffOptions& options) {
  const std::string text = read_text(path, std::min<std::uint64_t>(options.max_bytes, options.max_memory));
  const bool is_stdin = path == "-";
  ParsedScene parsed = parse_nff(text, is_stdin ? "<stdin>" : printable(path), options);
  parsed.files.push_back(is_stdin ? "/dev/stdin" : path);
  return parsed;
}

}  // namespace pprt
