// Draws plots with gnuplot, as a program of its own.
#pragma once

#include <stdexcept>
#include <string>

#include "study/report/plot.h"

namespace pprt {

// gnuplot is not installed. what() names the Debian package that has it.
class MissingTool : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Returns the plot as an <svg> element, without an XML declaration. Looks for `program` on the PATH. Throws
// MissingTool, or std::runtime_error with gnuplot's message.
std::string draw_svg(const Plot& plot, const std::string& program = "gnuplot");

}  // namespace pprt
