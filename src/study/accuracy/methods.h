// Methods of making one picture with the same tracer. Each is a curve: more samples, more time, less error.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "image/image.h"
#include "parallel/clock/host_time.h"
#include "study/reference.h"

namespace pprt {

// CPU time of the calling thread.
inline double thread_cpu_seconds() {
  return 1e-9 * static_cast<double>(thread_cpu_ns());
}

// The picture at one point of a method's curve.
struct Rendering {
  double samples = 0;  // per pixel
  double seconds = 0;  // CPU time of this picture, from the first ray to the last pixel
  Image image;
  bool exhausted = false;  // nothing is left to refine: more time would not change it
};

// How far a curve goes, and where its pictures go.
struct CurveTask {
  const Subject& subject;
  std::span<const double> densities;  // samples per pixel, increasing: a picture at each
  double limit_s = 0;                 // the first picture that took longer is the last
  std::uint64_t seed = 1;
  std::function<void(Rendering&&)> sink = {};
  bool takes_coarsest = false;  // the coarsest possible picture in place of all densities below its own
};

struct Method {
  std::string name;
  std::string description;
  std::function<void(const CurveTask&)> run;
};

// Names in tables and legends. Samplers of pprt-render have the words of --sampler.
inline constexpr const char* kDefaultMethod = "auto";
inline constexpr const char* kDelaunayMethod = "delaunay";
inline constexpr const char* kUniform = "uniform";
inline constexpr const char* kControl = "control";

// This renderer's default on one rank: what is visible, then the lattice's nodes that are worth most, then
// painting.
Method default_method();

// This renderer's triangulation on one rank: seeds, then the heaviest triangle again and again, then
// reconstruction.
Method delaunay_method();

// A grid of m x n samples at the centres of its cells. With fewer samples than pixels the picture is bilinear
// between them; with more, each pixel is the mean over its area.
Method uniform_method();

// Returns the picture of a uniform grid that takes about so much CPU time.
Image uniform_picture_in(double seconds, const Subject& subject);

// Returns the default first, the uniform method, the same again as a control, the triangulation, and that
// without one of its parts.
std::vector<Method> accuracy_methods();

// Returns the names of accuracy_methods() as --methods takes them: with "-" for spaces.
std::vector<std::string> method_words();

// Returns the methods that a list of such words with commas names, and the uniform method and the control in
// any case, in the order of accuracy_methods(). Throws UsageError on another word.
std::vector<Method> methods_of(std::string_view list);

// Returns samples per pixel from 0.4 % to 11, a factor of 10^(1/5) or a little more apart. 1 is among them.
std::vector<double> curve_densities();

}  // namespace pprt
