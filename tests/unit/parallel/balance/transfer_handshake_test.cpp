// Who may give, who takes, and how they come to know it.
#include "parallel/balance/transfer_handshake.h"

#include <catch2/catch.hpp>

namespace pprt {
namespace {

// Two ranks that talk by words, delivered at once.
struct Talk {
  TransferHandshake a{2}, b{2};  // ranks 0 and 1
  void a_tells() { b.hear(0, a.tell(1)); }
  void b_tells() { a.hear(1, b.tell(0)); }
};

}  // namespace

TEST_CASE("a rank takes at first, and who has said nothing is not known to take") {
  const TransferHandshake handshake(3);
  CHECK_FALSE(handshake.is_giving());
  CHECK_FALSE(handshake.may_give());
  CHECK_FALSE(handshake.takes(1));
  CHECK_FALSE(handshake.owes_word(1));
}

TEST_CASE("a rank that nobody believes to take may give at once") {
  Talk talk;
  talk.a.decide(true);
  CHECK(talk.a.may_give());
  talk.b_tells();
  CHECK(talk.a.takes(1));
  talk.b.decide(true);
  talk.b_tells();
  CHECK_FALSE(talk.a.takes(1));
}

TEST_CASE("who was told that a rank takes must know that it gives before it may") {
  Talk talk;
  talk.a_tells();
  talk.a.decide(true);
  CHECK_FALSE(talk.a.may_give());
  CHECK(talk.a.owes_word(1));
  const HandshakeState before = talk.b.tell(0);  // said before it knew
  talk.a_tells();
  CHECK_FALSE(talk.a.owes_word(1));
  talk.a.hear(1, before);
  CHECK_FALSE(talk.a.may_give());
  CHECK(talk.b.owes_word(0));
  talk.b_tells();
  CHECK_FALSE(talk.b.owes_word(0));
  CHECK(talk.a.may_give());
}

TEST_CASE("all who were told must know, not one") {
  TransferHandshake handshake(3), first(3), second(3);
  first.hear(0, handshake.tell(1));
  second.hear(0, handshake.tell(2));
  handshake.decide(true);
  first.hear(0, handshake.tell(1));
  handshake.hear(1, first.tell(0));
  CHECK_FALSE(handshake.may_give());
  second.hear(0, handshake.tell(2));
  handshake.hear(2, second.tell(0));
  CHECK(handshake.may_give());
}

TEST_CASE("repeating a decision changes nothing, going back and forth needs a new acknowledgement") {
  Talk talk;
  talk.a_tells();
  talk.a.decide(true);
  talk.a_tells();
  talk.b_tells();
  talk.a.decide(true);
  CHECK(talk.a.may_give());
  talk.a.decide(false);
  CHECK_FALSE(talk.a.may_give());
  talk.a.decide(true);
  CHECK(talk.a.may_give());  // in between it has said nothing
  talk.a.decide(false);
  talk.a_tells();
  talk.a.decide(true);
  CHECK_FALSE(talk.a.may_give());
  talk.b_tells();  // b has heard of the taking only
  CHECK_FALSE(talk.a.may_give());
}

TEST_CASE("a taker is given more when it has counted what it got") {
  Talk talk;
  talk.b_tells();
  talk.a.decide(true);
  CHECK(talk.a.has_counted_gifts(1));
  talk.a.gave(1);
  CHECK_FALSE(talk.a.has_counted_gifts(1));
  talk.b_tells();  // it has not come yet
  CHECK_FALSE(talk.a.has_counted_gifts(1));
  talk.b.took(0);
  talk.b_tells();
  CHECK(talk.a.has_counted_gifts(1));
}

}  // namespace pprt
