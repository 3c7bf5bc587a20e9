// Who may give, who takes, and how they come to know it.
#include "parallel/balance/transfer_handshake.h"

#include <catch2/catch.hpp>

namespace pprt::transfer_handshake_test {
namespace {

// Two ranks whose messages are delivered at once.
struct Talk {
  TransferHandshake a{2}, b{2};  // ranks 0 and 1
  void a_sends() { b.receive(0, a.send(1)); }
  void b_sends() { a.receive(1, b.send(0)); }
};

}  // namespace

TEST_CASE(
    "transfer handshake: a rank accepts tiles at first, and expects nothing of ranks that sent nothing") {
  const TransferHandshake handshake(3);
  CHECK_FALSE(handshake.is_giving());
  CHECK_FALSE(handshake.may_transfer());
  CHECK_FALSE(handshake.accepts(1));
  CHECK_FALSE(handshake.has_pending_reply(1));
}

TEST_CASE("transfer handshake: a rank that nobody believes to accept tiles may give at once") {
  Talk talk;
  talk.a.set_giving(true);
  CHECK(talk.a.may_transfer());
  talk.b_sends();
  CHECK(talk.a.accepts(1));
  talk.b.set_giving(true);
  talk.b_sends();
  CHECK_FALSE(talk.a.accepts(1));
}

TEST_CASE("transfer handshake: a rank may give only after its change was acknowledged") {
  Talk talk;
  talk.a_sends();
  talk.a.set_giving(true);
  CHECK_FALSE(talk.a.may_transfer());
  CHECK(talk.a.has_pending_reply(1));
  const HandshakeState before = talk.b.send(0);  // said before it knew
  talk.a_sends();
  CHECK_FALSE(talk.a.has_pending_reply(1));
  talk.a.receive(1, before);
  CHECK_FALSE(talk.a.may_transfer());
  CHECK(talk.b.has_pending_reply(0));
  talk.b_sends();
  CHECK_FALSE(talk.b.has_pending_reply(0));
  CHECK(talk.a.may_transfer());
}

TEST_CASE("transfer handshake: all ranks that were told must acknowledge, not one") {
  TransferHandshake handshake(3), first(3), second(3);
  first.receive(0, handshake.send(1));
  second.receive(0, handshake.send(2));
  handshake.set_giving(true);
  first.receive(0, handshake.send(1));
  handshake.receive(1, first.send(0));
  CHECK_FALSE(handshake.may_transfer());
  second.receive(0, handshake.send(2));
  handshake.receive(2, second.send(0));
  CHECK(handshake.may_transfer());
}

TEST_CASE(
    "transfer handshake: repeating a decision changes nothing, changing back and forth needs a new "
    "acknowledgement") {
  Talk talk;
  talk.a_sends();
  talk.a.set_giving(true);
  talk.a_sends();
  talk.b_sends();
  talk.a.set_giving(true);
  CHECK(talk.a.may_transfer());
  talk.a.set_giving(false);
  CHECK_FALSE(talk.a.may_transfer());
  talk.a.set_giving(true);
  CHECK(talk.a.may_transfer());  // in between it has said nothing
  talk.a.set_giving(false);
  talk.a_sends();
  talk.a.set_giving(true);
  CHECK_FALSE(talk.a.may_transfer());
  talk.b_sends();  // b knows of the accepting only
  CHECK_FALSE(talk.a.may_transfer());
}

TEST_CASE("transfer handshake: a rank is sent further tiles only after it has confirmed the last") {
  Talk talk;
  talk.b_sends();
  talk.a.set_giving(true);
  CHECK(talk.a.has_confirmed_transfers(1));
  talk.a.transfer_sent(1);
  CHECK_FALSE(talk.a.has_confirmed_transfers(1));
  talk.b_sends();  // it has not come yet
  CHECK_FALSE(talk.a.has_confirmed_transfers(1));
  talk.b.transfer_received(0);
  talk.b_sends();
  CHECK(talk.a.has_confirmed_transfers(1));
}

}  // namespace pprt::transfer_handshake_test
