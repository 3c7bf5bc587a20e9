#include "base/content_hash.h"

#include <catch2/catch.hpp>

namespace pprt::content_hash_test {

TEST_CASE("a content hash is 64-bit FNV-1a in hexadecimal digits") {
  CHECK(content_hash("") == "cbf29ce484222325");
  CHECK(content_hash("a") == "af63dc4c8601ec8c");
  CHECK(content_hash("foobar") == "85944171f73967e8");
}

}  // namespace pprt::content_hash_test
