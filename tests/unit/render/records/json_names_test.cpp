#include "render/records/json_names.h"

#include <catch2/catch.hpp>

namespace pprt::json_names_test {

TEST_CASE("a name that is UTF-8 is a string in JSON") {
  for (const std::string name : {"a.png", "", "K\u00e4se", "\U0001F600", "a\"b\\c\n"}) {
    CHECK(json_name(name) == name);
    CHECK(name_in(json_name(name)) == name);
  }
}

TEST_CASE("a name that is not UTF-8 has a character for each byte in JSON") {
  CHECK(json_name("K\xe4se").dump() == "{\"latin-1\":\"K\u00e4se\"}");
  std::string all;
  for (int byte = 1; byte < 256; ++byte) all += static_cast<char>(byte);
  CHECK(name_in(nlohmann::ordered_json::parse(json_name(all).dump())) == all);
  // Half of a character, a surrogate, and a form that is longer than it need be.
  for (const std::string name : {"\xc3", "\xed\xa0\x80", "\xc0\x80", "\xff"}) {
    CHECK(json_name(name).is_object());
    CHECK(name_in(json_name(name)) == name);
  }
}

TEST_CASE("what holds no name in JSON gives none") {
  for (const char* text : {"3", "null", "[]", "{}", "{\"latin-1\":3}", "{\"latin-1\":\"\u0100\"}"}) {
    CHECK_FALSE(name_in(nlohmann::ordered_json::parse(text)));
  }
}

}  // namespace pprt::json_names_test
