// libFuzzer entry. Any bytes must be an InputError or an animation with a camera at every frame.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "base/diagnostics.h"
#include "parser/anim/anim_parser.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const pprt::Animation animation = pprt::parse_animation(text, "fuzz.anim").animation;
    pprt::Diagnostics problems;
    pprt::check_cameras(animation, pprt::View{}, problems);
    if (problems.has_errors()) return 0;
    for (const pprt::CameraKey& key : animation.keys) {
      const pprt::View view = pprt::view_at(animation, key.frame + 0.5, pprt::View{});
      if (!std::isfinite(view.from.length() + view.at.length() + view.up.length())) std::abort();
      if (!(view.angle_degrees > 0 && view.angle_degrees < 180)) std::abort();
    }
  } catch (const pprt::InputError&) {
  }
  return 0;
}
