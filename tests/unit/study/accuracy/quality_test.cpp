// How near stills come to the RMSE that is asked for, and what dividing a film's time is worth. Takes
// minutes, so both are run by hand (docs/accuracy.md):
//
//   PPRT_QUALITY="spd:tree spd:balls" test_study "[quality]"
//   test_study "[film]"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "cli/scenes/scene_source.h"
#include "parallel/session.h"
#include "render/plan/film_time.h"
#include "study/frame_series.h"
#include "study/rate/moving_scene.h"
#include "study/reference.h"

namespace pprt::quality_test {
namespace {

constexpr int kSize = 256;

// Without the reference's own error.
double true_rmse(const Image& image, const Reference& reference) {
  const double rmse = rmse_of(image, reference.image);
  return std::sqrt(std::max(0.0, rmse * rmse - reference.own_rmse * reference.own_rmse));
}

struct Still {
  double rmse = 0;  // true
  RmseInterval told;
  double samples = 0;        // per pixel
  double probe_samples = 0;  // by the picture's
};

Still still_of(const CompiledScene& scene, const Camera& camera, const Reference& reference, int ranks,
               double target) {
  SessionSettings settings{.sampler = SamplerChoice::kAuto};
  settings.width = settings.height = kSize;
  settings.clock = ClockKind::kWork;
  settings.is_still = true;
  settings.measures_error = true;
  settings.stop.rmse = target;
  Still still;
  render_series(scene, {{.number = 1, .camera = camera}}, ranks, settings, [&](FinishedFrame&& frame) {
    still.rmse = true_rmse(frame.image, reference);
    still.told = frame.error.value().own.interval();
    double samples = 0;
    for (const RankReport& rank : frame.ranks) samples += static_cast<double>(rank.samples_in_region);
    still.samples = samples / (kSize * kSize);
    still.probe_samples = static_cast<double>(frame.error->samples) / samples;
  });
  return still;
}

}  // namespace

TEST_CASE("measured RMSE: how near stills come to it", "[.quality]") {
  const char* given = std::getenv("PPRT_QUALITY");
  std::istringstream names(given != nullptr ? given
                                            : "spd:tree spd:balls spd:gears spd:mount spd:rings spd:tetra "
                                              "spd:teapot spd:jacks spd:lattice");
  for (std::string name; names >> name;) {
    const SceneDescription description = load_scene(name).scene;
    const CompiledScene scene = compile(description);
    const Camera camera = square_camera(scene, *description.view, kSize);
    const Reference reference = converged_reference({scene, camera}, 8);
    for (const double target : {0.02, 0.01, 0.005}) {
      for (const int ranks : {1, 2}) {
        const Still still = still_of(scene, camera, reference, ranks, target);
        std::cout << name << " asked " << target << ", " << ranks << " ranks: true " << still.rmse
                  << ", told " << still.told.rmse << " (" << still.told.low << " to " << still.told.high
                  << "), samples a pixel " << still.samples << ", of probes " << still.probe_samples
                  << std::endl;
        CHECK(still.rmse < 1.1 * target);
        const bool is_first_picture = still.samples < 0.065;
        if (!is_first_picture) CHECK(still.rmse > 0.9 * target);
      }
    }
  }
}

namespace {

// A film of 48 frames, however many it has.
struct Film {
  static constexpr int kFrames = 48, kSize = 128, kRanks = 2;

  MovingScene moving;
  std::vector<FrameRequest> frames;
  SessionSettings settings{.sampler = SamplerChoice::kAuto};
};

Film film_of(const std::string& name) {
  Film film{.moving = read_moving_scene({name}), .frames = {}};
  film.frames = frames_at(film.moving, Film::kFrames / film.moving.length_s, Film::kFrames, Film::kSize);
  film.settings.width = film.settings.height = Film::kSize;
  film.settings.clock = ClockKind::kWork;
  film.settings.awaits_all = film.settings.measures_error = true;
  return film;
}

// Plays the film, and gives each frame to the sink. Returns the latest lateness in milliseconds.
double played(const Film& film, const std::vector<FrameRequest>& frames, const SessionSettings& settings,
              const FrameSink& sink) {
  double latest = -1e9;
  render_series(film.moving.scene, frames, Film::kRanks, settings, [&](FinishedFrame&& frame) {
    latest = std::max(latest, frame.late_ms);
    sink(std::move(frame));
  });
  return latest;
}

std::vector<FrameRequest> with_divided_time(const Film& film, double film_time) {
  const std::vector<FrameRequest> quick = pricing_requests(film.frames);
  std::vector<ErrorEstimate> prices;
  played(film, quick, pricing_settings(film.settings, quick.size(), film_time),
         [&](FinishedFrame&& frame) { prices.push_back(frame.error.value().own); });
  const std::vector<double> times = divided_time(film.frames, prices);
  std::vector<FrameRequest> frames = film.frames;
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i].periods = times[i];
  return frames;
}

struct Errors {
  double worst = 0, mean_square = 0;
};

Errors errors_of(const std::vector<Image>& pictures, const std::vector<Reference>& references) {
  Errors errors;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const double rmse = true_rmse(pictures[i], references[i]);
    errors.worst = std::max(errors.worst, rmse);
    errors.mean_square += rmse * rmse / static_cast<double>(pictures.size());
  }
  return errors;
}

}  // namespace

TEST_CASE("film time: what dividing it is worth", "[.film]") {
  const char* given = std::getenv("PPRT_FILMS");
  const std::string folder = PPRT_SOURCE_DIR;
  const std::string usual = folder + "/tests/unit/study/accuracy/films/tree-cut.anim " + folder +
                            "/tests/unit/study/accuracy/films/balls-cut.anim " + folder +
                            "/scenes/tree-casting.anim " + folder + "/scenes/demo.anim";
  std::istringstream names(given != nullptr ? given : usual);
  for (std::string name; names >> name;) {
    const Film film = film_of(name);
    std::vector<Reference> references;
    for (const FrameRequest& frame : film.frames)
      references.push_back(converged_reference({film.moving.scene, frame.camera, frame.time}, 4));
    for (const double film_time : {4.0, 16.0}) {
      std::vector<Image> equal, divided;
      played(film, film.frames, pass_settings(film.settings, Film::kFrames, film_time),
             [&](FinishedFrame&& frame) { equal.push_back(std::move(frame.image)); });
      const double latest =
          played(film, with_divided_time(film, film_time),
                 pass_settings(film.settings, Film::kFrames, (1 - kPricingShare) * film_time),
                 [&](FinishedFrame&& frame) { divided.push_back(std::move(frame.image)); });
      const Errors a = errors_of(equal, references), b = errors_of(divided, references);
      std::cout << name << " in " << film_time << " s of work: worst RMSE " << a.worst
                << " with equal times, " << b.worst << " with divided ones, ratio " << b.worst / a.worst
                << "; of all frames " << std::sqrt(a.mean_square) << " and " << std::sqrt(b.mean_square)
                << "; the latest " << latest << " ms" << std::endl;
      CHECK(latest <= 0);
    }
  }
}

}  // namespace pprt::quality_test
