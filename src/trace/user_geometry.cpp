#include "trace/user_geometry.h"

#include <cmath>
#include <limits>

namespace pprt {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Round to the next float outwards, so that a box in float encloses the one in double.
float below(double x) {
  return std::nextafterf(static_cast<float>(x), -kInfinity);
}
float above(double x) {
  return std::nextafterf(static_cast<float>(x), kInfinity);
}

template <class Record>
void bound(const RTCBoundsFunctionArguments* args) {
  const Box3d box = bounds(static_cast<const Record*>(args->geometryUserPtr)[args->primID]);
  RTCBounds& out = *args->bounds_o;
  out.lower_x = below(box.min.x);
  out.lower_y = below(box.min.y);
  out.lower_z = below(box.min.z);
  out.upper_x = above(box.max.x);
  out.upper_y = above(box.max.y);
  out.upper_z = above(box.max.z);
}

// Returns the first crossing of a visible face strictly between two ray parameters; NaN when there is none.
template <VisibleFaces kFaces>
double first_within(const Crossings& crossings, double near, double far) {
  double first = std::numeric_limits<double>::quiet_NaN();
  if (kFaces != VisibleFaces::kBack && crossings.front > near && crossings.front < far) {
    first = far = crossings.front;
  }
  if (kFaces != VisibleFaces::kFront && crossings.back > near && crossings.back < far) first = crossings.back;
  return first;
}

// Intersects ray i of a packet of `lanes` rays; a single ray is a packet of one.
template <class Record, VisibleFaces kFaces, RayLength kRays>
double first_hit(const Record& record, RTCRayN* ray, unsigned lanes, unsigned i) {
  const Vec3d origin(RTCRayN_org_x(ray, lanes, i), RTCRayN_org_y(ray, lanes, i),
                     RTCRayN_org_z(ray, lanes, i));
  const Vec3d direction(RTCRayN_dir_x(ray, lanes, i), RTCRayN_dir_y(ray, lanes, i),
                        RTCRayN_dir_z(ray, lanes, i));
  const double near = RTCRayN_tnear(ray, lanes, i), far = RTCRayN_tfar(ray, lanes, i);
  if constexpr (kRays == RayLength::kAny) {
    const double length = std::sqrt(direction.dot(direction));
    return first_within<kFaces>(crossings(record, origin, direction * (1 / length)), near * length,
                                far * length) /
           length;
  } else {
    return first_within<kFaces>(crossings(record, origin, direction), near, far);
  }
}

template <class Record, VisibleFaces kFaces, RayLength kRays>
void intersect_lane(const Record& record, const RTCIntersectFunctionNArguments* args, unsigned lanes,
                    unsigned i) {
  RTCRayN* ray = RTCRayHitN_RayN(args->rayhit, lanes);
  const double t = first_hit<Record, kFaces, kRays>(record, ray, lanes, i);
  if (std::isnan(t)) return;
  RTCHitN* hit = RTCRayHitN_HitN(args->rayhit, lanes);
  RTCRayN_tfar(ray, lanes, i) = static_cast<float>(t);
  RTCHitN_primID(hit, lanes, i) = args->primID;
  RTCHitN_geomID(hit, lanes, i) = args->geomID;
  RTCHitN_instID(hit, lanes, i, 0) = args->context->instID[0];
}

template <class Record, VisibleFaces kFaces, RayLength kRays>
void occlude_lane(const Record& record, const RTCOccludedFunctionNArguments* args, unsigned lanes,
                  unsigned i) {
  const double t = first_hit<Record, kFaces, kRays>(record, args->ray, lanes, i);
  if (!std::isnan(t)) RTCRayN_tfar(args->ray, lanes, i) = -kInfinity;
}

// Embree callback. It writes no normal: shading recomputes it from the primitive, in double.
template <class Record, VisibleFaces kFaces, RayLength kRays>
void intersect(const RTCIntersectFunctionNArguments* args) {
  const Record& record = static_cast<const Record*>(args->geometryUserPtr)[args->primID];
  if (args->N == 1) {
    if (args->valid[0]) intersect_lane<Record, kFaces, kRays>(record, args, 1, 0);
    return;
  }
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i]) intersect_lane<Record, kFaces, kRays>(record, args, args->N, i);
  }
}

template <class Record, VisibleFaces kFaces, RayLength kRays>
void occlude(const RTCOccludedFunctionNArguments* args) {
  const Record& record = static_cast<const Record*>(args->geometryUserPtr)[args->primID];
  if (args->N == 1) {
    if (args->valid[0]) occlude_lane<Record, kFaces, kRays>(record, args, 1, 0);
    return;
  }
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i]) occlude_lane<Record, kFaces, kRays>(record, args, args->N, i);
  }
}

template <class Record, VisibleFaces kFaces, RayLength kRays>
void set_callbacks(RTCGeometry geometry) {
  rtcSetGeometryIntersectFunction(geometry, intersect<Record, kFaces, kRays>);
  rtcSetGeometryOccludedFunction(geometry, occlude<Record, kFaces, kRays>);
}

template <class Record, RayLength kRays>
void set_callbacks(RTCGeometry geometry, VisibleFaces faces) {
  switch (faces) {
    case VisibleFaces::kBoth:
      return set_callbacks<Record, VisibleFaces::kBoth, kRays>(geometry);
    case VisibleFaces::kFront:
      return set_callbacks<Record, VisibleFaces::kFront, kRays>(geometry);
    case VisibleFaces::kBack:
      return set_callbacks<Record, VisibleFaces::kBack, kRays>(geometry);
  }
}

template <class Record>
EmbreeGeometry new_geometry(const EmbreeDevice& device, const std::vector<Record>& records,
                            VisibleFaces faces, RayLength rays) {
  EmbreeGeometry geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER));
  rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(records.size()));
  // Embree returns the pointer unchanged, and the callbacks only read through it.
  rtcSetGeometryUserData(geometry.get(), const_cast<Record*>(records.data()));
  rtcSetGeometryBoundsFunction(
      geometry.get(), [](const RTCBoundsFunctionArguments* args) { bound<Record>(args); }, nullptr);
  if (rays == RayLength::kUnit) {
    set_callbacks<Record, RayLength::kUnit>(geometry.get(), faces);
  } else {
    set_callbacks<Record, RayLength::kAny>(geometry.get(), faces);
  }
  rtcCommitGeometry(geometry.get());
  return geometry;
}

}  // namespace

EmbreeGeometry new_user_geometry(const EmbreeDevice& device, const std::vector<SphereRecord>& records,
                                 VisibleFaces faces, RayLength rays) {
  return new_geometry(device, records, faces, rays);
}

EmbreeGeometry new_user_geometry(const EmbreeDevice& device, const std::vector<ConeRecord>& records,
                                 VisibleFaces faces, RayLength rays) {
  return new_geometry(device, records, faces, rays);
}

}  // namespace pprt
