// docs/protocol.md states the sizes that the encoders make.
#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include "parallel/protocol/messages.h"

namespace pprt::protocol_test {
namespace {

std::string page() {
  std::ifstream file(PPRT_SOURCE_DIR "/docs/protocol.md");
  return {std::istreambuf_iterator<char>(file), {}};
}

// The owners make a row of so many rectangles.
std::size_t order_bytes(std::size_t rects, std::size_t tiles) {
  FrameOrder order;
  for (std::size_t i = 0; i < rects; ++i) order.owners.push_back(static_cast<std::int32_t>(i % 2));
  order.columns = static_cast<std::int32_t>(rects);
  order.tiles.resize(tiles);
  return encode(order).size();
}

std::size_t bundle_bytes(std::size_t progress, std::size_t given, std::size_t changes, std::size_t samples) {
  Bundle bundle;
  bundle.progress.mean_weight = static_cast<double>(progress);
  bundle.tiles.given.resize(given);
  bundle.tiles.changes.resize(changes);
  bundle.samples.resize(samples);
  return encode(bundle).size();
}

std::size_t pixels_bytes(std::size_t tiles, std::size_t transfers, std::size_t pixels,
                         std::size_t samples = 0) {
  PixelMessage message;
  message.tiles.resize(tiles);
  message.given.resize(transfers);
  message.colors.resize(pixels);
  message.samples.resize(samples);
  return encode(message).size();
}

// Returns the length of a message with so many choices, of so many tiles each.
std::size_t transfer_bytes(std::size_t choices, std::size_t given) {
  TransferMessage message;
  message.choices.resize(choices);
  for (TransferChoice& choice : message.choices) choice.given.resize(given);
  return encode(message).size();
}

// Numbers on the page, found by a pattern; each match's numbers go to `check`. What is optional and missing
// counts as 0, a "q " as 1.
template <typename Check>
int for_each_match(const std::string& text, const std::string& pattern, const Check& check) {
  const std::regex regex(pattern);
  int count = 0;
  for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match, ++count) {
    INFO(match->str());
    check([&](std::size_t i) {
      const std::string found = (*match)[i].str();
      return found.empty() ? std::size_t{0} : found == "q " ? std::size_t{1} : std::stoul(found);
    });
  }
  return count;
}

}  // namespace

TEST_CASE("docs/protocol.md: its size formulas are those of the encoders") {
  const std::string text = page();
  const auto states = [&](const std::string& formula) {
    return text.find('`' + formula + '`') != std::string::npos;
  };
  const auto n = [](std::size_t value) { return std::to_string(value); };
  const std::size_t order = order_bytes(0, 0), bundle = bundle_bytes(0, 0, 0, 0),
                    pixels = pixels_bytes(0, 0, 0);
  CHECK(states(n(order)));
  CHECK(states(n(order) + " + " + n(order_bytes(1, 0) - order) + " r + " + n(order_bytes(0, 1) - order) +
               " t"));
  const std::size_t given = bundle_bytes(0, 2, 0, 0) - bundle_bytes(0, 1, 0, 0);
  const std::size_t change = bundle_bytes(0, 1, 1, 0) - bundle_bytes(0, 1, 0, 0);
  CHECK(states(n(bundle) + " + " + n(bundle_bytes(1, 0, 0, 0) - bundle) + " q + " +
               n(bundle_bytes(0, 0, 0, 1) - bundle) + " s"));
  CHECK(states(n(bundle_bytes(0, 1, 0, 0) - bundle - given) + " + " + n(given) + " g + " + n(change) + " c"));
  CHECK(states(n(pixels) + " + " + n(pixels_bytes(1, 0, 0) - pixels) + " t + " +
               n(pixels_bytes(0, 1, 0) - pixels) + " g + " + n(pixels_bytes(0, 0, 1) - pixels) + " p + " +
               n(pixels_bytes(0, 0, 0, 1) - pixels) + " s"));
  CHECK(text.find("once a second from then on | `" + n(encode(ClockPing{}).size()) + "` |") !=
        std::string::npos);
  CHECK(text.find("with its time | `" + n(encode(ClockPong{}).size()) + "` |") != std::string::npos);
  const std::size_t nothing = transfer_bytes(0, 0), choice = transfer_bytes(1, 0);
  CHECK(states(n(nothing) + " + " + n(choice - nothing) + " d + " + n(transfer_bytes(1, 1) - choice) + " g"));
  RoundSent sent;
  const std::size_t to_nobody = encode(sent).size();
  sent.receivers.resize(1);
  CHECK(states(n(to_nobody) + " + " + n(encode(sent).size() - to_nobody) + " b"));
  CHECK(text.find("in that round | `" + n(encode(RoundDue{}).size()) + "` |") != std::string::npos);
  CHECK(text.find("report (" + n(sizeof(RankReport)) + ")") != std::string::npos);
}

TEST_CASE("docs/protocol.md: the sizes in its worked example are those of the encoders") {
  const std::string text = page();
  CHECK(3 == for_each_match(text, R"(\[order (\d+)r (\d+)t = (\d+)\])", [](const auto& number) {
          CHECK(order_bytes(number(1), number(2)) == number(3));
        }));
  constexpr const char* kBundle = R"(\[bundle (q )?(?:(\d+)g )?(?:(\d+)c )?(\d+)s = (\d+)\])";
  CHECK(17 <= for_each_match(text, kBundle, [](const auto& number) {
          CHECK(bundle_bytes(number(1), number(2), number(3), number(4)) == number(5));
        }));
  CHECK(6 == for_each_match(text, R"(\[pixels (\d+)t (\d+)g (\d+)p = (\d+)\])", [](const auto& number) {
          CHECK(pixels_bytes(number(1), number(2), number(3)) == number(4));
        }));
}

TEST_CASE("docs/protocol.md: its tags are those of the communicator") {
  const std::string text = page();
  const std::vector<std::pair<Tag, std::string>> tags = {
      {Tag::kClockPing, "kClockPing"},   {Tag::kClockPong, "kClockPong"}, {Tag::kStart, "kStart"},
      {Tag::kFrameOrder, "kFrameOrder"}, {Tag::kBundle, "kBundle"},       {Tag::kPixels, "kPixels"},
      {Tag::kRoundSent, "kRoundSent"},   {Tag::kRoundDue, "kRoundDue"},   {Tag::kTransfers, "kTransfers"},
      {Tag::kEnough, "kEnough"}};
  for (const auto& [tag, name] : tags) {
    const std::string row = "| " + std::to_string(static_cast<int>(tag)) + " `" + name + "` |";
    INFO(row);
    CHECK(text.find(row) != std::string::npos);
  }
}

}  // namespace pprt::protocol_test
