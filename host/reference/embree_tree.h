// SPDX-License-Identifier: Apache-2.0
// Embree's device and its trees over triangles of a scene. For .cpp files only, as embree.h.
#pragma once

#include <mutex>
#include <span>
#include <string>

#include "host/reference/embree.h"
#include "host/scene/scene.h"

namespace nearlight::core {

/// The first error that Embree reported, possibly from a thread of its own.
struct EmbreeReport {
    std::mutex mutex;
    RTCError code = RTC_ERROR_NONE;
    std::string message;
};

/// Errors of the device go to `report`, which must outlive it. Throws Error(ErrorKind::failure).
EmbreeDevice open_embree(EmbreeReport& report);

/// A tree over the triangles `ids` of the scene, in that order: hit.primID is an index into `ids`. Copies
/// what it needs. Throws Error with Embree's message: out_of_memory, or runtime.
EmbreeTree build_embree_tree(RTCDevice device, EmbreeReport& report, const Scene& scene,
                             std::span<const uint> ids, RTCBuildQuality quality, RTCSceneFlags flags);

}  // namespace nearlight::core
