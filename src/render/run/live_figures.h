// What the live page tells of the last frames of a sequence.
#pragma once

#include <deque>
#include <optional>

#include "live/frame_header.h"
#include "parallel/master/master.h"
#include "parallel/settings/session_settings.h"
#include "render/records/advice.h"

namespace pprt {

class LiveFigures {
 public:
  // `cores`: of this host.
  LiveFigures(const SessionSettings& settings, int ranks, int cores, Remedies remedies);

  // Adds a frame, and returns its figures. The error is that of the last frames since a camera cut, and the
  // advice is about the last 120.
  FrameFigures add(const FinishedFrame& frame);

 private:
  struct Played {
    double late_ms = 0;
    double samples = 0;
  };

  std::string advice(double least_rmse) const;

  SessionSettings settings_;
  int ranks_, cores_;
  Remedies remedies_;
  std::deque<Played> played_;
  std::deque<ErrorEstimate> errors_;
};

}  // namespace pprt
