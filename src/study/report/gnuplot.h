// Plots drawn by gnuplot, which is asked for when a plot is drawn and not before.
#pragma once

#include <stdexcept>
#include <string>

#include "study/report/plot.h"

namespace pprt {

// A program that draws is not installed; what() names the Debian package that has it.
class MissingTool : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The plot as an <svg> element, without what stands before it in a file of its own. `program` is looked for
// on the PATH. Throws MissingTool, or std::runtime_error with what gnuplot said.
std::string draw_svg(const Plot& plot, const std::string& program = "gnuplot");

}  // namespace pprt
