// Whole sessions in one process: a thread per rank, a scene given by a formula.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "parallel/session.h"

namespace pprt {

// A camera before the plane z = 10 that holds a disc; `shift` moves it to the right, in pixels.
Camera camera_before_disc(int width, int height, double shift = 0);

// So many frames, numbered from 1, whose cameras are `shift` pixels apart.
CameraSource still_or_pan(const SessionSettings& settings, int frames, double shift = 0);

// The scene, and what is done to a run that it must bear or that it must show.
struct Conditions {
  double period = 0;              // of a pattern of discs all over the plane, scene units; 0: one disc
  bool tells_shapes = false;      // the disc and the plane are primitives whose shapes are known
  bool slow_at_random = false;    // the probe sleeps now and then: threads run in another order
  int more_rays = 0;              // of every eye ray, beside those of the picture
  int no_number_every = 0;        // every so many eye rays of a rank give no number; 0: none
  bool drop_samples = false;      // bundles arrive empty
  bool arrive_at_random = false;  // what has arrived is not seen at every look
  double bundle_delay_s = 0;      // bundles are seen so long after they have been sent
  int sleeper = -1;               // a rank that stands still before the first ray of its third frame
  double sleeps_s = 0;            // so long
  bool clocks_differ = false;     // rank k's is 100,000 k seconds ahead, and faster by 200 k millionths
  std::set<int> unplugged = {};   // ranks that are cut off from the others
  double unplugged_at_s = 0;      // after the run began
  LossRule loss = {};
  std::function<bool()> is_enough = [] { return false; };  // see SessionEvents
  double patience_s = 120;  // after so long a rank that still waits for a message gives up: an error
};

// A bundle on its way, as the network saw it.
struct SentBundle {
  int from = 0;
  int to = 0;
  Bundle bundle;
};

// Pixels on their way to rank 0: whose tiles they are.
struct SentPixels {
  int from = 0;
  int frame_index = 0;
  std::vector<int> tiles;           // those that the sender owns
  std::vector<std::int32_t> given;  // and those that it has given away in this frame
};

struct Traced {
  int frame = 0;  // the how many-th camera, rehearsals not counted: theirs are 0 and less
  double x = 0;
  double y = 0;
  double footprint = 1;
};

// How often each rank rehearses the first frame of a sequence in real time.
inline constexpr int kRehearsals = 2;

struct VirtualRun {
  std::vector<FinishedFrame> frames;
  std::vector<std::vector<Traced>> traced;  // per rank: the eye rays asked for
  std::vector<SentBundle> bundles;
  std::vector<SentPixels> pixels;
  std::string error;  // of the ranks that failed; empty: none
};

VirtualRun run_session(int ranks, const SessionSettings& settings, const CameraSource& source,
                       const Conditions& conditions = {});

// Standard deviation of the ranks' refinement by its mean.
double unevenness(const FinishedFrame& frame);

// Whether two sequences hold the same pictures, bit by bit.
bool same_pictures(const VirtualRun& a, const VirtualRun& b);

}  // namespace pprt
