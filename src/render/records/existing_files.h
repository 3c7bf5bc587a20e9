// What happens to files that exist already.
#pragma once

#include <cstdint>

namespace pprt {

enum class ExistingFiles : std::uint8_t {
  kRefuse,   // the run does not begin
  kReplace,  // --overwrite
  kResume    // --resume: frames that the manifest lists as finished are skipped
};

}  // namespace pprt
