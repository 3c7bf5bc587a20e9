#include "parallel/protocol/inbox.h"

#include <catch2/catch.hpp>

#include "parallel/network/local_communicator.h"

namespace pprt::inbox_test {
namespace {

const auto kNoMaster = [](const Message&) { FAIL("pixels came to a worker"); };
const auto kAll = [](const Inbox::Arrived&) { return true; };

void send_order(LocalNetwork& network, int index, bool end = false) {
  FrameOrder order;
  order.index = index, order.end = end;
  LocalCommunicator(network, 0).send(1, Tag::kFrameOrder, encode(order));
}

void send_bundle(LocalNetwork& network, int from, int round) {
  LocalCommunicator(network, from)
      .send(1, Tag::kBundle, encode(Bundle{0, 0, round, false, 0, {}, {}, {}, {}}));
}

}  // namespace

TEST_CASE("inbox: orders wait for their turn") {
  LocalNetwork network(2);
  LocalCommunicator me(network, 1);
  Inbox inbox(me, 0.1, kNoMaster);
  CHECK_FALSE(inbox.pump());
  CHECK_FALSE(inbox.take_order(0));
  send_order(network, 0), send_order(network, 1), send_order(network, 0, true);
  CHECK(inbox.pump());
  CHECK_FALSE(inbox.pump());
  CHECK(inbox.take_order(0)->index == 0);
  CHECK_FALSE(inbox.take_order(1)->end);
  CHECK(inbox.take_order(2)->end);
}

TEST_CASE("inbox: bundles are taken in order of rank, then of sending") {
  LocalNetwork network(4);
  LocalCommunicator me(network, 1);
  Inbox inbox(me, 0.1, kNoMaster);
  send_bundle(network, 3, 1), send_bundle(network, 0, 1), send_bundle(network, 3, 2),
      send_bundle(network, 2, 1);
  inbox.pump();
  const auto first_round = [](const Inbox::Arrived& a) { return a.bundle.round == 1; };
  CHECK(inbox.count_bundles(first_round) == 3);
  const std::vector<Inbox::Arrived> taken = inbox.take_bundles(first_round);
  REQUIRE(taken.size() == 3);
  CHECK((taken[0].from == 0 && taken[1].from == 2 && taken[2].from == 3));
  send_bundle(network, 3, 3);
  inbox.pump();
  const std::vector<Inbox::Arrived> rest = inbox.take_bundles(kAll);
  REQUIRE(rest.size() == 2);
  CHECK((rest[0].bundle.round == 2 && rest[1].bundle.round == 3));
  CHECK(inbox.take_bundles(kAll).empty());
}

TEST_CASE("inbox: messages that do not belong into a sequence are refused") {
  LocalNetwork network(2);
  LocalCommunicator me(network, 1);
  Inbox inbox(me, 0.1, kNoMaster);
  LocalCommunicator(network, 0).send(1, Tag::kStart, {});
  CHECK_THROWS_AS(inbox.pump(), ProtocolError);
  LocalCommunicator(network, 0).send(1, Tag::kBundle, Bytes(3));
  CHECK_THROWS_AS(inbox.pump(), ProtocolError);
}

}  // namespace pprt::inbox_test
