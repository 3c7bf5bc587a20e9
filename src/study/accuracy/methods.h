// Ways of making one picture with the same tracer, each a curve: the more samples, the more time, the less
// error.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/camera.h"
#include "image/image.h"
#include "trace/compiled_scene.h"

namespace pprt {

// What is pictured; the scene must outlive it.
struct Subject {
  const CompiledScene& scene;
  Camera camera;
};

// Seconds since some moment.
using SecondsClock = std::function<double()>;

// CPU time of the calling thread.
double thread_cpu_seconds();

// The picture at one point of a method's curve.
struct Rendering {
  double samples = 0;  // a pixel
  double seconds = 0;  // all that this picture took, from the first ray to its last pixel
  Image image;
  bool exhausted = false;  // more time would not change it: nothing is left to refine
};
using RenderingSink = std::function<void(Rendering&&)>;

// How far a curve goes.
struct CurveRange {
  std::span<const double> densities;  // samples a pixel, increasing: a picture at each
  double limit_s = 0;                 // the first picture that took longer is the last
  std::uint64_t seed = 1;
};

struct Method {
  std::string name;
  std::string description;
  std::function<void(const Subject&, const CurveRange&, const SecondsClock&, const RenderingSink&)> run;
};

// Names in tables and legends.
inline constexpr const char* kProgressive = "progressive";
inline constexpr const char* kUniform = "uniform";
inline constexpr const char* kControl = "control";

// This renderer's: seeds, then the heaviest triangle again and again, then reconstruction (one rank).
Method progressive_method();

// A grid of m x n samples at its cells' centres. Fewer than pixels: bilinear between them. As many: they are
// the pixels. More: each pixel is the mean over its area, k x k supersampling where m and n are multiples.
Method uniform_method();

// The picture of a uniform grid whose tracing and picture take about so much of the clock's time.
Image uniform_picture_in(double seconds, const Subject& subject, const SecondsClock& clock);

// Both, the uniform one once more as a control under another name, and progressive with a part of it taken
// out.
std::vector<Method> accuracy_methods();

// Samples a pixel from 0.4 % to 11, a factor of 10^(1/5) apart or little more; 1 is among them, and so is one
// just beyond the tables' last budget.
std::vector<double> curve_densities();

}  // namespace pprt
