// Naming a database: the forms accepted, and what is said about the others.
#include <catch2/catch.hpp>

#include <string>

#include "base/diagnostics.h"
#include "spd/spd.h"

namespace pprt::spd_names_test {

namespace {

std::string message_of(const std::string& scene) {
  try {
    make_spd_scene(scene);
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("only names that begin with spd: mean a database") {
  CHECK(is_spd_name("spd:tree"));
  CHECK(is_spd_name("spd:"));
  CHECK_FALSE(is_spd_name("spd"));
  CHECK_FALSE(is_spd_name("SPD:tree"));
  CHECK_FALSE(is_spd_name("spd.nff"));
  CHECK_FALSE(is_spd_name(""));
}

TEST_CASE("a name without a size means the default size") {
  CHECK(make_spd_scene("spd:tetra").name == "spd:tetra:6");
  CHECK(make_spd_scene("spd:tetra:3").name == "spd:tetra:3");
  CHECK(make_spd("tetra").name == "spd:tetra:6");
  CHECK(make_spd("tetra", 2).name == "spd:tetra:2");
  CHECK(make_spd_scene("spd:teapot").name == "spd:teapot:12");
}

TEST_CASE("an unknown database is answered with the nearest name and the list") {
  CHECK(message_of("spd:tre:4") ==
        "spd:tre:4: error: no procedural database has the name 'tre'; did you mean 'tree'? "
        "(there are: tree balls gears mount rings tetra teapot jacks lattice)");
  CHECK(message_of("spd:latice").find("did you mean 'lattice'?") != std::string::npos);
  CHECK(message_of("spd:Tree").find("did you mean 'tree'?") != std::string::npos);
  CHECK(message_of("spd:shells") ==
        "spd:shells: error: no procedural database has the name 'shells' "
        "(there are: tree balls gears mount rings tetra teapot jacks lattice)");
  CHECK(message_of("spd:").find("the name ''") != std::string::npos);
  CHECK(message_of("spd:" + std::string(1000000, 'x')).find("did you mean") == std::string::npos);
}

TEST_CASE("a size that is no positive whole number is refused") {
  CHECK(message_of("spd:tree:0") == "spd:tree:0: error: the size must be at least 1");
  CHECK(message_of("spd:tree:-3") == "spd:tree:-3: error: the size must be at least 1");
  for (const std::string size : {"", "x", "4x", "4.5", " 4", "+4", "4:5"}) {
    CHECK(message_of("spd:tree:" + size) ==
          "spd:tree:" + size + ": error: the size '" + size + "' is not a whole number");
  }
}

TEST_CASE("a size beyond the limit is refused before anything is made") {
  CHECK(message_of("spd:tree:60") ==
        "spd:tree:60: error: too large: 4.61e+18 primitives, the limit is 2e+07 (size 22)");
  CHECK(message_of("spd:balls:2147483647") ==
        "spd:balls:2147483647: error: too large: inf primitives, the limit is 2e+07 (size 7)");
  CHECK(message_of("spd:tree:99999999999999999999") ==
        "spd:tree:99999999999999999999: error: too large: the largest size is 22");
  for (const SpdDatabase& database : spd_databases()) {
    CHECK_THROWS_AS(make_spd(database.name, 2147483647), InputError);
  }
}

}  // namespace pprt::spd_names_test
