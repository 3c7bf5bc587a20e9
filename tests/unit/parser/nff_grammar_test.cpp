#include "parser/nff_grammar.h"

#include <catch2/catch.hpp>
#include <tao/pegtl/contrib/analyze.hpp>

namespace pprt::nff {

TEST_CASE("no rule of the NFF grammar can loop without consuming") {
  CHECK(grammar::pegtl::analyze<grammar::file>() == 0);
  CHECK(grammar::pegtl::analyze<grammar::resume>() == 0);
}

}  // namespace pprt::nff
