#include "pipeline/mesh/predicates.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace pprt {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_2 point(const Vec2d& p) {
  return {p.x, p.y};
}

}  // namespace

int exact_orientation(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return CGAL::orientation(point(a), point(b), point(c));
}

int exact_in_circle(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d) {
  return CGAL::side_of_oriented_circle(point(a), point(b), point(c), point(d));
}

}  // namespace pprt
