// Rules that the grammars of NFF and AFF share.
#pragma once

#include <cstddef>
#include <tao/pegtl.hpp>
#include <tao/pegtl/contrib/analyze_traits.hpp>

#include "parser/text/text_input.h"

namespace pprt::rules {

struct number_begin : tao::pegtl::one<'0', '1', '2', '3', '4', '5', '6', '7', '8', '9', '.', '+', '-'> {};

// Matches a finite number that fills its token, and passes its value to the action. `Rule` is the number of a
// grammar: Rule::ends_token(p, end) tells whether the token before p ends there.
template <typename Rule>
struct finite_number {
  using rule_t = finite_number;
  using subs_t = tao::pegtl::empty_list;

  template <tao::pegtl::apply_mode A, tao::pegtl::rewind_mode, template <typename...> class Action,
            template <typename...> class, typename Input, typename... States>
  static bool match(Input& in, States&&... states) {
    double value = 0;
    const char* const stop = scan_number(in.current(), in.end(), value);
    if (!stop || !Rule::ends_token(stop, in.end())) return false;
    const char* const place = in.current();
    in.bump(static_cast<std::size_t>(stop - place));
    if constexpr (A == tao::pegtl::apply_mode::action) Action<Rule>::value(value, place, states...);
    return true;
  }
};

// Matches Row as many times as the last count said.
template <typename Row>
struct rows {
  using rule_t = rows;
  using subs_t = tao::pegtl::type_list<Row>;

  template <tao::pegtl::apply_mode A, tao::pegtl::rewind_mode M, template <typename...> class Action,
            template <typename...> class Control, typename Input, typename Builder>
  static bool match(Input& in, Builder& builder) {
    for (std::size_t left = builder.rows(); left > 0; --left) {
      if (!Control<Row>::template match<A, M, Action, Control>(in, builder)) return false;
    }
    return true;
  }
};

}  // namespace pprt::rules

namespace tao::pegtl {

template <typename Name, typename Rule>
struct analyze_traits<Name, pprt::rules::finite_number<Rule>> : analyze_any_traits<> {};
template <typename Name, typename Row>
struct analyze_traits<Name, pprt::rules::rows<Row>> : analyze_opt_traits<Row> {};

}  // namespace tao::pegtl
