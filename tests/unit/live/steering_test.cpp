// Who has the camera, and what the next frame shows.
#include "live/steering.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "unit/live/steering_stage.h"

namespace pprt::steering_test {
namespace {

using Json = nlohmann::json;
using Stage = test::SteeringStage;

TEST_CASE("steering: a script plays to its end and stays there") {
  Stage stage(3, true);
  for (int n = 1; n <= 3; ++n) {
    CHECK_FALSE(stage.steering.is_played_out());
    const LiveShot shot = stage.shot();
    CHECK(shot.view.from.x == n);
    CHECK(shot.script_frame == 10 + n);
    CHECK(shot.position == n);
    CHECK(shot.cut == (n != 2));  // the first follows nothing, the third is a cut of the script
    CHECK(shot.camera == static_cast<std::uint32_t>(n));
  }
  CHECK(stage.steering.is_played_out());
  CHECK_FALSE(stage.state["plays"].get<bool>());
  const LiveShot rest = stage.shot();
  CHECK((rest.view.from.x == 3 && rest.script_frame == 13 && rest.camera == 3 && !rest.cut));
}

TEST_CASE("steering: the camera by hand, and back to the script where it was left") {
  Stage stage(3);
  stage.steering.joined(1);
  CHECK(stage.shot().position == 1);
  stage.say(1, R"({"do":"take"})");
  CHECK(stage.shot().view.from.x == 1);  // it stands where it was
  stage.look(1, 17, 5.5);
  const LiveShot by_hand = stage.shot();
  CHECK((by_hand.view.from.x == 5.5 && by_hand.view.angle_degrees == 40 && by_hand.view.width == 64));
  CHECK((by_hand.look == 17 && by_hand.pilot == 1 && by_hand.script_frame == 0));
  CHECK((by_hand.by_hand && by_hand.position == 1));  // where the script was left
  CHECK((by_hand.camera == 2 && !by_hand.cut));
  CHECK(stage.shot().camera == 2);
  stage.say(1, R"({"do":"give"})");
  const LiveShot back = stage.shot();
  CHECK((back.position == 2 && back.cut && back.pilot == 0));
}

TEST_CASE("steering: a shot names a look of the one who has the camera, not of the pilot before") {
  Stage stage;
  stage.steering.joined(1), stage.steering.joined(2);
  for (const bool is_passed : {true, false}) {
    stage.say(1, R"({"do":"take"})");
    stage.look(1, 17, 5.5);
    CHECK(stage.shot().look == 17);
    if (is_passed) {
      stage.say(1, R"({"do":"pass","to":2})");
    } else {
      stage.say(1, R"({"do":"give"})");
      stage.say(2, R"({"do":"take"})");
    }
    const LiveShot shot = stage.shot();
    CHECK((shot.pilot == 2 && shot.look == 0));
    stage.look(2, 3, 6.5);
    CHECK(stage.shot().look == 3);
    stage.say(2, R"({"do":"give"})");
  }
}

TEST_CASE("steering: given back at the end of the script, the picture rests") {
  Stage stage(1);
  stage.steering.joined(1);
  CHECK(stage.shot().position == 1);
  stage.say(1, R"({"do":"take"})");
  stage.look(1, 1, 5.5), stage.shot();
  stage.say(1, R"({"do":"give"})");
  CHECK(stage.shot().view.from.x == 5.5);
  CHECK(stage.steering.is_played_out());
}

TEST_CASE("steering: a film that becomes shorter while it plays ends") {
  Stage stage;
  stage.steering.joined(1);
  stage.say(1, R"({"do":"take"})");
  stage.shot();
  stage.say(1, R"({"do":"key","frame":1})");
  stage.say(1, R"({"do":"key","frame":9})");
  stage.say(1, R"({"do":"film","on":true})");
  stage.say(1, R"({"do":"play"})");
  for (int n = 1; n <= 5; ++n) CHECK(stage.shot().position == n);
  stage.say(1, R"({"do":"drop","frame":9})");
  CHECK(stage.state["frames"] == 1);
  CHECK(stage.shot().position == 1);
  CHECK_FALSE(stage.steering.is_played_out());  // there is a pilot
  CHECK(stage.state["plays"] == false);
  stage.say(1, R"({"do":"undo"})");
  stage.say(1, R"({"do":"play"})");
  CHECK(stage.shot().position == 2);
}

TEST_CASE("steering: a camera that cannot be rendered is refused") {
  Stage stage;
  stage.steering.joined(1);
  stage.say(1, R"({"do":"take"})");
  stage.look(1, 1, 1e7);
  CHECK(stage.error() == "too far away");
  CHECK(stage.shot().view.from.x == -1);
}

TEST_CASE("steering: play, pause, step and seek") {
  Stage stage(4);
  stage.steering.joined(1);
  stage.say(1, R"({"do":"take"})");
  stage.say(1, R"({"do":"seek","frame":3})");
  CHECK(stage.shot().position == 3);
  CHECK(stage.shot().position == 3);
  stage.say(1, R"({"do":"step","by":-1})");
  const LiveShot before = stage.shot();
  CHECK((before.position == 2 && before.cut));
  stage.say(1, R"({"do":"step","by":1})");
  CHECK_FALSE(stage.shot().cut);
  stage.say(1, R"({"do":"step","by":2147483647})");
  CHECK(stage.shot().position == 4);
  stage.say(1, R"({"do":"step","by":-2147483647})");
  CHECK(stage.shot().position == 1);
  for (const auto& [frame, position] :
       {std::pair(2, 2), std::pair(1, 1), std::pair(0, 1), std::pair(99, 4)}) {
    stage.say(1, R"({"do":"seek","frame":)" + std::to_string(frame) + "}");
    CHECK(stage.shot().position == position);
  }
  stage.say(1, R"({"do":"play"})");  // at the end it begins again
  CHECK(stage.shot().position == 1);
  stage.say(1, R"({"do":"pause"})");
  CHECK(stage.shot().position == 1);
  Stage still;
  still.steering.joined(1);
  still.say(1, R"({"do":"take"})");
  for (const char* text : {R"({"do":"play"})", R"({"do":"step","by":1})", R"({"do":"seek","frame":1})"}) {
    still.say(1, text);
    CHECK(still.error() == "there is no script to play");
  }
}

TEST_CASE("steering: another rate, size or a photo ends the run and begins another") {
  Stage stage;
  stage.steering.joined(1);
  stage.say(1, R"({"do":"take"})");
  stage.shot();
  stage.say(1, R"({"do":"rate","fps":50})");
  CHECK_FALSE(stage.steering.next_shot());
  CHECK(stage.steering.next_run().frames_per_second == 50);
  CHECK(stage.shot().cut);
  stage.say(1, R"({"do":"size","width":32,"height":24})");
  CHECK_FALSE(stage.steering.next_shot());
  CHECK(stage.steering.next_run().width == 32);
  CHECK(stage.shot().view.height == 24);

  stage.look(1, 1, 3);
  stage.shot();
  stage.say(1, R"({"do":"photo","format":"exr"})");
  CHECK_FALSE(stage.steering.next_shot());
  const LiveRun photo = stage.steering.next_run();
  CHECK((photo.photo == PhotoFormat::kExr && photo.photo_for == 1 && photo.view.from.x == 3));
  CHECK(stage.state["photo"] == true);
  CHECK_FALSE(stage.steering.next_run().photo);
  CHECK(stage.state["photo"] == false);
  CHECK(stage.shot().view.from.x == 3);
}

TEST_CASE("steering: a photo is over when the viewer who has asked for it leaves") {
  for (const bool begun : {false, true}) {
    Stage stage;
    stage.steering.joined(1), stage.steering.joined(2);
    stage.say(1, R"({"do":"take"})");
    stage.say(1, R"({"do":"photo","format":"png"})");
    if (begun) CHECK(stage.steering.next_run().photo);
    stage.steering.left(2);
    CHECK(stage.steering.awaits_photo());
    stage.steering.left(1);
    CHECK_FALSE(stage.steering.awaits_photo());
    CHECK(stage.state["photo"] == false);
    CHECK_FALSE(stage.steering.next_run().photo);
  }
}

TEST_CASE("steering: keys make a film, which plays and is saved") {
  Stage stage;
  stage.steering.joined(1);
  stage.say(1, R"({"do":"take"})");
  stage.say(1, R"({"do":"film","on":true})");
  CHECK(stage.error() == "the film has no key yet");
  stage.look(1, 1, 1), stage.shot();
  stage.say(1, R"({"do":"key","frame":1})");
  stage.look(1, 2, 3), stage.shot();
  stage.say(1, R"({"do":"key","frame":9})");
  stage.look(1, 3, 2), stage.shot();
  stage.say(1, R"({"do":"key","frame":5})");
  CHECK(stage.state["keys"] == Json({1, 5, 9}));
  const Json copy = {
      {"from", {2.0, 0.0, 0.0}}, {"at", {0.0, 0.0, 9.0}}, {"up", {0.0, 1.0, 0.0}}, {"angle", 40.0}};
  CHECK(stage.film["keys"][1] == Json({{"frame", 5}, {"view", copy}}));
  const auto script = stage.film["script"].get<std::string>();
  CHECK(script.find("scene \"spd:tree\"") != std::string::npos);
  CHECK(script.find("frames 9 fps 24 resolution <64, 48>") != std::string::npos);
  CHECK(script.find("key 5 { from <2, 0, 0> at <0, 0, 9> up <0, 1, 0> angle 40 }") != std::string::npos);

  stage.say(1, R"({"do":"film","on":true})");
  stage.say(1, R"({"do":"play"})");
  CHECK(stage.state["frames"] == 9);
  for (int n = 1; n <= 9; ++n) {
    const LiveShot shot = stage.shot();
    CHECK((shot.position == n && shot.script_frame == 0));
    if (n == 1 || n == 5 || n == 9) CHECK(shot.view.from.x == 1 + (n - 1) / 4);
    stage.say(1, R"({"do":"film","on":true})");  // it plays already
  }

  stage.say(1, R"({"do":"undo"})");
  CHECK(stage.state["keys"] == Json({1, 9}));
  stage.say(1, R"({"do":"drop","frame":5})");
  CHECK(stage.error() == "there is no key at frame 5");
  stage.say(1, R"({"do":"drop","frame":9})");
  CHECK(stage.state["keys"] == Json::array({1}));
  stage.say(1, R"({"do":"undo"})");
  stage.say(1, R"({"do":"undo"})");
  stage.say(1, R"({"do":"undo"})");
  CHECK(stage.state["keys"].empty());
  CHECK(stage.film["keys"].empty());
  CHECK(stage.state["film"] == false);
  stage.say(1, R"({"do":"undo"})");
  CHECK(stage.error() == "there is nothing to undo");
  CHECK(stage.shot().view.from.x == 3);  // what was seen stays
}

TEST_CASE("steering: a picture is finished until something changes it, but not while a script plays") {
  Stage stage(3);
  stage.steering.joined(1);
  const LiveShot first = stage.shot();
  stage.steering.rest(first.change);
  CHECK(stage.shot().position == 2);
  stage.say(1, R"({"do":"take"})");
  const LiveShot still = stage.shot();
  stage.steering.rest(still.change);
  CHECK_FALSE(stage.steering.next_shot());
  stage.say(1, R"({"do":"key","frame":1})");
  CHECK_FALSE(stage.steering.wait_for_change(0));
  stage.look(1, 1, 8);
  stage.steering.rest(still.change);  // of a frame ordered before
  CHECK(stage.steering.wait_for_change(0));
  CHECK(stage.shot().view.from.x == 8);
}

TEST_CASE("steering: where frames are recorded, each is shown, whatever a pilot did and left") {
  Stage stage(4, true);
  stage.steering.joined(1);
  CHECK(stage.shot().position == 1);
  stage.say(1, R"({"do":"take"})");
  stage.say(1, R"({"do":"seek","frame":4})");
  CHECK(stage.shot().position == 4);
  stage.look(1, 1, 9);
  stage.shot();
  stage.steering.left(1);
  const LiveShot next = stage.shot();
  CHECK((next.position == 2 && next.cut));
  CHECK(stage.shot().position == 3);
  CHECK(stage.shot().position == 4);
  CHECK(stage.steering.is_played_out());
}

TEST_CASE("steering: given back, the script plays on, not the film") {
  Stage stage(5);
  stage.steering.joined(1);
  stage.shot(), stage.shot();
  stage.say(1, R"({"do":"take"})");
  stage.look(1, 1, 9), stage.shot();
  stage.say(1, R"({"do":"key","frame":3})");
  stage.say(1, R"({"do":"film","on":true})");
  stage.say(1, R"({"do":"play"})");
  CHECK(stage.shot().position == 1);
  stage.say(1, R"({"do":"give"})");
  const LiveShot back = stage.shot();
  CHECK((back.position == 3 && back.script_frame == 13 && back.cut));
  CHECK(stage.state["film"] == false);
}

TEST_CASE("steering: what moves plays again and again, and goes on under a camera by hand") {
  Stage stage(3, false, true);
  stage.steering.joined(1);
  for (const int n : {1, 2, 3, 1}) {
    const LiveShot shot = stage.shot();
    CHECK((shot.moment == 10 + n && shot.script_frame == 10 + n && shot.view.from.x == n));
  }
  CHECK(stage.state["plays"] == true);
  stage.say(1, R"({"do":"take"})");
  const LiveShot taken = stage.shot();
  CHECK((taken.moment == 12 && taken.view.from.x == 1 && taken.script_frame == 0 && taken.by_hand));
  stage.look(1, 1, 7);
  const LiveShot steered = stage.shot();
  CHECK((steered.moment == 13 && steered.view.from.x == 7 && steered.position == 3 && !steered.cut));
  const LiveShot again = stage.shot();
  CHECK((again.moment == 11 && again.view.from.x == 7 && again.cut));

  // The camera stays the pilot's while time stands still or is chosen.
  stage.say(1, R"({"do":"pause"})");
  CHECK((stage.shot().moment == 11 && stage.shot().view.from.x == 7));
  stage.say(1, R"({"do":"seek","frame":3})");
  const LiveShot sought = stage.shot();
  CHECK((sought.moment == 13 && sought.view.from.x == 7));
  stage.say(1, R"({"do":"play"})");
  CHECK((stage.shot().moment == 11 && stage.shot().view.from.x == 7));
  stage.say(1, R"({"do":"give"})");
  const LiveShot back = stage.shot();
  CHECK((back.moment == 13 && back.view.from.x == 3 && back.cut));
}

TEST_CASE("steering: given back at its end, what moves begins again, and what does not rests") {
  for (const bool moves : {true, false}) {
    Stage stage(3, false, moves);
    stage.steering.joined(1);
    stage.say(1, R"({"do":"take"})");
    stage.say(1, R"({"do":"seek","frame":3})");
    CHECK(stage.shot().position == 3);
    stage.say(1, R"({"do":"give"})");
    CHECK(stage.state["plays"] == moves);
    CHECK(stage.steering.is_played_out() == !moves);
    const LiveShot next = stage.shot();
    CHECK((next.position == (moves ? 1 : 3) && next.cut == moves && next.pilot == 0));
  }
}

TEST_CASE("steering: a film of what moves lasts as long as it does") {
  Stage stage(5, false, true);
  stage.steering.joined(1);
  stage.say(1, R"({"do":"take"})");
  stage.look(1, 1, 2), stage.shot();
  stage.say(1, R"({"do":"key","frame":1})");
  stage.look(1, 2, 4), stage.shot();
  stage.say(1, R"({"do":"key","frame":3})");
  CHECK(stage.film["script"].get<std::string>().find("frames 5 ") != std::string::npos);
  stage.say(1, R"({"do":"film","on":true})");
  stage.say(1, R"({"do":"play"})");
  for (const int n : {1, 2, 3, 4, 5, 1}) {
    const LiveShot shot = stage.shot();
    CHECK((shot.moment == 10 + n && shot.position == n && shot.script_frame == 0));
  }
}

TEST_CASE("steering: where frames are recorded, what moves plays once") {
  Stage stage(2, true, true);
  stage.shot(), stage.shot();
  CHECK(stage.steering.is_played_out());
}

TEST_CASE("steering: keys move, are put back from a copy, and come again after an undo") {
  Stage stage;
  stage.steering.joined(1);
  stage.say(1, R"({"do":"take"})");
  stage.say(1, R"({"do":"key","frame":1})");
  stage.say(1, R"({"do":"key","frame":9,"view":{"from":[5,0,0],"at":[0,0,9],"up":[0,1,0],"angle":40}})");
  CHECK(stage.film["keys"][1]["view"]["from"] == Json({5.0, 0.0, 0.0}));
  stage.say(1, R"({"do":"move","frame":9,"to":4})");
  CHECK(stage.state["keys"] == Json({1, 4}));
  CHECK(stage.film["keys"][1]["view"]["from"] == Json({5.0, 0.0, 0.0}));
  CHECK(stage.state["line"] == 4 + 2 * 24);  // room for the next key
  stage.say(1, R"({"do":"undo"})");
  CHECK((stage.state["keys"] == Json({1, 9}) && stage.state["redo"] == true));
  stage.say(1, R"({"do":"redo"})");
  CHECK((stage.state["keys"] == Json({1, 4}) && stage.state["redo"] == false));
  stage.say(1, R"({"do":"move","frame":8,"to":4})");
  CHECK(stage.error() == "there is no key at frame 8");
  stage.say(1, R"({"do":"redo"})");
  CHECK(stage.error() == "there is nothing to do again");
  stage.say(1, R"({"do":"key","frame":9,"view":{"from":[1e7,0,0],"at":[0,0,9],"up":[0,1,0],"angle":40}})");
  CHECK(stage.error() == "too far away");
}

TEST_CASE("steering: the pilot is told what is seen at a point") {
  Stage stage(3, false, true);
  stage.steering.joined(1);
  stage.shot(), stage.shot();
  stage.say(1, R"({"do":"take"})");
  stage.say(1, R"({"do":"pivot","x":0.25,"y":0.5})");
  CHECK(stage.told.back().second["pivot"] == Json({2.0, 16.0, 12.0}));
  stage.say(1, R"({"do":"pivot","x":0.25,"y":0.75})");
  CHECK(stage.error() == "there is nothing to turn round");
}

TEST_CASE("steering: a size that memory cannot hold is refused") {
  Stage stage;
  stage.steering.joined(1);
  stage.say(1, R"({"do":"take"})");
  stage.say(1, R"({"do":"size","width":4000,"height":4000})");
  CHECK(stage.error() == "too large");
  CHECK(stage.steering.next_shot());
}

TEST_CASE("steering: frames are wanted while somebody watches and the picture is not finished") {
  Stage stage;
  CHECK_FALSE(stage.steering.wait_for_change(0));
  CHECK_FALSE(stage.steering.next_shot());
  stage.steering.joined(1);
  CHECK(stage.steering.wait_for_change(0));
  stage.shot();
  stage.steering.left(1);
  CHECK_FALSE(stage.steering.wait_for_change(0));
}

}  // namespace
}  // namespace pprt::steering_test
