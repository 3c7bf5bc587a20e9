#include "parser/anim/anim_grammar.h"

#include <catch2/catch.hpp>
#include <tao/pegtl/contrib/analyze.hpp>

namespace pprt::anim_grammar_test {
namespace {

TEST_CASE("the grammar has no loop that consumes nothing and no left recursion") {
  CHECK(tao::pegtl::analyze<anim::grammar::script>() == 0);
}

}  // namespace
}  // namespace pprt::anim_grammar_test
