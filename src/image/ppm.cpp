#include <algorithm>
#include <cctype>
#include <charconv>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "image/image_io.h"
#include "image/picture_checks.h"

namespace pprt {
namespace {

// Reads numbers between white space and comments.
class PpmText {
 public:
  explicit PpmText(std::string_view bytes) : rest_(bytes) {}

  int number(const char* what) {
    skip_space();
    int value = 0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc() || value < 0) throw std::runtime_error(std::string("it has no ") + what);
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return value;
  }

  // Behind the one byte of white space that ends the header.
  std::string_view body() const { return rest_.substr(std::min<std::size_t>(1, rest_.size())); }

 private:
  void skip_space() {
    while (!rest_.empty()) {
      if (rest_[0] == '#') {
        rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
      } else if (std::isspace(static_cast<unsigned char>(rest_[0])) != 0) {
        rest_.remove_prefix(1);
      } else {
        return;
      }
    }
  }

  std::string_view rest_;
};

}  // namespace

Image decode_ppm(std::string_view bytes, std::uint64_t max_memory) {
  const bool is_text = bytes.starts_with("P3");
  PpmText text(bytes.substr(2));
  const int width = text.number("width"), height = text.number("height");
  const int most = text.number("largest value");
  if (most < 1 || most > 255) throw std::runtime_error("a channel of it has more than 8 bits");
  require_decodable_size(width, height, max_memory);
  const std::size_t values = 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const std::string_view body = text.body();
  if (values == 0 || body.size() < values) throw std::runtime_error("the file ends early");
  Image image(width, height);
  const float per_value = 1 / static_cast<float>(most);
  std::size_t next = 0;
  const auto value = [&] {
    const int v = is_text ? text.number("value for each channel") : static_cast<unsigned char>(body[next++]);
    return static_cast<float>(v) * per_value;
  };
  for (Color& pixel : image.pixels) {
    const float r = value(), g = value(), b = value();
    pixel = Color(r, g, b);
  }
  return image;
}

}  // namespace pprt
