// SPDX-License-Identifier: Apache-2.0
// Embree's objects, released when they go out of scope. For .cpp files only: no other header includes
// Embree's.
#pragma once

#include <embree3/rtcore.h>

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

}  // namespace nearlight::core
