// A live view over loopback, from the picture to the viewer and from the viewer to the camera.
#include "live/live_view.h"

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <catch2/catch.hpp>
#include <chrono>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

namespace pprt::live_view_test {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using Json = nlohmann::json;
using asio::ip::tcp;

class Viewer {
 public:
  explicit Viewer(const LiveView& view) {
    socket_.next_layer().connect({asio::ip::make_address("127.0.0.1"), view.port()});
    const std::string url = view.url(), host = "127.0.0.1:" + std::to_string(view.port());
    socket_.handshake(host, url.substr(url.find(host) + host.size()) + "socket");
  }

  void say(const std::string& text) {
    socket_.text(true);
    socket_.write(asio::buffer(text));
  }

  // Texts as they are, of anything else the header; `picture` keeps the bytes behind that. Null: the end.
  Json hear() {
    beast::flat_buffer buffer;
    beast::error_code error;
    socket_.read(buffer, error);
    if (error) return nullptr;
    const std::string all = beast::buffers_to_string(buffer.data());
    const std::size_t end = socket_.got_text() ? all.size() : all.find('\n');
    picture = socket_.got_text() ? "" : all.substr(end + 1);
    return Json::parse(all.substr(0, end));
  }

  // The next message that has this member.
  Json hear_of(const char* member) {
    Json message = hear();
    while (!message.is_null() && !message.contains(member)) message = hear();
    return message;
  }

  std::string picture;

