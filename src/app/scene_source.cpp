#include "app/scene_source.h"

#include "spd/spd.h"

namespace pprt {

ParsedScene load_scene(const std::string& name, const NffOptions& options) {
  if (is_spd_name(name)) return {make_spd_scene(name), {}};
  return read_nff(name, options);
}

}  // namespace pprt
