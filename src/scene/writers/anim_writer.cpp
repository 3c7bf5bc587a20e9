#include "scene/writers/anim_writer.h"

#include <sstream>
#include <string_view>

#include "scene/writers/text_output.h"

namespace pprt {
namespace {

std::string_view word_of(SplineKind spline) {
  switch (spline) {
    case SplineKind::kLinear:
      return "linear";
    case SplineKind::kCatmullRom:
      return "catmull_rom";
    case SplineKind::kTcb:
      break;
  }
  return "tcb";
}

class ScriptOutput : public TextOutput {
 public:
  using TextOutput::TextOutput;

  void word(std::string_view name) {
    text(" ");
    text(name);
  }
  void field(std::string_view name, double value) {
    word(name);
    text(" ");
    number(value);
  }
  void field(std::string_view name, const Vec3d& value) {
    word(name);
    text(" <");
    number(value.x);
    for (int i = 1; i < 3; ++i) text(", "), number(value[i]);
    text(">");
  }
  void whole(std::string_view name, int value) {
    word(name);
    text(" ");
    number(static_cast<std::size_t>(value));
  }
};

// Fields that a script copies from the key before, unless it gives them.
void write_movement(const CameraKey& key, const CameraKey& before, ScriptOutput& out) {
  const auto changed = [&](std::string_view name, double CameraKey::*field) {
    if (key.*field != before.*field) out.field(name, key.*field);
  };
  changed("tension", &CameraKey::tension);
  changed("continuity", &CameraKey::continuity);
  changed("bias", &CameraKey::bias);
  changed("ease_in", &CameraKey::ease_in);
  changed("ease_out", &CameraKey::ease_out);
}

void write_key(const CameraKey& key, const CameraKey& before, ScriptOutput& out) {
  out.text("   ");
  out.field(key.hold ? "hold" : key.cut ? "cut" : "key", key.frame);
  if (!key.hold) {
    out.text(" {");
    if (!key.of_scene.from) out.field("from", key.from);
    if (!key.of_scene.at) out.field("at", key.at);
    if (!key.of_scene.up) out.field("up", key.up);
    if (!key.of_scene.angle) out.field("angle", key.angle_degrees);
    write_movement(key, before, out);
    out.text(" }");
  }
  out.text("\n");
}

void write_object(const ObjectMotion& object, ScriptOutput& out) {
  out.text("  object \"");
  out.text(object.name);
  out.text("\" {\n");
  for (const ObjectKey& key : object.keys) {
    out.text("   ");
    out.field("key", key.frame);
    out.text(" {");
    out.field("translate", key.translate);
    out.field("rotate", key.rotate);
    out.field("scale", key.scale);
    out.field("visible", key.visible ? 1 : 0);
    out.field("tension", key.shape.tension);
    out.field("continuity", key.shape.continuity);
    out.field("bias", key.shape.bias);
    out.text(" }\n");
  }
  out.text("  }\n");
}

void write_daylight(const Daylight& daylight, ScriptOutput& out) {
  const auto vector = [](const Rgb& c) { return Vec3d(c.x, c.y, c.z); };
  for (const Light& sun : daylight.suns) {
    out.text("  sun {");
    out.field("from", sun.position);
    if (sun.color) out.field("color", vector(*sun.color));
    out.text(" }\n");
  }
  if (!daylight.sky) return;
  out.text("  sky {");
  out.field("up", daylight.sky->up);
  out.field("horizon", vector(daylight.sky->horizon));
  out.field("zenith", vector(daylight.sky->zenith));
  out.text(" }\n");
}

}  // namespace

std::string anim_script(const Animation& animation) {
  std::ostringstream text;
  ScriptOutput out(text);
  out.text("#version ");
  out.number(static_cast<std::size_t>(kScriptVersion));
  out.text(";\nanimation {\n");
  if (animation.scene && animation.scene->find_first_of("\"\n\r") == std::string::npos) {
    out.text("  scene \"");
    out.text(*animation.scene);
    out.text("\"\n");
  }
  out.text(" ");
  out.whole("frames", animation.frames);
  if (animation.fps > 0) out.field("fps", animation.fps);
  if (animation.width && animation.height) {
    out.text(" resolution <");
    out.number(static_cast<std::size_t>(*animation.width));
    out.text(", ");
    out.number(static_cast<std::size_t>(*animation.height));
    out.text(">");
  }
  out.text("\n");
  for (const ObjectMotion& object : animation.objects) write_object(object, out);
  write_daylight(animation.daylight, out);
  if (!animation.keys.empty()) {
    out.text("  camera {\n   ");
    out.word("spline");
    out.word(word_of(animation.spline));
    out.text("\n");
    CameraKey before;
    for (const CameraKey& key : animation.keys) {
      if (key.cut) before = CameraKey();
      write_key(key, before, out);
      before = key;
    }
    out.text("  }\n");
  }
  out.text("}\n");
  out.flush();
  return std::move(text).str();
}

}  // namespace pprt
