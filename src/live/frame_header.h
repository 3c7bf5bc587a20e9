// The text before each picture, which says what it shows and how it came about.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "live/steering.h"

namespace pprt {

// How a frame came about, whether or not its picture was sent.
struct FrameFigures {
  int number = 0;                    // of the frame, from 1
  double slack_ms = 0;               // before its deadline; negative: after it
  std::uint64_t samples = 0;         // in the image
  std::vector<int> late_ranks = {};  // whose pixels had not come
  // Measured in the last frames: RMSE, and both ends of its 95 % interval.
  std::optional<std::array<double, 3>> rmse = {};
  std::string advice = {};  // what would help against late or coarse frames; empty: nothing needs help
};

struct FrameHeader {
  LiveShot shot = {};
  bool is_at_rest = false;           // by RestWatch
  std::optional<double> flip;        // estimated mean FLIP to the finished picture
  std::string_view type;             // of the picture, as MIME names it; empty: there is none
  std::vector<FrameFigures> frames;  // since the header before; the last one is the picture's
};

// {"from":[x,y,z],"at":...,"up":...,"angle":45}
nlohmann::json json_of(const View& view);

// On one line.
std::string to_text(const FrameHeader& header);

}  // namespace pprt
