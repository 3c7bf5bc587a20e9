// What COLLADA's text tells of its cameras, tag by tag.
#include "convert/mesh/collada_cameras.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

namespace pprt::collada_cameras_test {
namespace {

// A camera with these elements, held by a node "eye" whose id is "e1".
std::string with_camera(const std::string& elements) {
  return "<COLLADA><library_cameras><camera id=\"c\" name=\"n\"><optics><technique_common><perspective>" +
         elements +
         "</perspective></technique_common></optics></camera></library_cameras><visual_scene>"
         "<node id=\"e1\" name=\"eye\"><instance_camera url=\"#c\"/></node></visual_scene></COLLADA>";
}

double half_tangent(double degrees) {
  return std::tan(degrees / 2 * std::numbers::pi / 180);
}

}  // namespace

TEST_CASE("COLLADA cameras: half the height is that of the upright angle, or of the other by the aspect") {
  const auto camera = [](std::optional<double> x_degrees, std::optional<double> y_degrees,
                         std::optional<double> aspect) {
    return ColladaCamera{.x_degrees = x_degrees, .y_degrees = y_degrees, .aspect = aspect, .near = {}};
  };
  const ColladaCamera y = camera({}, 40, {}), x = camera(60, {}, 2), alone = camera(60, {}, {}),
                      both = camera(60, 40, 7), none = camera({}, {}, 2);
  CHECK(*y.half_height() == Approx(half_tangent(40)));
  CHECK(*x.half_height() == Approx(half_tangent(60) / 2));
  CHECK(*alone.half_height() == Approx(half_tangent(60)));
  CHECK(*both.half_height() == Approx(half_tangent(40)));
  CHECK_FALSE(none.half_height());
  CHECK((y.ratio() == 1 && x.ratio() == 2 && none.ratio() == 2));
  CHECK(both.ratio() == Approx(half_tangent(60) / half_tangent(40)));  // two angles tell it themselves
}

TEST_CASE("COLLADA cameras: each element is read where it stands, with blanks and with attributes") {
  const auto camera = [](const std::string& elements) {
    const auto cameras = collada_cameras(with_camera(elements));
    REQUIRE((cameras.size() == 2 && cameras.contains("eye") && cameras.contains("e1")));
    return cameras.at("eye");
  };
  const ColladaCamera all = camera(
      "<xfov sid=\"f\"> 60.5 </xfov>\n<yfov>\t40\n</yfov><aspect_ratio>1.5</aspect_ratio><znear>.25</znear>"
      "<zfar>100</zfar>");
  CHECK((all.x_degrees == 60.5 && all.y_degrees == 40.0 && all.aspect == 1.5 && all.near == 0.25));
  const ColladaCamera few = camera("<yfov>30</yfov><!-- <xfov>50</xfov> <znear>1</znear> -->");
  CHECK((few.y_degrees == 30.0 && !few.x_degrees && !few.aspect && !few.near));
  for (const char* bad : {"", " ", "wide", "0", "-20", "inf", "nan"}) {
    INFO(bad);
    CHECK_FALSE(camera("<yfov>" + std::string(bad) + "</yfov><znear>1</znear>").y_degrees);
  }
}

TEST_CASE("COLLADA cameras: a camera is that of the node around its instance, by name and by id") {
  const std::string text =
      R"(<camera id="wide"><yfov>80</yfov></camera><camera id='narrow'><yfov>20</yfov></camera>
<node id="outer" name="a">
  <node id="inner" name='b'><instance_camera url="#narrow"/></node>
  <node name="empty"/>
  <instance_camera url="wide"></instance_camera>
</node>
<node id="other" nickname="c"><instance_camera url="#none"/></node>)";
  const auto cameras = collada_cameras(text);
  CHECK(cameras.size() == 4);
  for (const char* node : {"inner", "b"}) CHECK(cameras.at(node).y_degrees == 20.0);
  for (const char* node : {"outer", "a"}) CHECK(cameras.at(node).y_degrees == 80.0);
}

TEST_CASE("COLLADA cameras: elements outside a camera, and text without an end, are passed over") {
  CHECK(collada_cameras("<yfov>30</yfov><node name=\"a\"><instance_camera url=\"#c\"/></node>").empty());
  CHECK(collada_cameras("<camera id=\"c\"/><yfov>30</yfov>").empty());
  CHECK(collada_cameras("").empty());
  CHECK(collada_cameras("<node name=\"a\"").empty());
  CHECK(collada_cameras("<!-- <node").empty());
  CHECK(collada_cameras("<instance_camera url=\"#c\"/></node></node>").empty());
}

}  // namespace pprt::collada_cameras_test
