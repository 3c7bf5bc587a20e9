// What clients may ask for.
#include "live/command.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "scene/animation/animation.h"

namespace pprt::command_test {
namespace {

using Json = nlohmann::json;

template <typename Command>
Command parsed(std::string_view text) {
  const LiveCommand command = parse_command(text);
  REQUIRE(std::holds_alternative<Command>(command));
  return std::get<Command>(command);
}

std::string look(const std::string& from, const std::string& at, const std::string& up,
                 const std::string& angle) {
  return R"({"do":"look","number":3,"from":)" + from + R"(,"at":)" + at + R"(,"up":)" + up + R"(,"angle":)" +
         angle + "}";
}

TEST_CASE("live commands: each is read with its values") {
  parsed<TakeCamera>(R"({"do":"take"})"), parsed<GiveCamera>(R"( { "do" : "give" } )");
  CHECK(parsed<PassCamera>(R"({"do":"pass","to":3})").to == 3);
  CHECK(parsed<PlayScript>(R"({"do":"play"})").on);
  CHECK_FALSE(parsed<PlayScript>(R"({"do":"pause"})").on);
  CHECK(parsed<StepScript>(R"({"do":"step","by":-1})").by == -1);
  CHECK(parsed<SeekScript>(R"({"do":"seek","frame":12})").frame == 12);
  CHECK(parsed<SetRate>(R"({"do":"rate","fps":23.976})").frames_per_second == 23.976);
  const auto size = parsed<SetSize>(R"({"do":"size","width":512,"height":384})");
  CHECK((size.width == 512 && size.height == 384));
  const auto seen = parsed<LookFrom>(look("[1,2,3.5]", "[0,0,0]", "[0,1e-3,0]", "45"));
  CHECK((seen.number == 3 && seen.view.from == Vec3d(1, 2, 3.5) && seen.view.at == Vec3d(0, 0, 0)));
  CHECK((seen.view.up == Vec3d(0, 1e-3, 0) && seen.view.angle_degrees == 45));
}

TEST_CASE("live commands: what is none is refused in words") {
  const auto refused = [](const std::string& text) -> std::string {
    try {
      parse_command(text);
      return "";
    } catch (const CommandError& e) {
      return e.what();
    }
  };
  for (const char* text : {"", "ack", "[]", "3", "null", "{", "{\"do\":\"take\"}x", "\"do\"", "\xff\xfe"})
    CHECK(refused(text) == "a message is no JSON object");
  CHECK(refused("{}") == "'do' is missing");
  CHECK(refused(R"({"do":"fly"})") == "there is no such command");
  CHECK(refused(R"({"do":7})") == "there is no such command");
  CHECK(refused(R"({"do":"pass"})") == "'to' is missing");
  CHECK(refused(R"({"do":"pass","to":1.5})") == "'to' is not a whole number");
  CHECK(refused(R"({"do":"pass","to":"1"})").starts_with("'to' is not a number from 1 to"));
  for (const char* text : {R"({"do":"photo","format":"gif"})", R"({"do":"photo","format":7})"})
    CHECK(refused(text) == "'format' has no such value");
  CHECK(refused(R"({"do":"overlay","name":"nothing"})") == "'name' has no such value");
  CHECK(refused(R"({"do":"rate","fps":121})") == "'fps' is not a number from 1 to 120");
  CHECK(refused(R"({"do":"rate","fps":1e999})") == "a message is no JSON object");
  CHECK(refused(R"({"do":"size","width":0,"height":9})") == "'width' is not a number from 1 to 4096");
  CHECK(refused(look("[1,2]", "[0,0,0]", "[0,1,0]", "45")) == "'from' has not three numbers");
  CHECK(refused(look("[1,2,1e16]", "[0,0,0]", "[0,1,0]", "45")).starts_with("'from' is not a number"));
  CHECK(refused(look("[1,2,null]", "[0,0,0]", "[0,1,0]", "45")).starts_with("'from' is not a number"));
  CHECK(refused(look("[1,2,3]", "[1,2,3]", "[0,1,0]", "45")) ==
        "the camera stands where it looks at: 'from' and 'at' are the same point");
  CHECK(refused(look("[0,0,0]", "[0,5,0]", "[0,1,0]", "45")) == "'up' is parallel to the view");
  CHECK(refused(look("[0,0,1]", "[0,5,0]", "[0,0,0]", "45")) == "'up' has no direction");
  CHECK(refused(look("[0,0,1]", "[0,5,0]", "[0,1,0]", "0")) == "'angle' is not a number from 0.1 to 170");
}

TEST_CASE("live commands: each of those for a film and pictures is read with its values") {
  const auto key = parsed<SetKey>(R"({"do":"key","frame":7})");
  CHECK((key.frame == 7 && !key.view));
  const auto copied = parsed<SetKey>(
      R"({"do":"key","frame":7,"view":{"from":[1,2,3],"at":[4,5,7],"up":[0,1,0],"angle":40}})");
  CHECK((copied.view && copied.view->at == Vec3d(4, 5, 7) && copied.view->angle_degrees == 40));
  CHECK(parsed<DropKey>(R"({"do":"drop","frame":8})").frame == 8);
  const auto moved = parsed<MoveKey>(R"({"do":"move","frame":8,"to":3})");
  CHECK((moved.frame == 8 && moved.to == 3));
  parsed<UndoKeys>(R"({"do":"undo"})"), parsed<RedoKeys>(R"({"do":"redo"})");
  CHECK(parsed<PlayFilm>(R"({"do":"film","on":true})").on);
  CHECK_FALSE(parsed<PlayFilm>(R"({"do":"film","on":false})").on);
  CHECK(parsed<TakePhoto>(R"({"do":"photo","format":"exr"})").format == PhotoFormat::kExr);
  CHECK(parsed<TakePhoto>(R"({"do":"photo","format":"png"})").format == PhotoFormat::kPng);
  const auto pivot = parsed<FindPivot>(R"({"do":"pivot","x":0.25,"y":1})");
  CHECK((pivot.x == 0.25 && pivot.y == 1));
  for (const Word<Overlay>& overlay : kWords<Overlay>) {
    const std::string text = R"({"do":"overlay","name":")" + std::string(overlay.word) + R"("})";
    CHECK(parsed<ShowOverlay>(text).overlay == overlay.value);
  }
}

TEST_CASE("live commands: numbers are allowed up to their limits, and no further") {
  const auto is_allowed = [](const std::string& members) {
    try {
      parse_command("{" + members + "}");
      return true;
    } catch (const CommandError&) {
      return false;
    }
  };
  const auto limits = [&](const std::string& begin, double least, double most, double step) {
    const auto at = [&](double v) { return is_allowed(begin + Json(v).dump()); };
    INFO(begin);
    CHECK((at(least) && at(most)));
    CHECK((!at(least - step) && !at(most + step)));
  };
  limits(R"("do":"rate","fps":)", 1, 120, 0.01);
  limits(R"("do":"size","height":9,"width":)", 1, 4096, 1);
  limits(R"("do":"size","width":9,"height":)", 1, 4096, 1);
  limits(R"("do":"pivot","y":0,"x":)", 0, 1, 0.01);
  limits(R"("do":"pivot","x":0,"y":)", 0, 1, 0.01);
  limits(R"("do":"key","frame":)", 1, kLastKeyFrame, 1);
  limits(R"("do":"drop","frame":)", 1, kLastKeyFrame, 1);
  limits(R"("do":"move","frame":1,"to":)", 1, kLastKeyFrame, 1);
  limits(R"("do":"pass","to":)", 1, 2147483647, 1);
  limits(R"("do":"seek","frame":)", 0, 2147483647, 1);
  limits(R"("do":"step","by":)", -2147483647, 2147483647, 1);
  limits(R"("do":"look","number":1,"from":[0,0,1],"at":[0,5,0],"up":[0,1,0],"angle":)", 0.1, 170, 0.01);
}

}  // namespace
}  // namespace pprt::command_test
