// Embree 3 or 4: owning handles, single rays, and errors as exceptions. All differences of the two versions
// are here.
#pragma once

#if PPRT_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "base/vector.h"

namespace pprt {

// Releases a handle with the given Embree function.
template <auto kRelease>
struct EmbreeRelease {
  template <class Handle>
  void operator()(Handle* handle) const {
    kRelease(handle);
  }
};

// Owns an Embree handle; move-only.
template <class Handle, auto kRelease>
using EmbreeOwner = std::unique_ptr<std::remove_pointer_t<Handle>, EmbreeRelease<kRelease>>;

using EmbreeDevice = EmbreeOwner<RTCDevice, rtcReleaseDevice>;
using EmbreeScene = EmbreeOwner<RTCScene, rtcReleaseScene>;
using EmbreeGeometry = EmbreeOwner<RTCGeometry, rtcReleaseGeometry>;

// Creates a device with one thread: a rank has one core, so Embree must not start others.
inline EmbreeDevice new_embree_device() {
  EmbreeDevice device(rtcNewDevice("threads=1"));
  if (!device) {
    throw std::runtime_error("Embree: no device (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
  }
  return device;
}

// Throws std::runtime_error if a call since the last check failed. `doing` names the activity in the message.
inline void check_embree(const EmbreeDevice& device, const char* doing) {
  const RTCError error = rtcGetDeviceError(device.get());
  if (error == RTC_ERROR_NONE) return;
  throw std::runtime_error(
      std::string("Embree: ") + doing + ": " +
      (error == RTC_ERROR_OUT_OF_MEMORY ? "out of memory" : "error " + std::to_string(error)));
}

// Calls `visit(geometry, primitive)` for all primitives whose boxes are within `radius` of a point. The scene
// must have no instances.
template <class Visit>
void visit_primitives_near(RTCScene scene, const Vec3f& point, float radius, Visit visit) {
  RTCPointQuery query{point.x, point.y, point.z, 0, radius};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(
      scene, &query, &context,
      [](RTCPointQueryFunctionArguments* args) {
        (*static_cast<Visit*>(args->userPtr))(args->geomID, args->primID);
        return false;  // the radius stays
      },
      &visit);
}

// Traces single rays. Embree 3 needs a context for them, Embree 4 has its own.
class RaySender {
 public:
#if PPRT_EMBREE_MAJOR >= 4
  void intersect(RTCScene scene, RTCRayHit& found) {
    rtcIntersect1(scene, &found);
  }
  void occluded(RTCScene scene, RTCRay& ray) {
    rtcOccluded1(scene, &ray);
  }
#else
  RaySender() {
    rtcInitIntersectContext(&context_);
  }
  void intersect(RTCScene scene, RTCRayHit& found) {
    rtcIntersect1(scene, &context_, &found);
  }
  void occluded(RTCScene scene, RTCRay& ray) {
    rtcOccluded1(scene, &context_, &ray);
  }

 private:
  RTCIntersectContext context_;
#endif
};

}  // namespace pprt
