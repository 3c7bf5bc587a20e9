#include <fmt/format.h>

#include "parser/anim/anim_script.h"

namespace pprt::anim {
namespace {

// Reads the fields of a sun or a sky.
class LightReader {
 public:
  LightReader(const WrittenKey& written, std::string_view word, Problems& problems)
      : written_(written), word_(word), problems_(problems) {}

  // Returns a field that must be given.
  Vec3d vector(Field field) {
    if (!written_.fields[field]) {
      problems_.error(written_.place, fmt::format("'{}' lacks '{}'", word_, kFieldWords[field]));
      return {0, 0, 0};
    }
    const Value& value = *written_.fields[field];
    if (value.known() && value.size != 3)
      problems_.error(value.place, fmt::format("'{}' is a vector of three: <x, y, z>", kFieldWords[field]));
    return {value.c[0], value.c[1], value.c[2]};
  }

  Vec3d direction(Field field) {
    const Vec3d v = vector(field);
    const std::optional<Value>& value = written_.fields[field];
    if (value && value->size == 3 && v == Vec3d(0, 0, 0))
      problems_.error(value->place,
                      fmt::format("'{}' is a direction: it must not be zero", kFieldWords[field]));
    return v;
  }

  Rgb color(Field field) {
    const Vec3d v = vector(field);
    return {v.x, v.y, v.z};
  }

 private:
  const WrittenKey& written_;
  std::string_view word_;
  Problems& problems_;
};

}  // namespace

Daylight interpret_daylight(const WrittenScript& script, Problems& problems) {
  Daylight daylight;
  for (const WrittenKey& written : script.suns) {
    LightReader reader(written, "sun", problems);
    Light sun{.position = reader.direction(kFrom), .is_sun = true};
    if (written.fields[kColor]) sun.color = reader.color(kColor);
    daylight.suns.push_back(sun);
  }
  if (script.sky) {
    LightReader reader(*script.sky, "sky", problems);
    daylight.sky =
        Sky{.up = reader.direction(kUp), .horizon = reader.color(kHorizon), .zenith = reader.color(kZenith)};
  }
  return daylight;
}

}  // namespace pprt::anim
