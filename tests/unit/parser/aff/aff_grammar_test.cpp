#include "parser/aff_grammar.h"

#include <catch2/catch.hpp>
#include <tao/pegtl/contrib/analyze.hpp>

namespace pprt::aff_grammar_test {

TEST_CASE("aff: the grammar has no rule that reads nothing for ever") {
  CHECK(tao::pegtl::analyze<aff::grammar::file>() == 0);
  CHECK(tao::pegtl::analyze<aff::grammar::resume>() == 0);
}

}  // namespace pprt::aff_grammar_test
