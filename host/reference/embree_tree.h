// SPDX-License-Identifier: Apache-2.0
// Embree's device and its trees over triangles of a scene. Like embree.h, it is for .cpp files.
#pragma once

#include <mutex>
#include <span>
#include <string>

#include "host/reference/embree.h"
#include "host/scene/scene.h"

namespace nearlight::core {

/// The first error that Embree reported, possibly from one of its own threads.
struct EmbreeReport {
    std::mutex mutex;
    RTCError code = RTC_ERROR_NONE;
    std::string message;
};

/// Opens Embree. Errors of the device go to `report`, which must outlive it. Throws Error(ErrorKind::failure)
/// where Embree does not start.
EmbreeDevice open_embree(EmbreeReport& report);

/// Builds a tree over the triangles `ids` of the scene; hit.primID is an index into `ids`. The tree copies
/// what it needs. Throws Error with Embree's message: ErrorKind::out_of_memory or ErrorKind::failure.
EmbreeTree build_embree_tree(RTCDevice device, EmbreeReport& report, const Scene& scene,
                             std::span<const uint> ids, RTCBuildQuality quality, RTCSceneFlags flags);

}  // namespace nearlight::core
