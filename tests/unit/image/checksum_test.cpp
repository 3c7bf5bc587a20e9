#include "image/checksum.h"

#include <catch2/catch.hpp>

#include "image/atomic_file.h"
#include "unit/image/temporary_directory.h"

using namespace pprt;

TEST_CASE("a checksum is the CRC-32 that its catalogue gives for the digits") {
  CHECK(crc32_of("123456789") == 0xcbf43926u);  // the check value of CRC-32/ISO-HDLC
  CHECK(crc32_of("") == 0u);
}

TEST_CASE("a file has the checksum of its content, and what is no file has none") {
  const TemporaryDirectory directory;
  write_whole_file(directory.path() / "file", "123456789");
  CHECK(crc32_of_file(directory.path() / "file") == 0xcbf43926u);
  CHECK_FALSE(crc32_of_file(directory.path() / "none"));
  CHECK_FALSE(crc32_of_file(directory.path()));
}
