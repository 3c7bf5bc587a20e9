#include "render/records/json_names.h"

namespace pprt {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kBytes = "latin-1";

bool is_utf8(const std::string& text) {
  try {
    static_cast<void>(Json(text).dump());
    return true;
  } catch (const Json::type_error&) {
    return false;
  }
}

// Byte 0xE4 -> U+00E4, in UTF-8.
std::string text_of_bytes(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x80) text += static_cast<char>(0xC0 | byte >> 6);
    text += byte < 0x80 ? c : static_cast<char>(0x80 | (byte & 0x3F));
  }
  return text;
}

std::optional<std::string> bytes_of_text(const std::string& text) {
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    auto byte = static_cast<unsigned char>(text[i]);
    if (byte >= 0x80) {
      if (byte > 0xC3 || i + 1 == text.size()) return std::nullopt;  // beyond U+00FF
      byte = static_cast<unsigned char>((byte & 0x03) << 6 | (static_cast<unsigned char>(text[++i]) & 0x3F));
    }
    bytes += static_cast<char>(byte);
  }
  return bytes;
}

}  // namespace

Json json_name(const std::string& name) {
  if (is_utf8(name)) return name;
  return {{kBytes, text_of_bytes(name)}};
}

std::optional<std::string> name_in(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_object() || !value.contains(kBytes) || !value[kBytes].is_string()) return std::nullopt;
  return bytes_of_text(value[kBytes].get<std::string>());
}

}  // namespace pprt
