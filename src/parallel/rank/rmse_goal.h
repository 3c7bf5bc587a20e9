// When a picture without a rate has the RMSE that is asked for: by measurement
// (docs/decisions/0035-quality.md).
//
// The picture is looked at when its samples have doubled, and when it is expected to be good enough. A look
// measures the rank's region by probes (error_probes.h). They are kept: each measures the later pictures,
// too.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "parallel/clock/frame_clock.h"
#include "parallel/rank/error_probes.h"
#include "parallel/rank/picture_refresh.h"
#include "parallel/rank/rank_sampling.h"
#include "parallel/rank/sample_tracer.h"
#include "parallel/settings/session_settings.h"

namespace pprt {

// The RMSE asked for is that of the whole picture. So each rank tells the others what its last look has
// found, and adds up what they have told.
class RmseGoal {
 public:
  // `tracer` must outlive it.
  RmseGoal(const SessionSettings& settings, int rank, int ranks, SampleTracer& tracer);

  // A picture begins: nothing that was found of others holds for it.
  void begin_picture(int frame_number);

  // Whether the whole picture was measured to be as exact as asked for. A look reconstructs `picture`.
  bool is_reached(RankSampling& sampler, PictureRefresh& picture, FrameClock& clock);

  // What another rank has found: the sum of squared errors in its region.
  void receive(int from, double squared);

  // Returns the same of this rank, by its last look; empty before the first.
  std::optional<double> found() const { return found_[rank_]; }

  // Whether found() has changed since the last call.
  bool take_news();

  // Returns the number of samples in the region that is expected to be enough; empty before that is known.
  std::optional<double> foretold_samples() const {
    return enough_ < kNever ? std::optional(enough_) : std::nullopt;
  }

  // Returns what the kept probes tell of a picture of the region; empty where there are none of it.
  std::optional<ErrorSums> measure(const Region& region, const PixelBlock& shown) const;

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  void look(const Region& region, const PixelBlock& shown, std::uint64_t samples);
  ErrorSums measured(const Region& region, const PixelBlock& shown, std::uint64_t samples);
  void add_probes(const Region& region, const PixelBlock& shown, std::uint64_t count);
  int better_side(const ErrorSums& error) const;
  std::uint64_t probes_lacking(const ErrorSums& error) const;
  void foretell();
  bool knows_all() const;
  double mean_squared(double own) const;

  const double squared_;  // mean squared error asked for
  const double pixels_;   // of the image
  const std::uint64_t seed_;
  const std::size_t rank_;
  SampleTracer& tracer_;
  std::uint64_t frame_ = 0;
  std::vector<std::optional<double>> found_;  // per rank

  std::vector<PixelProbe> probes_;
  int side_ = 2;  // of their grids of eye rays
  std::uint64_t probe_samples_ = 0, probe_rays_ = 0, batches_ = 0;
  std::vector<int> tiles_;     // of the region that the probes are for
  PixelBlock before_;          // as shown at the last look
  std::uint64_t samples_ = 0;  // at the last look
  double slope_ = 0;           // of the squared error over the samples, both as logarithms
  double next_look_ = 0;       // at so many samples
  double enough_ = kNever;     // samples
  bool has_news_ = false;
};

}  // namespace pprt
