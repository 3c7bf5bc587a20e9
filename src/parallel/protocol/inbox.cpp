#include "parallel/protocol/inbox.h"

#include <algorithm>
#include <iterator>

namespace pprt {

bool Inbox::pump() {
  bool any = false;
  while (const std::optional<Message> message = network_.receive()) {
    any = true;
    accept(*message);
  }
  after_look_();
  return any;
}

void Inbox::accept(const Message& message) {
  switch (message.tag) {
    case Tag::kFrameOrder:
      orders_.push_back(decode_frame_order(message.payload));
      return;
    case Tag::kBundle:
      bundles_.push_back({message.from, decode_bundle(message.payload)});
      return;
    case Tag::kRoundDue:
      due_ = decode_round_due(message.payload);
      return;
    case Tag::kEnough:
      has_enough_ = true;
      return;
    case Tag::kPixels:
    case Tag::kTransfers:
    case Tag::kRoundSent:
    case Tag::kClockPing:
    case Tag::kClockPong:
      to_session_(message);
      return;
    case Tag::kStart:
      throw ProtocolError("a message came that belongs before the sequence");
  }
  throw ProtocolError("a message came of a kind that is none");
}

std::optional<FrameOrder> Inbox::take_order(int index) {
  const auto order = std::find_if(orders_.begin(), orders_.end(),
                                  [index](const FrameOrder& o) { return o.end || o.index == index; });
  if (order == orders_.end()) return std::nullopt;
  const FrameOrder taken = *order;
  orders_.erase(order);
  return taken;
}

std::vector<Inbox::Arrived> Inbox::take_bundles(const std::function<bool(const Arrived&)>& wanted) {
  const auto first =
      std::stable_partition(bundles_.begin(), bundles_.end(), [&](const Arrived& a) { return !wanted(a); });
  std::vector<Arrived> taken(std::make_move_iterator(first), std::make_move_iterator(bundles_.end()));
  bundles_.erase(first, bundles_.end());
  std::stable_sort(taken.begin(), taken.end(),
                   [](const Arrived& a, const Arrived& b) { return a.from < b.from; });
  return taken;
}

std::optional<std::size_t> Inbox::bundles_due(int frame_index, int round) const {
  if (!due_ || due_->frame_index != frame_index || due_->round != round) return std::nullopt;
  return due_->bundles;
}

std::size_t Inbox::count_bundles(const std::function<bool(const Arrived&)>& wanted) const {
  return static_cast<std::size_t>(std::count_if(bundles_.begin(), bundles_.end(), wanted));
}

}  // namespace pprt
