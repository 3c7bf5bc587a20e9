#include <fmt/format.h>

#include "parser/anim/anim_script.h"

namespace pprt::anim {
namespace {

// Reads the keys of one object in order and keeps its place as it is after each.
class ObjectKeyReader {
 public:
  ObjectKeyReader(const WrittenKey& written, ObjectKey& key, Problems& problems)
      : written_(written), key_(key), problems_(problems) {}

  void read() {
    vector(kTranslate, key_.translate);
    vector(kRotate, key_.rotate);
    read_scale();
    read_visible();
    shape(kTension, key_.shape.tension);
    shape(kContinuity, key_.shape.continuity);
    shape(kBias, key_.shape.bias);
  }

 private:
  const Value* known(Field field) const {
    return written_.fields[field] && written_.fields[field]->known() ? &*written_.fields[field] : nullptr;
  }

  void vector(Field field, Vec3d& into) {
    const Value* value = known(field);
    if (value == nullptr) return;
    if (value->size != 3) {
      problems_.error(value->place, fmt::format("'{}' is a vector of three: <x, y, z>", kFieldWords[field]));
      return;
    }
    into = {value->c[0], value->c[1], value->c[2]};
  }

  // A number scales all three directions alike.
  void read_scale() {
    const Value* value = known(kScale);
    if (value != nullptr && value->size == 1) {
      key_.scale = Vec3d(value->c[0], value->c[0], value->c[0]);
    } else {
      vector(kScale, key_.scale);
    }
  }

  void read_visible() {
    const Value* value = known(kVisible);
    if (value == nullptr) return;
    if (const std::optional<double> given = number(*value, "visible", problems_)) key_.visible = *given != 0;
  }

  void shape(Field field, double& into) {
    const Value* value = known(field);
    if (value == nullptr) return;
    const std::optional<double> given = number(*value, kFieldWords[field], problems_);
    if (!given) return;
    if (*given >= -1 && *given <= 1) {
      into = *given;
    } else {
      problems_.error(value->place, fmt::format("'{}' is from -1 to 1, not {}", kFieldWords[field], *given));
    }
  }

  const WrittenKey& written_;
  ObjectKey& key_;
  Problems& problems_;
};

}  // namespace

ObjectMotion interpret_object(const WrittenObject& object, const Animation& animation, bool fps_given,
                              Problems& problems) {
  ObjectMotion motion{.name = object.name, .location = problems.location(object.place), .keys = {}};
  ObjectKey key;
  for (const WrittenKey& written : object.keys) {
    const std::optional<double> frame = frame_of(written, animation, fps_given, problems);
    ObjectKeyReader(written, key, problems).read();
    const ObjectKey* before = motion.keys.empty() ? nullptr : &motion.keys.back();
    if (!frame || !is_in_order(*frame, written, before ? &before->frame : nullptr,
                               before ? before->location : SourceLocation(), problems))
      continue;
    key.frame = *frame;
    key.location = problems.location(written.place);
    motion.keys.push_back(key);
  }
  return motion;
}

}  // namespace pprt::anim
