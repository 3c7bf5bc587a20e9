#include "live/frame_header.h"

#include <nlohmann/json.hpp>

namespace pprt {
namespace {

using Json = nlohmann::json;

Json json_of(const Vec3d& v) {
  return {v.x, v.y, v.z};
}

}  // namespace

nlohmann::json json_of(const View& view) {
  return {{"from", json_of(view.from)},
          {"at", json_of(view.at)},
          {"up", json_of(view.up)},
          {"angle", view.angle_degrees}};
}

std::string to_text(const FrameHeader& header) {
  const LiveShot& shot = header.shot;
  Json json = {{"camera", shot.camera},
               {"look", shot.look},
               {"pilot", shot.pilot},
               {"view", json_of(shot.view)},
               {"size", {shot.view.width, shot.view.height}},
               {"script_frame", shot.script_frame},
               {"position", shot.position},
               {"by_hand", shot.by_hand},
               {"at_rest", header.is_at_rest},
               {"flip", header.flip ? Json(*header.flip) : Json()},
               {"type", header.type}};
  for (const FrameFigures& f : header.frames)
    json["frames"].push_back({{"number", f.number},
                              {"slack_ms", f.slack_ms},
                              {"samples", f.samples},
                              {"late", f.late_ranks},
                              {"rmse", f.rmse ? Json(*f.rmse) : Json()},
                              {"advice", f.advice}});
  return json.dump();
}

}  // namespace pprt