 private:
  asio::io_context context_;
  beast::websocket::stream<tcp::socket> socket_{context_};
};

LiveShow show() {
  LiveShow show{.title = "a scene"};
  show.home.width = 16, show.home.height = 8;
  return show;
}

LivePicture picture_of(const LiveShot& shot, int number) {
  return {.image = Image(16, 8), .shot = shot, .figures = {.number = number, .slack_ms = 1.5, .samples = 99}};
}

TEST_CASE("live view: a frame comes with what it shows, and a camera leads to the next") {
  LiveView view({}, show());
  Viewer viewer(view);
  CHECK(viewer.hear_of("hello")["hello"]["title"] == "a scene");
  CHECK(viewer.hear_of("state")["state"]["pilot"] == 0);
  viewer.say(R"({"do":"take"})");
  while (viewer.hear_of("state")["state"]["pilot"] == 0) {
  }
  viewer.say(R"({"do":"look","number":5,"from":[1,2,3],"at":[0,0,9],"up":[0,1,0],"angle":30})");
  viewer.say(R"({"do":"key","frame":1})");
  while (viewer.hear_of("state")["state"]["keys"].empty()) {
  }
  view.steering().next_run();
  const std::optional<LiveShot> shot = view.steering().next_shot();
  REQUIRE(shot);
  CHECK(shot->view.from == Vec3d(1, 2, 3));
  view.show(picture_of(*shot, 7));
  const Json header = viewer.hear_of("camera");
  CHECK((header["look"] == 5 && header["type"] == "image/jpeg" && header["view"]["angle"] == 30));
  REQUIRE(header["frames"].size() == 1);
  CHECK((header["frames"][0]["number"] == 7 && header["frames"][0]["slack_ms"] == 1.5));
  CHECK(viewer.picture.starts_with("\xff\xd8"));
}

TEST_CASE("live view: with another rate or size the film's script is told anew") {
  LiveView view({}, show());
  Viewer viewer(view);
  const auto script = [&] { return viewer.hear_of("film")["film"]["script"].get<std::string>(); };
  script();  // the first
  viewer.say(R"({"do":"take"})");
  viewer.say(R"({"do":"rate","fps":37})");
  CHECK(script().find("fps 37 resolution <16, 8>") != std::string::npos);
  viewer.say(R"({"do":"size","width":40,"height":30})");
  CHECK(script().find("fps 37 resolution <40, 30>") != std::string::npos);
}

TEST_CASE("live view: a photo goes to who asked for it, and the end is told") {
  auto view = std::make_unique<LiveView>(LiveAddress(), show());
  Viewer viewer(*view);
  const int number = viewer.hear_of("hello")["hello"]["you"].get<int>();
  view->show_photo({.width = 16, .height = 8, .photo = PhotoFormat::kPng, .photo_for = number}, Image(16, 8));
  CHECK(viewer.hear_of("photo")["photo"] == "png");
  CHECK(viewer.picture.substr(1, 3) == "PNG");
  view->end("It is over.");
  view.reset();
  CHECK(viewer.hear_of("end")["end"] == "It is over.");
  CHECK(viewer.hear().is_null());
}

TEST_CASE("live view: what cannot be encoded is told, and the next picture comes") {
  LiveView view({}, show());
  Viewer viewer(view);
  viewer.hear_of("state");
  view.show({.image = Image(), .shot = {}, .figures = {.number = 1}});
  CHECK(viewer.hear_of("error")["error"] != "");
  view.show(picture_of({}, 2));
  CHECK(viewer.hear_of("camera")["type"] == "image/jpeg");
}

TEST_CASE("live view: an overlay is drawn before the picture is sent") {
  LiveView view({}, show());
  Viewer viewer(view);
  viewer.hear_of("state");
  LivePicture picture = picture_of({}, 1);
  picture.overlaid = [](const Image& image) { return Image(image.width * 4, image.height * 4); };
  view.show(std::move(picture));
  viewer.hear_of("camera");
  const std::string overlaid = viewer.picture;
  view.show(picture_of({}, 2));
  viewer.say("ack");
  viewer.hear_of("camera");
  CHECK(overlaid.size() > 2);
  CHECK(overlaid != viewer.picture);
}

// A picture that moved and was dropped for a later one has ended the rest all the same.
TEST_CASE("live view: the camera rests only if it stood still in each frame since the last picture") {
  LiveView view({}, show());
  Viewer viewer(view);
  viewer.hear_of("state");
  std::promise<void> drawing, go_on;
  LivePicture first = picture_of({}, 1);
  first.rests = true;
  first.overlaid = [&](const Image& image) {
    drawing.set_value();
    go_on.get_future().wait();
    return image;
  };
  view.show(std::move(first));
  drawing.get_future().wait();
  std::this_thread::sleep_for(std::chrono::milliseconds(600));  // longer than it takes to be at rest
  for (const bool rests : {false, true}) {
    LivePicture next = picture_of({}, rests ? 3 : 2);
    next.rests = rests;
    view.show(std::move(next));
  }
  go_on.set_value();
  viewer.hear_of("camera");
  viewer.say("ack");
  const Json header = viewer.hear_of("camera");
  CHECK(header["frames"].size() == 2);
  CHECK(header["type"] == "image/jpeg");
}

TEST_CASE("live view: a picture in parts is not sent, but its figures are, with those of the next") {
  LiveView view({}, show());
  Viewer viewer(view);
  viewer.hear_of("state");
  LivePicture part = picture_of({}, 1);
  part.is_partial = true;
  view.show(std::move(part));
  const Json header = viewer.hear_of("camera");
  CHECK((header["type"] == "" && viewer.picture.empty()));
  CHECK((header["frames"].size() == 1 && header["frames"][0]["samples"] == 99));
  view.show(picture_of({}, 2));
  const Json next = viewer.hear_of("camera");
  CHECK((next["type"] == "image/jpeg" && !viewer.picture.empty()));
  CHECK((next["frames"].size() == 1 && next["frames"][0]["number"] == 2));
}

TEST_CASE("live view: what nobody has seen is not told to who comes later") {
  LiveView view({}, show());
  for (const int number : {1, 2, 3}) view.show(picture_of({}, number));
  Viewer viewer(view);
  viewer.hear_of("state");
  view.show(picture_of({}, 4));
  const Json header = viewer.hear_of("camera");
  REQUIRE_FALSE(header["frames"].empty());
  CHECK(header["frames"].back()["number"] == 4);
  CHECK(header["frames"].size() <= 2);  // the one before nobody came to take
}

TEST_CASE("live view: a photo has the format that was asked for, and the camera that it was taken from") {
  LiveView view({}, show());
  Viewer viewer(view), other(view);
  const int number = viewer.hear_of("hello")["hello"]["you"].get<int>();
  other.hear_of("hello");
  LiveRun run{.width = 16, .height = 8, .photo = PhotoFormat::kExr, .photo_for = number};
  run.view.from = {1, 2, 3}, run.view.angle_degrees = 33;
  view.show_photo(run, Image(16, 8));
  const Json header = viewer.hear_of("photo");
  CHECK((header["photo"] == "exr" && header["view"]["from"] == Json({1.0, 2.0, 3.0})));
  CHECK(header["view"]["angle"] == 33);
  CHECK(viewer.picture.starts_with("\x76\x2f\x31\x01"));
  view.end("over");
  view.end("over again");
  Json message = other.hear();
  while (!message.contains("end")) {
    CHECK_FALSE(message.contains("photo"));  // it is the other's
    message = other.hear();
  }
  CHECK(message["end"] == "over");
}

TEST_CASE("live view: the page is found under its token, at whatever address of this host") {
  const LiveView view({}, show());
  const std::string host = "http://127.0.0.1:" + std::to_string(view.port()) + "/", url = view.url();
  REQUIRE(url.starts_with(host));
  CHECK(url.size() == host.size() + 32 + 1);
  CHECK(view.url_at("10.0.0.7") ==
        "http://10.0.0.7:" + std::to_string(view.port()) + "/" + url.substr(host.size()));
}

}  // namespace
}  // namespace pprt::live_view_test
