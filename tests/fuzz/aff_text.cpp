#include "aff_text.h"

#include <array>
#include <cstddef>
#include <string_view>

namespace pprt::fuzz {
namespace {

class AffText {
 public:
  explicit AffText(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::string scene() {
    text_ = "v from 0 -5 2 at 0 0 0 up 0 0 1 angle 45 hither .1 resolution 4 4\n";
    while (!bytes_.empty()) directive();
    for (; open_ > 0; --open_) text_ += "}\n";
    return std::move(text_);
  }

 private:
  std::size_t pick(std::size_t choices) {
    if (bytes_.empty()) return 0;
    const std::size_t byte = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return byte % choices;
  }

  void word(std::string_view text) { (text_ += text) += ' '; }

  void number() {
    constexpr std::array<std::string_view, 20> kNumbers = {
        "0",    "1",   "-1",   ".5",   "2",     "3.5",    "-.25",  "1e-9", "1e-30", "1e-45",
        "1e16", "1e7", "3e15", "1e19", "-1e20", "3.4e38", "-1e39", "1e60", "1e100", "-1e100"};
    // Half of them are plain, so that most objects have a shape.
    const std::size_t picked = pick(2 * kNumbers.size());
    word(kNumbers[picked < kNumbers.size() ? picked : picked % 7]);
  }
  void numbers(std::size_t count) {
    for (; count > 0; --count) number();
  }
  void name() {
    constexpr std::array<std::string_view, 4> kNames = {"a", "b", "camera", "t.ppm"};
    word(kNames[pick(kNames.size())]);
  }

  // Writes a count, and returns how many rows to write: now and then these are not as many.
  std::size_t count() {
    const std::size_t rows = pick(6), told = pick(16);
    word(std::to_string(told == 1 ? rows + 1 : told == 2 ? 0 : rows));
    return rows;
  }
  void rows(std::size_t numbers_each) {
    for (std::size_t left = count(); left > 0; --left) numbers(numbers_each);
  }
  // Writes an index into a list with that many entries. The one behind the last is as likely as each of them.
  void index(std::size_t size) {
    if (pick(32) == 1) return number();
    word(std::to_string(pick(size + 1)));
  }

  void mesh() {
    text_ += "m vertices ";
    const std::size_t positions = count();
    numbers(3 * positions);
    std::size_t normals = 0, texture_points = 0;
    if (pick(2) == 1) {
      word("normals");
      normals = count();
      numbers(3 * normals);
    }
    if (pick(2) == 1) {
      word("texturecoords");
      texture_points = count();
      name();
      numbers(2 * texture_points);
    }
    word("triangles");
    for (std::size_t left = count(); left > 0; --left) {
      for (const std::size_t size : {positions, normals, texture_points}) {
        if (size == 0 && size != positions) continue;
        for (int i = 0; i < 3; ++i) index(size);
      }
    }
  }

  void track() {
    word("k");
    name();
    word("{");
    for (std::size_t parts = pick(4); parts > 0; --parts) {
      constexpr std::array<std::string_view, 4> kParts = {"transl", "rot", "scale", "visibility"};
      const std::size_t part = pick(kParts.size());
      word(kParts[part]);
      if (part == 3) {
        rows(2);
      } else {
        const std::size_t keys = 4 + pick(2);
        word(std::to_string(keys));
        for (std::size_t key = 0; key < keys; ++key) {
          word(std::to_string(key));
          numbers(part == 1 ? 7 : 6);
        }
      }
    }
    word("}");
  }

  void textured(std::string_view keyword, std::size_t numbers_each) {
    word(keyword);
    name();
    numbers(3 * numbers_each);
  }

  void simple(std::string_view keyword, std::size_t count) {
    word(keyword);
    numbers(count);
  }

  void transform() {
    if (pick(2) == 0) {
      simple("xs", 10);
    } else {
      word("x");
      name();
    }
    text_ += "{";
    ++open_;
  }

  void directive() {
    switch (pick(22)) {
      case 0:
        simple("s", 4);
        break;
      case 1:
        simple("c", 8);
        break;
      case 2:
        simple("f", 8);
        break;
      case 3:
        simple("fm", 12);
        break;
      case 4:
        simple("l", pick(2) == 0 ? 3 : 6);
        break;
      case 5:
        word("la"), name(), numbers(3);
        break;
      case 6:
        simple("b", 3);
        break;
      case 7:
        simple("am", 3);
        break;
      case 8:
        word("p"), rows(3);
        break;
      case 9:
        word("pp"), rows(6);
        break;
      case 10:
        textured("tt", 5);
        break;
      case 11:
        textured("ttp", 8);
        break;
      case 12:
        word("tpa"), rows(19);
        break;
      case 13:
        mesh();
        break;
      case 14:
        track();
        break;
      case 15:
        transform();
        break;
      case 17:
        simple("ls", pick(2) == 0 ? 3 : 6);
        break;
      case 18:
        simple("bs", 9);
        break;
      case 19:
        simple("fe", 3);
        break;
      case 20:
        word("fet"), name(), numbers(3);
        break;
      case 16:
        word("a 0 2"), word(std::to_string(pick(4)));
        break;
      default:
        if (open_ == 0 && pick(8) != 1) return;
        word("}");
        open_ -= open_ > 0;
    }
    text_ += '\n';
  }

  std::span<const std::uint8_t> bytes_;
  std::string text_;
  std::size_t open_ = 0;  // braces
};

}  // namespace

std::string aff_text(std::span<const std::uint8_t> bytes) {
  return AffText(bytes).scene();
}

}  // namespace pprt::fuzz
