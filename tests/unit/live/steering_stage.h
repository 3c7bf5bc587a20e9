// A steering, and what it has told.
#pragma once

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "live/steering.h"

namespace pprt::test {

inline View view_from(double x) {
  View view;
  view.from = {x, 0, 0};
  view.at = {0, 0, 9};
  view.up = {0, 1, 0};
  view.width = 64, view.height = 48;
  return view;
}

class SteeringStage {
 public:
  explicit SteeringStage(int script_frames = 0, bool records = false, bool moves = false)
      : steering(
            show(script_frames, records, moves),
            {.tell = [this](int client,
                            std::string text) { told.emplace_back(client, nlohmann::json::parse(text)); },
             .tell_all =
                 [this](std::string text) {
                   const nlohmann::json message = nlohmann::json::parse(text);
                   (message.contains("film") ? film : state) = message.begin().value();
                 }}) {
    steering.next_run();
  }

  void say(int client, const std::string& text) { steering.said(client, text); }
  void look(int client, int number, double x) {
    say(client, R"({"do":"look","number":)" + std::to_string(number) + R"(,"from":[)" + std::to_string(x) +
                    R"(,0,0],"at":[0,0,9],"up":[0,1,0],"angle":40})");
  }
  LiveShot shot() {
    const std::optional<LiveShot> next = steering.next_shot();
    REQUIRE(next);
    return *next;
  }
  // The last error that a client was told, or "".
  std::string error() const {
    return told.empty() || !told.back().second.contains("error")
               ? ""
               : told.back().second["error"].get<std::string>();
  }

  std::vector<std::pair<int, nlohmann::json>> told;
  nlohmann::json state, film;
  Steering steering;

 private:
  static LiveShow show(int script_frames, bool records, bool moves) {
    LiveShow show{.title = "a scene", .scene_name = "spd:tree", .home = view_from(-1)};
    show.records = records, show.moves = moves;
    show.seen_at = [](const View& view, double x, double y, int moment) -> std::optional<Vec3d> {
      if (y > 24) return std::nullopt;
      return Vec3d(view.from.x, x, moment);
    };
    for (int n = 1; n <= script_frames; ++n)
      show.script.push_back({.number = 10 + n, .view = view_from(n), .cut = n == 3});
    show.require_size = [](int width, int) {
      if (width > 2000) throw std::runtime_error("too large");
    };
    show.require_camera = [](const View& view) {
      if (view.from.x > 1e6) throw std::runtime_error("too far away");
    };
    return show;
  }
};

}  // namespace pprt::test
