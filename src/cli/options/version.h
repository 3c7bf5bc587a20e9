// The version every program reports.
#pragma once

namespace pprt {

inline constexpr const char* kVersion = PPRT_VERSION;  // defined by src/cli/CMakeLists.txt

}  // namespace pprt
