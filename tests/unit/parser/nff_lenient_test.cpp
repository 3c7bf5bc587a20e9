// Each way in which real files depart from NFF.TXT: what the lenient reading makes of it and says, and that
// the strict one refuses it.
#include <catch2/catch.hpp>
#include <string>

#include "unit/parser/nff_sample.h"

namespace pprt::nff_lenient_test {
namespace {

const std::string kFill = "f 1 0 0 1 0 0 0 1\n";
const std::string kView = "v from 0 5 -5 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 64 32\n";

// The first line of a report: "t.nff:1:1: warning: ...".
std::string first_line(const std::string& report) {
  return report.substr(0, report.find('\n'));
}

bool accepted_strictly(const std::string& text) {
  return report(text, strict()).empty();
}

}  // namespace

TEST_CASE("harmless variants are read without a warning, in strict reading too") {
  for (const std::string& text :
       {"\xef\xbb\xbf" + kFill + "s 0 0 0 1", kFill + "s 0 0 0 1\n\x1a", kFill + "s0 0 0 1",
        kFill + "s 0 0 0 1#red", kFill + "s +0 .5 5. 1e0", kFill + "c\n0 0 0 1\n0 0 1 1\n",
        kFill + "c \n0 0 0 1\n0 0 1 1\n", kFill + "c 0 0 0 1 0 0 1 1", kFill + "p3 0 0 0 1 0 0 0 1 0",
        kFill + "p 3 0 0 0 1 0 0\n0 1 0", kFill + "pp3 0 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 0",
        std::string("l1 2 3\nl 1 2 3 1 1 1\nb0 0 0 ") + kView}) {
    CAPTURE(text);
    CHECK(report(text).empty());
    CHECK(warnings(text).empty());
    CHECK(accepted_strictly(text));
  }
}

TEST_CASE("a byte order mark does not shift the places") {
  CHECK(scene("\xef\xbb\xbfs 0 0 0 1").spheres[0].location == SourceLocation{1, 1});
}

TEST_CASE("an unambiguous deviation is read without a warning, and rejected in strict reading") {
  for (const std::string& text :
       {"% note\n" + kFill, "/* note\n s 0 0 0 0 */" + kFill, kFill + "s 0 0 0 1\n" + kView,
        kFill + "s 0 0 0 1\nl 1 2 3\n", std::string("f Red 1 0 0 0 1\n"), std::string("b MidnightBlue"),
        std::string("v from 0 5 -5 at 0 0 0 up 0 1 0 angle 45 resolution 64 32\n")}) {
    CAPTURE(text);
    CHECK(warnings(text).empty());
    CHECK_FALSE(accepted_strictly(text));
  }
}

TEST_CASE("a comment counts once although rules before it are tried again") {
  CHECK(report("l 1 2 3 % note\n%note\n", strict()) ==
        "t.nff:1:9: error: a '%' comment belongs to AFF, not to NFF\n"
        "    l 1 2 3 % note\n"
        "            ^\n"
        "t.nff:2:1: error: a '%' comment belongs to AFF, not to NFF\n"
        "    %note\n"
        "    ^");
}

TEST_CASE("the parts of a view stand in any order") {
  const View view = *scene("v resolution 64 32 angle 30 yon 9 up 0 1 0 hither 2 at 1 2 3 from 4 5 6").view;
  CHECK(view.from == Vec3d(4, 5, 6));
  CHECK(view.at == Vec3d(1, 2, 3));
  CHECK(view.angle_degrees == 30);
  CHECK(view.hither == 2);
  CHECK(view.width == 64);
  CHECK(view.height == 32);
  CHECK(accepted_strictly("v resolution 64 32 angle 30 up 0 1 0 hither 2 at 1 2 3 from 4 5 6"));
}

TEST_CASE("a lenient reading reports each deviation once, with what it does") {
  struct Case {
    std::string text;
    std::string said;
  };
  const std::string sphere = "s 0 0 0 1\n";
  const std::vector<Case> cases = {
      {"Subject: a scene\n" + kFill, "1:1: warning: a mail header is not part of a scene: skipped"},
      {kView + kView, "2:1: warning: 'v' is given again: the last one counts"},
      {"v from 0 5 -5 at 0 0 0 up 0 1 0 angle 45 yon 9 hither 1 resolution 8 8",
       "1:42: warning: 'yon' is not NFF: ignored"},
      {"v from 0 5 -5 at 0 0 0 up 0 1 0 angle 45 angle 50 hither 1 resolution 8 8",
       "1:42: warning: a part of 'v' is given twice: the last one counts"},
      {"v from 0 5 -5 at 0 0 0 up 0 1 0 angle 45 hither 1",
       "1:1: warning: 'v' lacks 'resolution': 512 x 512 is taken"},
      {"b 0 0 0 b 1 1 1", "1:9: warning: 'b' is given again: the last one counts"},
      {"l 1 2 3 0.5 1 1 1", "1:1: warning: 'l' with 7 numbers is not NFF: read as x y z intensity r g b"},
      {"f 1 1 1 0.5\n",
       "1:1: warning: 'f' has fewer than 8 numbers: those missing are taken from Kd 1, Ks 0, Shine 0, T 0, "
       "index 1"},
      {"f 0.5 0.2\n",
       "1:1: warning: 'f' has fewer than the 3 numbers of a colour: the last one stands for those missing; "
       "Kd 1, Ks 0, Shine 0, T 0, index 1"},
      {"f 1 1 1 1 0 0 0 1 0.2\n",
       "1:19: warning: 'f' has more than 8 numbers: those after the 8th are ignored"},
      {"f 1 1 1 1 0 0 0 1 earth.jpg 2\n",
       "1:19: warning: 'f' takes only numbers: the rest of the line is ignored"},
      {"f 1 1 1 1 0 0 0.5 0\n", "1:1: warning: T is above 0 but the index of refraction is not: 1 is taken"},
      {sphere, "1:1: warning: there is no 'f' before the first object: white with Kd 1 is taken"},
      {kFill + "s 0 0 0 1 2 3", "2:1: warning: 's' has 2 more numbers than x y z radius: they are ignored"},
      {kFill + "s 0 0 0 0", "2:1: warning: the sphere's radius is 0: left out"},
      {kFill + "c 1 2 3 1 1 2 3 1", "2:1: warning: the cone's base and apex are the same point: left out"},
      {kFill + "c 1 2 3 0 1 2 4 -0", "2:1: warning: both radii of the cone are 0: left out"},
      {kFill + "c 1 2 3 -1 1 2 4 1",
       "2:1: warning: one radius of the cone is negative and the other positive: left out"},
      {kFill + "p 2 0 0 0 1 1 1", "2:1: warning: the polygon has fewer than 3 vertices: left out"},
      {kFill + "p 0", "2:1: warning: the polygon has fewer than 3 vertices: left out"},
      {kFill + "pp 3 0 0 0 0 0 1 1 1 1 0 0 1 2 2 2 0 0 1", "2:1: warning: the polygon's area is 0: left out"},
      {kFill + "tess 4\n",
       "2:1: warning: unknown entity 'tess' (in Assimp's dialect the tessellation): "
       "skipped to the end of its line"},
  };
  for (const Case& c : cases) {
    CAPTURE(c.text);
    const std::string said = warnings(c.text);
    CHECK(first_line(said) == "t.nff:" + c.said);
    CHECK(std::count(said.begin(), said.end(), '\n') == 3);  // one warning: the message, its line, the caret
    CHECK_FALSE(accepted_strictly(c.text));
  }
}

TEST_CASE("a repeated deviation is reported once, with its count") {
  CHECK(warnings(kFill + "s 0 0 0 0\ns 0 0 0 1\n s 0 0 0 0\ns 0 0 0 0") ==
        "t.nff:2:1: warning: the sphere's radius is 0: left out (3 times, first here)\n"
        "    s 0 0 0 0\n"
        "    ^\n");
}

TEST_CASE("the last view and the last background count") {
  CHECK(scene(kView + "v from 0 7 -5 at 0 0 0 up 0 1 0 angle 45").view->from.y == 7);
  CHECK(scene("b 0 0 0 b white").background == Rgb(1, 1, 1));
}

TEST_CASE("lights may have a colour, and an intensity before it") {
  CHECK_FALSE(scene("l 1 2 3").lights[0].color);
  CHECK(scene("l 1 2 3 1 0.5 0").lights[0].color == Rgb(1, 0.5, 0));
  CHECK(scene("l 1 2 3 0.5 1 0.5 0").lights[0].color == Rgb(0.5, 0.25, 0));
}

TEST_CASE("fill lines of the dialects are read") {
  const auto material = [](const std::string& fill) { return scene(fill + "\ns 0 0 0 1").materials.at(0); };
  CHECK(material("f .5 1 0 .7 .2 3 0 1.5") == Material{{0.5, 1, 0}, 0.7, 0.2, 3, 0, 1.5});
  CHECK(material("f blue .7 .2 3 0 1.5") == Material{{0, 0, 1}, 0.7, 0.2, 3, 0, 1.5});
  CHECK(material("f blue") == Material{{0, 0, 1}, 1, 0, 0, 0, 1});
  CHECK(material("f .5 1 0 .7 .2 3") == Material{{0.5, 1, 0}, 0.7, 0.2, 3, 0, 1});
  CHECK(material("f .5") == Material{{0.5, 0.5, 0.5}, 1, 0, 0, 0, 1});
  CHECK(material("f .5 1") == Material{{0.5, 1, 1}, 1, 0, 0, 0, 1});
  CHECK(material("f .5 1 0") == Material{{0.5, 1, 0}, 1, 0, 0, 0, 1});
  CHECK(material("f .5 1 0 .7 .2 3 0 1.5 9 9") == Material{{0.5, 1, 0}, 0.7, 0.2, 3, 0, 1.5});
  CHECK(material("f .5 1 0 .7 .2 3 0 1.5 s.jpg c.jpg 3") == Material{{0.5, 1, 0}, 0.7, 0.2, 3, 0, 1.5});
  CHECK(material("f .5 1 0 .7\n.2 3 0 0") == Material{{0.5, 1, 0}, 0.7, 0.2, 3, 0, 0});
}

TEST_CASE("an entity on the line of a fill is not its texture") {
  const SceneDescription read =
      parse_nff(
          "f 1 1 1 1 0 0 0 1 s 0 0 0 1 f 1 0 0 1 0 0 0 1 pp3 0 0 0 0 0 1 1 0 0 0 0 1 "
          "0 1 0 0 0 1",
          "t.nff", strict())
          .scene;
  CHECK(read.spheres.size() == 1);
  CHECK(read.patches.size() == 1);
  CHECK(read.materials.size() == 2);
}

TEST_CASE("objects before the first fill are white, those after it are not") {
  const SceneDescription read = scene("s 0 0 0 1\nf 1 0 0 1 0 0 0 1\ns 0 0 0 1\n");
  CHECK(read.materials.at(read.spheres[0].material) == Material{});
  CHECK(read.materials.at(read.spheres[1].material).color == Rgb(1, 0, 0));
}

TEST_CASE("degenerate objects are left out and the others stay") {
  const SceneDescription read = scene(kFill +
                                      "s 0 0 0 0\ns 0 0 0 2\np 3 .1 .1 .1 .2 .2 .2 .3 .3 .3\n"
                                      "p 3 1e6 0 0 1000001 0 0 1000001 .001 0\n");
  REQUIRE(read.spheres.size() == 1);
  CHECK(read.spheres[0].radius == 2);
  CHECK(read.polygons.size() == 1);
  CHECK(read.polygon_vertices.size() == 3);
  CHECK(read.primitive_count() == 2);
}

TEST_CASE("unknown entities are skipped with the numbers that follow, and reported by name") {
  const std::string text =
      kFill + "tt wood.tga 0 0 0 0 0\n 1 0 0 1 0\n 0 1 0 0 1\ns 0 0 0 1\nblob 1 2 3\nblob 4\n";
  CHECK(scene(text).spheres.size() == 1);
  CHECK(
      warnings(text) ==
      "t.nff:2:1: warning: unknown entity 'tt' (in AFF a textured triangle): skipped to the end of its line\n"
      "    tt wood.tga 0 0 0 0 0\n"
      "    ^\n"
      "t.nff:6:1: warning: unknown entity 'blob': skipped to the end of its line (2 times, first here)\n"
      "    blob 1 2 3\n"
      "    ^\n");
}

TEST_CASE("any number of unknown words makes a bounded report") {
  std::string text = kFill;
  for (int i = 0; i < 1000; ++i) text += "word" + std::to_string(i) + "\n";
  const std::string said = warnings(text);
  CHECK(std::count(said.begin(), said.end(), '\n') == 9 * 3);
  CHECK(said.find("unknown entity of other kinds: skipped to the end of its line (992 times, first here)") !=
        std::string::npos);
}

TEST_CASE("the headers of a mailed scene are skipped") {
  const SceneDescription read = scene(
      "From haines Fri Dec  6 1996\nSubject: a scene\n of spheres\nX-Lines: 3\n\nf 1 0 0 1 0 0 0 1\n s 0 0 0 "
      "1\n");
  CHECK(read.spheres.size() == 1);
  CHECK(read.materials.size() == 1);
  CHECK(scene("Subject: x\n s 0 0 0 1\n").spheres.size() == 1);
}

}  // namespace pprt::nff_lenient_test
