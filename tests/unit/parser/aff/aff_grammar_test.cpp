#include "parser/aff_grammar.h"

#include <catch2/catch.hpp>
#include <tao/pegtl/contrib/analyze.hpp>

TEST_CASE("aff: the grammar has no rule that reads nothing for ever") {
  CHECK(tao::pegtl::analyze<pprt::aff::grammar::file>() == 0);
  CHECK(tao::pegtl::analyze<pprt::aff::grammar::resume>() == 0);
}
