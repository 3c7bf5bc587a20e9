#include "trace/light_contacts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "trace/geometry/numerics.h"
#include "trace/scene_impl.h"

namespace pprt {
namespace {

double distance_to_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
  const Vec3d along = b - a;
  const double length2 = along.dot(along);
  const double share = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0;
  return (p - (a + along * share)).length();
}

// Distance of a point in the plane of a triangle from it. `normal` is unit.
double distance_in_plane(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c,
                         const Vec3d& normal) {
  const auto left_of = [&](const Vec3d& from, const Vec3d& to) {
    return (to - from).cross(p - from).dot(normal) >= 0;
  };
  if (left_of(a, b) && left_of(b, c) && left_of(c, a)) return 0;
  return std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

// The error of shadow rays that end at one light.
class ContactFinder {
 public:
  ContactFinder(const Vec3d& light, double radius) : light_(light), ray_length_(light.length() + radius) {}

  // Each returns a contact's reach, if there is a contact.
  std::optional<float> reach(const SphereRecord& sphere) const {
    return reach_on_curved(std::abs((light_ - sphere.center).length() - sphere.radius), sphere.radius);
  }

  // Measures the distance in the half-plane through the axis, where the cone is a segment.
  std::optional<float> reach(const ConeRecord& cone) const {
    const double length = cone.axis.length();
    const double height = (light_ - cone.base).dot(cone.axis) / length;
    const double aside = (light_ - cone.base - cone.axis * (height / length)).length();
    const double apex_radius = cone.base_radius + cone.radius_change;
    const double distance = distance_to_segment(Vec3d(height, aside, 0), Vec3d(0, cone.base_radius, 0),
                                                Vec3d(length, apex_radius, 0));
    return reach_on_curved(distance, aside);
  }

  std::optional<float> reach(const Mesh& mesh, std::size_t triangle) const {
    const TriangleIndices& corners = mesh.triangles[triangle];
    const Vec3d a(mesh.vertices[corners[0]]), b(mesh.vertices[corners[1]]), c(mesh.vertices[corners[2]]);
    const Vec3d normal(mesh.facets[triangle].normal);
    const double height = (light_ - a).dot(normal);
    if (std::abs(height) > kMaxTriangleOffset) return std::nullopt;  // the commonest case, without the rest
    const double longest = std::sqrt(std::max({(b - a).length2(), (c - b).length2(), (a - c).length2()}));
    const double error = shadow_end_on_triangle(ray_length_, longest, (b - a).cross(c - a).length());
    if (std::abs(height) > error) return std::nullopt;
    if (distance_in_plane(light_ - normal * height, a, b, c, normal) > kFlattestCosine * error)
      return std::nullopt;
    // Rays from anywhere else cross the plane at the light alone.
    return std::numeric_limits<float>::infinity();
  }

 private:
  // A ray that meets the surface at an angle with cosine k to the normal crosses it within error / k of the
  // light. Its other crossing is 2 k radius away. The reach is where both are equal.
  std::optional<float> reach_on_curved(double distance, double radius) const {
    const double error = shadow_end_error(ray_length_) + kCrossingError;
    if (distance > error) return std::nullopt;
    return static_cast<float>(std::sqrt(2 * radius * error));
  }

  Vec3d light_;
  double ray_length_;  // of the longest shadow ray
};

}  // namespace

std::vector<LightContact> contacts_of_light(const Vec3d& position, std::span<const ScenePart> parts,
                                            double radius) {
  std::vector<LightContact> contacts;
  const ContactFinder finder(position, radius);
  for (std::uint32_t part = 0; part < parts.size(); ++part) {
    const auto add = [&](std::size_t primitive, std::optional<float> reach) {
      if (reach) contacts.push_back({part, static_cast<std::uint32_t>(primitive), *reach});
    };
    if (const auto* mesh = std::get_if<Mesh>(&parts[part].shape)) {
      for (std::size_t i = 0; i < mesh->triangles.size(); ++i) add(i, finder.reach(*mesh, i));
    } else if (const auto* spheres = std::get_if<std::vector<SphereRecord>>(&parts[part].shape)) {
      for (std::size_t i = 0; i < spheres->size(); ++i) add(i, finder.reach((*spheres)[i]));
    } else {
      const auto& cones = std::get<std::vector<ConeRecord>>(parts[part].shape);
      for (std::size_t i = 0; i < cones.size(); ++i) add(i, finder.reach(cones[i]));
    }
  }
  return contacts;
}

}  // namespace pprt
