#include "trace/geometry/user_geometry.h"

#include <cmath>
#include <limits>
#include <tuple>

namespace pprt {
namespace {

constexpr float kNoEnd = std::numeric_limits<float>::infinity();

// Round to the next float outwards, so that a box in float encloses the one in double.
float below(double x) {
  return std::nextafterf(static_cast<float>(x), -kNoEnd);
}
float above(double x) {
  return std::nextafterf(static_cast<float>(x), kNoEnd);
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

// Returns the first crossing of a visible face after a ray parameter; infinity when there is none.
template <VisibleFaces kFaces>
double first_after(const Crossings& crossings, double near) {
  double first = std::numeric_limits<double>::infinity();
  if (kFaces != VisibleFaces::kBack && crossings.front > near) first = crossings.front;
  if (kFaces != VisibleFaces::kFront && crossings.back > near && crossings.back < first)
    first = crossings.back;
  return first;
}

// Intersects ray i of a packet of `lanes` rays; a single ray is a packet of one.
template <class Record, VisibleFaces kFaces, RayLength kRays>
double first_hit(const Record& record, RTCRayN* ray, unsigned lanes, unsigned i) {
  const Vec3d origin(RTCRayN_org_x(ray, lanes, i), RTCRayN_org_y(ray, lanes, i),
                     RTCRayN_org_z(ray, lanes, i));
  const Vec3d direction(RTCRayN_dir_x(ray, lanes, i), RTCRayN_dir_y(ray, lanes, i),
                        RTCRayN_dir_z(ray, lanes, i));
  const double near = RTCRayN_tnear(ray, lanes, i);
  if constexpr (kRays == RayLength::kAny) {
    const double length = std::sqrt(direction.dot(direction));
    return first_after<kFaces>(crossings(record, origin, direction * (1 / length)), near * length) / length;
  } else {
    return first_after<kFaces>(crossings(record, origin, direction), near);
  }
}

// Where surfaces touch, their crossings are equal in float: a sphere that closes a cylinder. Then the lower
// number wins, for the order in which Embree finds them depends on the processor.
template <class Record, VisibleFaces kFaces, RayLength kRays>
void intersect_lane(const Record& record, const RTCIntersectFunctionNArguments* args, unsigned lanes,
                    unsigned i) {
  RTCRayN* ray = RTCRayHitN_RayN(args->rayhit, lanes);
  RTCHitN* hit = RTCRayHitN_HitN(args->rayhit, lanes);
  const double t = first_hit<Record, kFaces, kRays>(record, ray, lanes, i);
  float& far = RTCRayN_tfar(ray, lanes, i);
  const float rounded = static_cast<float>(t);
  if (!(rounded < far)) {
    if (rounded != far || t == std::numeric_limits<double>::infinity()) return;
    const unsigned found = RTCHitN_geomID(hit, lanes, i);
    const bool wins = found == RTC_INVALID_GEOMETRY_ID ? t < static_cast<double>(far)
                                                       : std::tie(args->geomID, args->primID) <
                                                             std::tie(found, RTCHitN_primID(hit, lanes, i));
    if (!wins) return;
  }
  far = rounded;
  RTCHitN_primID(hit, lanes, i) = args->primID;
  RTCHitN_geomID(hit, lanes, i) = args->geomID;
  RTCHitN_instID(hit, lanes, i, 0) = args->context->instID[0];
}

template <class Record, VisibleFaces kFaces, RayLength kRays>
void occlude_lane(const Record& record, const RTCOccludedFunctionNArguments* args, unsigned lanes,
                  unsigned i) {
  const double t = first_hit<Record, kFaces, kRays>(record, args->ray, lanes, i);
  if (t < static_cast<double>(RTCRayN_tfar(args->ray, lanes, i))) RTCRayN_tfar(args->ray, lanes, i) = -kNoEnd;
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
