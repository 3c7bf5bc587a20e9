#include "study/report/gnuplot.h"

#include <system_error>

#include "base/subprocess.h"

namespace pprt {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error("cannot draw a plot: " + what);
}

}  // namespace

std::string draw_svg(const Plot& plot, const std::string& program) {
  CapturedRun run;
  try {
    run = run_captured({program}, gnuplot_script(plot));
  } catch (const ProgramNotFound&) {
    throw MissingTool(program + " is not installed (Debian package gnuplot-nox)");
  } catch (const std::system_error& e) {
    fail(e.what());
  }
  const std::string& svg = run.output;
  const std::size_t begin = svg.find("<svg"), end = svg.rfind("</svg>");
  if (run.status.code != 0 || begin == std::string::npos || end == std::string::npos) {
    fail(program + " ended with " + std::to_string(run.status.code) + ": " + run.errors);
  }
  return svg.substr(begin, end + 6 - begin);
}

}  // namespace pprt
