// What viewers are told, and which of them has the camera.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "unit/live/steering_stage.h"

namespace pprt::steering_clients_test {
namespace {

using Json = nlohmann::json;
using Stage = test::SteeringStage;
using test::view_from;

TEST_CASE("steering: a client is told who it is, and all who has the camera") {
  Stage stage(2);
  stage.steering.joined(4);
  REQUIRE(stage.told.size() == 2);
  CHECK(stage.told[1].second["film"]["keys"] == Json::array());
  const Json hello = stage.told[0].second["hello"];
  CHECK((hello["you"] == 4 && hello["title"] == "a scene"));
  CHECK(hello["home"]["from"] == Json({-1.0, 0.0, 0.0}));
  stage.steering.joined(5);
  stage.say(4, R"({"do":"take"})");
  CHECK((stage.state["pilot"] == 4 && stage.state["viewers"] == Json({4, 5})));
  stage.steering.left(4);
  CHECK((stage.state["pilot"] == 0 && stage.state["viewers"] == Json::array({5})));
}

TEST_CASE("steering: only the pilot steers, and there is one") {
  Stage stage(2);
  stage.steering.joined(1), stage.steering.joined(2);
  for (const char* text :
       {R"({"do":"give"})", R"({"do":"play"})", R"({"do":"rate","fps":2})", R"({"do":"key","frame":1})",
        R"({"do":"photo","format":"png"})", R"({"do":"pass","to":1})"}) {
    stage.say(1, text);
    CHECK(stage.error() == "take the camera first");
  }
  stage.look(1, 1, 7);
  CHECK(stage.shot().view.from.x == 1);
  stage.say(1, R"({"do":"take"})");
  stage.say(2, R"({"do":"take"})");
  CHECK(stage.error() == "viewer number 1 has the camera");
  stage.say(1, R"({"do":"pass","to":9})");
  CHECK(stage.error() == "there is no viewer number 9");
  stage.say(1, R"({"do":"pass","to":2})");
  CHECK(stage.state["pilot"] == 2);
  stage.look(2, 1, 8);
  CHECK(stage.shot().view.from.x == 8);
}

TEST_CASE("steering: a name that is no UTF-8 can be told") {
  std::string told;
  Steering steering({.title = "caf\xe9"}, {.tell = [&](int, std::string text) { told = std::move(text); },
                                           .tell_all = [](const std::string&) {}});
  CHECK_NOTHROW(steering.joined(1));
  CHECK(Json::accept(told));
}

TEST_CASE("steering: who joins is told all that there is, and all are told how it stands") {
  LiveShow show{.title = "a scene", .scene_name = "spd:tree", .home = view_from(-1)};
  show.frames_per_second = 30, show.moves = true, show.ranks = 3, show.records = true;
  show.bounds.emplace(Vec3d(-1, -2, -3), Vec3d(4, 5, 6));
  show.script = {{.number = 1, .view = view_from(0)}, {.number = 2, .view = view_from(1)}};
  std::vector<std::pair<int, Json>> told;
  const auto note = [&](int client, const std::string& text) {
    told.emplace_back(client, Json::parse(text));
  };
  Steering steering(show, {.tell = note, .tell_all = [&](const std::string& text) { note(0, text); }});
  CHECK_FALSE(steering.is_watched());
  steering.joined(2);
  CHECK(steering.is_watched());
  REQUIRE(told.size() == 3);
  CHECK((told[0].first == 2 && told[1].first == 2 && told[2].first == 0));
  const Json home = {
      {"from", {-1.0, 0.0, 0.0}}, {"at", {0.0, 0.0, 9.0}}, {"up", {0.0, 1.0, 0.0}}, {"angle", 45.0}};
  CHECK(told[0].second == Json{{"hello",
                                {{"you", 2},
                                 {"title", "a scene"},
                                 {"home", home},
                                 {"size", {64, 48}},
                                 {"rates", {1.0, 120.0}},
                                 {"longest_side", 4096},
                                 {"fixed_size", true},
                                 {"moves", true},
                                 {"ranks", 3},
                                 {"bounds", {{-1.0, -2.0, -3.0}, {4.0, 5.0, 6.0}}},
                                 {"overlays", {"none", "samples", "triangulation", "regions", "age"}}}}});
  CHECK(told[1].second["film"]["keys"] == Json::array());
  CHECK(told[2].second == Json{{"state",
                                {{"pilot", 0},
                                 {"viewers", {2}},
                                 {"plays", true},
                                 {"frames", 2},
                                 {"line", 2},
                                 {"film", false},
                                 {"rate", 30.0},
                                 {"size", {64, 48}},
                                 {"overlay", "none"},
                                 {"keys", Json::array()},
                                 {"undo", false},
                                 {"redo", false},
                                 {"photo", false}}}});
  steering.left(2);
  CHECK_FALSE(steering.is_watched());
  CHECK((told.back().first == 0 && told.back().second["state"]["viewers"] == Json::array()));
}

TEST_CASE("steering: all are told of each command that changes something, but for looks") {
  Stage stage(5);
  stage.steering.joined(1), stage.steering.joined(2);
  const auto told_by = [&](const std::string& text) {
    stage.state = nullptr;
    stage.say(1, text);
    return !stage.state.is_null();
  };
  CHECK(told_by(R"({"do":"take"})"));
  for (const char* text :
       {R"({"do":"pause"})", R"({"do":"step","by":1})", R"({"do":"seek","frame":3})",
        R"({"do":"rate","fps":9})", R"({"do":"size","width":32,"height":24})",
        R"({"do":"overlay","name":"age"})", R"({"do":"key","frame":2})", R"({"do":"move","frame":2,"to":4})",
        R"({"do":"drop","frame":4})", R"({"do":"undo"})", R"({"do":"redo"})",
        R"({"do":"photo","format":"png"})", R"({"do":"play"})"}) {
    INFO(text);
    CHECK(told_by(text));
    CHECK(stage.error().empty());
  }
  CHECK((stage.state["rate"] == 9.0 && stage.state["size"] == Json({32, 24})));
  CHECK((stage.state["overlay"] == "age" && stage.state["keys"] == Json::array()));
  CHECK((stage.state["undo"] == true && stage.state["redo"] == false && stage.state["photo"] == true));
  CHECK((stage.state["plays"] == true && stage.state["frames"] == 5));
  stage.state = nullptr;
  stage.look(1, 1, 7);
  CHECK(stage.state.is_null());
  CHECK(told_by(R"({"do":"give"})"));
}

TEST_CASE("steering: a viewer who leaves changes nothing, and a pilot who comes again is another") {
  Stage stage(4);
  stage.steering.joined(1), stage.steering.joined(2);
  stage.say(1, R"({"do":"take"})");
  stage.look(1, 3, 7);
  stage.steering.left(2);
  const LiveShot held = stage.shot();
  CHECK((held.pilot == 1 && held.look == 3 && held.by_hand && held.view.from.x == 7));
  stage.steering.left(1);
  CHECK(stage.state["viewers"] == Json::array());
  stage.steering.joined(3);
  const LiveShot left = stage.shot();  // the camera stands where it was left
  CHECK((left.pilot == 0 && left.by_hand && left.view.from.x == 7));
  stage.say(3, R"({"do":"give"})");
  CHECK(stage.error() == "take the camera first");
  stage.say(3, R"({"do":"take"})");
  const LiveShot taken = stage.shot();
  CHECK((taken.pilot == 3 && taken.look == 0 && taken.view.from.x == 7));
  stage.say(3, R"({"do":"give"})");
  const LiveShot played = stage.shot();
  CHECK((played.pilot == 0 && !played.by_hand && played.position == 1 && played.cut));
}

TEST_CASE("steering: with a new run a shot is a cut of the new size, and what it shows is counted on") {
  Stage stage;
  stage.steering.joined(1);
  stage.say(1, R"({"do":"take"})");
  const LiveShot first = stage.shot();
  CHECK((first.camera == 1 && first.cut));
  const LiveShot second = stage.shot();
  CHECK((second.camera == 1 && !second.cut && second.change == first.change));
  stage.say(1, R"({"do":"overlay","name":"regions"})");
  const LiveShot drawn = stage.shot();
  CHECK((drawn.overlay == Overlay::kRegions && drawn.change > second.change && drawn.camera == 1));
  stage.steering.next_run();
  const LiveShot next = stage.shot();
  CHECK((next.cut && next.camera == 1 && next.overlay == Overlay::kRegions));
  CHECK_FALSE(stage.shot().cut);
  stage.look(1, 1, 4);
  CHECK(stage.shot().camera == 2);
  // Of a camera that turns about itself, or widens.
  stage.say(1, R"({"do":"look","number":2,"from":[4,0,0],"at":[1,0,9],"up":[0,1,0],"angle":40})");
  CHECK(stage.shot().camera == 3);
  stage.say(1, R"({"do":"look","number":3,"from":[4,0,0],"at":[1,0,9],"up":[1,1,0],"angle":40})");
  CHECK(stage.shot().camera == 4);
  stage.say(1, R"({"do":"look","number":4,"from":[4,0,0],"at":[1,0,9],"up":[1,1,0],"angle":50})");
  const LiveShot wide = stage.shot();
  CHECK((wide.camera == 5 && wide.view.angle_degrees == 50 && wide.view.up == Vec3d(1, 1, 0)));
  CHECK((wide.view.at == Vec3d(1, 0, 9) && wide.look == 4));
}

}  // namespace
}  // namespace pprt::steering_clients_test
