// The distance of a frame's samples to the serial ones is that at the frame's time.
#include "render/output/serial_comparison.h"

#include <catch2/catch.hpp>

#include "parallel/serial_pattern.h"
#include "parser/aff_parser.h"
#include "scene/animation/resting_nodes.h"
#include "trace/tracer_probe.h"

namespace pprt::serial_comparison_test {

TEST_CASE("samples are compared with the serial ones of what moves as it stands at the frame's time") {
  const SceneDescription scene = without_resting_nodes(
      parse_aff("v from 0 0 9 at 0 0 0 up 0 1 0 angle 40 hither 1 resolution 64 64\n"
                "am 1 1 1 b 0 0 0 l 0 5 9 1 1 1\n"
                "fm .1 0 0 .8 .2 .1 0 0 0 0 0 1 p 4 -9 -9 -9 9 -9 -9 9 9 -9 -9 9 -9\n"
                "fm .1 .1 .1 .8 .9 .9 0 0 0 0 0 1 a 1 3 9 x ball { s 0 0 0 .6 }\n"
                "k ball { transl 4 0 -1 0 0 0 0 0 1 0 0 0 0 0 0 2 1 0 0 0 0 0 3 2 0 0 0 0 0 }\n",
                "t.aff")
          .scene);
  const CompiledScene compiled = compile(scene);
  SessionSettings settings{.sampler = SamplerChoice::kDelaunay};
  settings.width = settings.height = 64;
  settings.clock = ClockKind::kWork;
  const Camera camera = compiled.camera(*scene.view);
  Tracer tracer(compiled, camera);
  const std::vector<Sample> samples = serial_samples(settings, camera, 2, 1500, probe_of(tracer));
  REQUIRE(samples.size() > 1000);
  SerialComparison comparison(compiled, settings);
  CHECK(comparison.distance(1, camera, 2, samples).get() == 0);
  CHECK(comparison.distance(2, camera, 1, samples).get() > 0.1);
  CHECK(comparison.distance(3, camera, 2, samples).get() == 0);
  // Where there is room for one frame only, each waits for the one before.
  SerialComparison narrow(compiled, settings, 1);
  std::vector<std::future<double>> distances;
  for (const double time : {2.0, 1.0, 2.0}) distances.push_back(narrow.distance(1, camera, time, samples));
  CHECK((distances[0].get() == 0 && distances[1].get() > 0.1 && distances[2].get() == 0));
}

}  // namespace pprt::serial_comparison_test
