// SPDX-License-Identifier: Apache-2.0
// Embree 3 or 4, whichever the build found: its objects, released when they go out of scope, and its ray
// queries, whose interface differs between the two versions. Only .cpp files and embree_tree.h include this
// file, so that no other header includes Embree's.
#pragma once

#if NEARLIGHT_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <memory>
#include <type_traits>

namespace nearlight::core {

template <auto release>
struct EmbreeRelease {
    template <typename T>
    void operator()(T* object) const {
        release(object);
    }
};
using EmbreeDevice = std::unique_ptr<std::remove_pointer_t<RTCDevice>, EmbreeRelease<rtcReleaseDevice>>;
using EmbreeTree = std::unique_ptr<std::remove_pointer_t<RTCScene>, EmbreeRelease<rtcReleaseScene>>;
using EmbreeGeometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, EmbreeRelease<rtcReleaseGeometry>>;

/// Embree's ray queries; `coherent` tells Embree that successive rays are alike. Each thread needs its own
/// object.
class EmbreeQuery {
  public:
#if NEARLIGHT_EMBREE_MAJOR >= 4
    explicit EmbreeQuery(bool coherent) {
        rtcInitIntersectArguments(&intersect_);
        rtcInitOccludedArguments(&occluded_);
        intersect_.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
        occluded_.flags = intersect_.flags;
    }
    void intersect(RTCScene tree, RTCRayHit& ray) {
        rtcIntersect1(tree, &ray, &intersect_);
    }
    void intersect(const int* valid, RTCScene tree, RTCRayHit16& rays) {
        rtcIntersect16(valid, tree, &rays, &intersect_);
    }
    void occluded(RTCScene tree, RTCRay& ray) {
        rtcOccluded1(tree, &ray, &occluded_);
    }
    void occluded(const int* valid, RTCScene tree, RTCRay16& rays) {
        rtcOccluded16(valid, tree, &rays, &occluded_);
    }

  private:
    RTCIntersectArguments intersect_;
    RTCOccludedArguments occluded_;
#else
    explicit EmbreeQuery(bool coherent) {
        rtcInitIntersectContext(&context_);
        context_.flags =
            coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    }
    void intersect(RTCScene tree, RTCRayHit& ray) {
        rtcIntersect1(tree, &context_, &ray);
    }
    void intersect(const int* valid, RTCScene tree, RTCRayHit16& rays) {
        rtcIntersect16(valid, tree, &context_, &rays);
    }
    void occluded(RTCScene tree, RTCRay& ray) {
        rtcOccluded1(tree, &context_, &ray);
    }
    void occluded(const int* valid, RTCScene tree, RTCRay16& rays) {
        rtcOccluded16(valid, tree, &context_, &rays);
    }

  private:
    RTCIntersectContext context_;
#endif
};

}  // namespace nearlight::core
