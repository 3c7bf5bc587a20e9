#include "parser/nff_grammar.h"

#include <catch2/catch.hpp>
#include <tao/pegtl/contrib/analyze.hpp>

namespace pprt::nff_grammar_test {

TEST_CASE("no rule of the NFF grammar can loop without consuming") {
  CHECK(tao::pegtl::analyze<nff::grammar::file>() == 0);
  CHECK(tao::pegtl::analyze<nff::grammar::resume>() == 0);
}

}  // namespace pprt::nff_grammar_test
