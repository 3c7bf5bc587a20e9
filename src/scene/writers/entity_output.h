// Lines of NFF and AFF: a keyword, then values.
#pragma once

#include <cstddef>
#include <string_view>

#include "scene/description/scene_description.h"
#include "scene/writers/text_output.h"

namespace pprt {

class EntityOutput : public TextOutput {
 public:
  using TextOutput::TextOutput;

  // Writes one line: the keyword, then each value after a blank.
  template <typename... Values>
  void line(std::string_view keyword, const Values&... values) {
    text(keyword);
    (value(values), ...);
    text("\n");
  }

  // Writes a line without a keyword.
  void vertex_line(const Vec3d& position) {
    number(position.x);
    for (int i = 1; i < 3; ++i) value(position[i]);
    text("\n");
  }
  void vertex_line(const PatchVertex& vertex) {
    number(vertex.position.x);
    for (int i = 1; i < 3; ++i) value(vertex.position[i]);
    value(vertex.normal);
    text("\n");
  }

  template <typename Vertices>
  void vertex_lines(std::string_view keyword, const Vertices& vertices) {
    line(keyword, vertices.size());
    for (const auto& vertex : vertices) vertex_line(vertex);
  }

  void view_lines(const View& view) {
    line("v");
    line("from", view.from);
    line("at", view.at);
    line("up", view.up);
    line("angle", view.angle_degrees);
    line("hither", view.hither);
    line("resolution", view.width, view.height);
  }

  void shape_lines(const Sphere& s) { line("s", s.center, s.radius); }
  void shape_lines(const Cone& c) { line("c", c.base, c.base_radius, c.apex, c.apex_radius); }

 private:
  void value(std::string_view v) {
    text(" ");
    text(v);
  }
  void value(double v) {
    text(" ");
    number(v);
  }
  void value(std::size_t v) {
    text(" ");
    number(v);
  }
  void value(int v) { value(static_cast<std::size_t>(v)); }  // pixels, frames
  void value(const Vec2d& v) {
    for (int i = 0; i < 2; ++i) value(v[i]);
  }
  void value(const Vec3d& v) {
    for (int i = 0; i < 3; ++i) value(v[i]);
  }
  void value(const Rgb& c) {
    for (int i = 0; i < 3; ++i) value(c[i]);
  }
};

}  // namespace pprt
