// What the PEGTL parsers of this room share.
#pragma once

#include <cstddef>
#include <string_view>
#include <tao/pegtl.hpp>

namespace pprt {

using ParserInput =
    tao::pegtl::memory_input<tao::pegtl::tracking_mode::lazy, tao::pegtl::eol::lf_crlf, const char*>;

// Returns the next token after the gap, by the grammar's rules for both; empty at the end of the text.
template <typename Gap, typename Token>
std::string_view next_token(const char* begin_of_gap, const char* end) {
  ParserInput ahead(begin_of_gap, end, "");
  tao::pegtl::parse<Gap>(ahead);
  const char* const begin = ahead.current();
  tao::pegtl::parse<Token>(ahead);
  return {begin, static_cast<std::size_t>(ahead.current() - begin)};
}

// Actions that pass on the matched text, and actions that only report the match; `Handle` is the builder's
// member.
template <auto Handle>
struct with_text {
  template <typename Input, typename Builder>
  static void apply(const Input& in, Builder& builder) {
    (builder.*Handle)(std::string_view(in.begin(), in.size()));
  }
};
template <auto Handle>
struct without_text {
  template <typename Builder>
  static void apply0(Builder& builder) {
    (builder.*Handle)();
  }
};

}  // namespace pprt
