// The whole text of what a user is told when a scene is rejected.
#include <catch2/catch.hpp>
#include <string>

#include "unit/parser/nff_sample.h"

namespace pprt::nff_messages_test {
namespace {

std::string read_report(const std::string& path) {
  try {
    read_nff(path);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("a wrong value is named and pointed at") {
  CHECK(report("s 0 0 0 abc\n") ==
        "t.nff:1:9: error: expected a number for the radius of 's', found 'abc'\n"
        "    s 0 0 0 abc\n"
        "            ^");
  CHECK(report("# spheres\n\tc 0 0 0 1 1,5 0 0 1\n") ==
        "t.nff:2:12: error: expected a number for x of the apex of 'c', found '1,5'\n"
        "     c 0 0 0 1 1,5 0 0 1\n"
        "               ^");
  CHECK(report("pp 3\n0 0 0 0 0 1\n0 0 1 0 x 1\n") ==
        "t.nff:3:9: error: expected a number for y of the normal of vertex 2 of 3 of 'pp', found 'x'\n"
        "    0 0 1 0 x 1\n"
        "            ^");
}

TEST_CASE("a missing value is pointed at where it is missing") {
  CHECK(report("f 1 1 1 1 0 0 0 1\ns 0 0 0  # no radius\ns 0 0 0 1\n") ==
        "t.nff:2:8: error: expected a number for the radius of 's', found 's' on line 3\n"
        "    s 0 0 0  # no radius\n"
        "           ^");
  CHECK(report("p 3 0 0 0 1 0 0 0 1\n\n") ==
        "t.nff:1:20: error: expected a number for z of vertex 3 of 3 of 'p', found the end of the file\n"
        "    p 3 0 0 0 1 0 0 0 1\n"
        "                       ^");
}

TEST_CASE("numbers that are not finite say so") {
  CHECK(report("f 1 1 1 1 0 0 0 1 s 1e999 0 0 nan") ==
        "t.nff:1:21: error: expected a number for x of the centre of 's', found '1e999', which is too large\n"
        "    f 1 1 1 1 0 0 0 1 s 1e999 0 0 nan\n"
        "                        ^");
  CHECK(report("l -inf 0 0") ==
        "t.nff:1:3: error: expected a number for x of the position of 'l', found '-inf', but numbers must be "
        "finite\n"
        "    l -inf 0 0\n"
        "      ^");
}

TEST_CASE("every problem of a file is reported, in order of place") {
  CHECK(report("v from 0 0 0 at 0 0 0 up 0 1 0 angle 45 hither 0 resolution 8 8\n"
               "b reddish\n"
               "l 1 2 3 4\n"
               "f 1 1 1 1 0 0 0 1\n"
               "s 1 2 3 4 5\n"
               "c 0 0 0 1 0 0 1 1 7\n"
               "p 2.5\n"
               "v 1 2 3\n") ==
        "t.nff:1:1: error: the view's 'from' and 'at' are the same point\n"
        "    v from 0 0 0 at 0 0 0 up 0 1 0 angle 45 hither 0 resolution 8 8\n"
        "    ^\n"
        "t.nff:2:3: error: 'reddish' is neither a number nor the name of a colour\n"
        "    b reddish\n"
        "      ^\n"
        "t.nff:3:1: error: 'l' takes 3 numbers (x y z) or 6 (x y z r g b), found 4\n"
        "    l 1 2 3 4\n"
        "    ^\n"
        "t.nff:5:1: error: 's' takes 4 numbers (x y z radius), found 5\n"
        "    s 1 2 3 4 5\n"
        "    ^\n"
        "t.nff:6:19: error: expected an entity (v, b, l, f, c, s, p or pp) after 'c', found '7'\n"
        "    c 0 0 0 1 0 0 1 1 7\n"
        "                      ^\n"
        "t.nff:7:3: error: the number of vertices of 'p' must be a whole number\n"
        "    p 2.5\n"
        "      ^\n"
        "t.nff:8:3: error: expected one of from, at, up, angle, hither and resolution of 'v', found '1'\n"
        "    v 1 2 3\n"
        "      ^");
}

TEST_CASE("a degenerate view is rejected") {
  CHECK(report("v from 0 0 0 up 0 0 1 hither 1 resolution 8 8") ==
        "t.nff:1:1: error: 'v' lacks 'at', 'angle'\n"
        "    v from 0 0 0 up 0 0 1 hither 1 resolution 8 8\n"
        "    ^");
  CHECK(report("v from 0 0 0 at 0 0 2 up 0 0 1 angle 180 hither 1 resolution 8 0.5") ==
        "t.nff:1:1: error: the view's 'up' is 0 or points along the line of sight\n"
        "    v from 0 0 0 at 0 0 2 up 0 0 1 angle 180 hither 1 resolution 8 0.5\n"
        "    ^\n"
        "t.nff:1:32: error: the view's angle must lie between 0 and 180 degrees\n"
        "    v from 0 0 0 at 0 0 2 up 0 0 1 angle 180 hither 1 resolution 8 0.5\n"
        "                                   ^\n"
        "t.nff:1:51: error: the resolution must be two whole numbers from 1 to 65536\n"
        "    v from 0 0 0 at 0 0 2 up 0 0 1 angle 180 hither 1 resolution 8 0.5\n"
        "                                                      ^");
}

TEST_CASE("a file that is no scene is reported with what it is") {
  CHECK(report("") == "t.nff: error: the file is empty");
  CHECK(report(" \r\n\t") == "t.nff: error: the file is empty");
  CHECK(report("# only this\n") == "t.nff: error: the file holds only comments");
  CHECK(report(std::string("s 0 0 0 1\0", 10)) ==
        "t.nff: error: this is not a text file (it has zero bytes)");
  CHECK(report("\xff\xfes") == "t.nff: error: the text is in UTF-16; save it as UTF-8 or ASCII");
  for (const NffOptions& options : {NffOptions{}, strict()}) {
    CHECK(report("\n  Dear all,\nno scene here.\n", options) ==
          "t.nff:2:3: error: this is not an NFF scene: no entity (v, b, l, f, c, s, p or pp) in it; it "
          "begins with "
          "'Dear'\n"
          "      Dear all,\n"
          "      ^");
    CHECK(
        report("dod 0 0 0 1\n", options) ==
        "t.nff:1:1: error: this is no scene that is understood: no entity (v, b, l, f, c, s, p or pp) in it; "
        "it begins with 'dod' (in Assimp's dialect a dodecahedron)\n"
        "    dod 0 0 0 1\n"
        "    ^");
    for (const std::string first : {"nff", "NFF2"}) {
      CHECK(report(first + "\nversion 2.1\n", options) ==
            "t.nff:1:1: error: this is a Sense8 (WorldToolKit) file, another format of the same name: NFF of "
            "the "
            "Standard Procedural Databases is expected\n    " +
                first + "\n    ^");
    }
  }
}

TEST_CASE("an open comment ends the reading") {
  CHECK(report("s 0 0 0 1\n/* s 0 0 0\ns 0 0 0\n") ==
        "t.nff:2:1: error: expected '*/' to end this comment\n"
        "    /* s 0 0 0\n"
        "    ^");
}

TEST_CASE("a scene file that cannot be read is reported with the reason") {
  CHECK(read_report("/nonexistent.nff") == "cannot read '/nonexistent.nff': No such file or directory");
  CHECK(read_report("/") == "cannot read '/': Is a directory");
}

TEST_CASE("a word within the colour of a fill is a mistake, not a texture") {
  CHECK(report("f 1 O.5 0 1 0 0 0 1\n") ==
        "t.nff:1:5: error: expected a number for green in the colour of 'f', found 'O.5'\n"
        "    f 1 O.5 0 1 0 0 0 1\n"
        "        ^");
  CHECK(report("f 1 1 none\n") ==
        "t.nff:1:7: error: expected a number for blue in the colour of 'f', found 'none'\n"
        "    f 1 1 none\n"
        "          ^");
}

}  // namespace pprt::nff_messages_test
