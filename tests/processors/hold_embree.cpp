// Stands before Embree: adds PPRT_HOLD_EMBREE, such as "isa=avx2", to the configuration of each device. A
// program under test starts with this library in LD_PRELOAD. Tests only.
#include <dlfcn.h>

#include <cstdlib>
#include <string>

extern "C" void* rtcNewDevice(const char* config) {
  using NewDevice = void* (*)(const char*);
  static const auto embree = reinterpret_cast<NewDevice>(dlsym(RTLD_NEXT, "rtcNewDevice"));
  std::string held = config != nullptr ? config : "";
  if (const char* more = std::getenv("PPRT_HOLD_EMBREE")) held.append(",").append(more);
  return embree(held.c_str());
}
